#include "daemon/gateway/registers/register_service.hpp"

#include <utility>

#include "daemon/gateway/registers/register_table.hpp"

namespace recald::daemon {

Result<std::unique_ptr<RegisterService>> RegisterService::listen(Loop& loop,
                                                                 const ModbusConfig& config,
                                                                 Served served) {
  auto server =
      modbus::RegisterServer::listen({.address = config.address, .port = config.port},
                                     modbus::Words(static_cast<std::size_t>(kFirstMeterAt)));
  if (!server) return tl::unexpected(server.error());
  return std::unique_ptr<RegisterService>{
      new RegisterService{std::move(*server), loop, std::move(served)}};
}

RegisterService::RegisterService(std::unique_ptr<modbus::RegisterServer> server, Loop& loop,
                                 Served served)
    : server_(std::move(server)),
      watch_(loop, std::move(served),
             [this](std::vector<std::uint16_t> values) { server_->set(std::move(values)); }) {}

}  // namespace recald::daemon
