/// The registers of a running site, served over Modbus TCP.
#pragma once

#include <memory>

#include "adapters/modbus/register_server.hpp"
#include "daemon/gateway/registers/register_watch.hpp"

namespace recald::daemon {

class RegisterService {
 public:
  /// Serves zeros until it is started.
  /// @param loop  Outlives this, as does what is served.
  /// @return or why the address cannot be had.
  [[nodiscard]] static Result<std::unique_ptr<RegisterService>> listen(Loop& loop,
                                                                       const ModbusConfig& config,
                                                                       Served served);
  void start() { watch_.start(); }
  void look_again() { watch_.look_again(); }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }

 private:
  RegisterService(std::unique_ptr<modbus::RegisterServer> server, Loop& loop, Served served);

  std::unique_ptr<modbus::RegisterServer> server_;
  RegisterWatch watch_;
};

}  // namespace recald::daemon
