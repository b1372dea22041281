#include "simulators/devices/device_service.hpp"

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <ostream>

#include "simulators/devices/device_server.hpp"

namespace recald::simulators {
namespace {

void tell(const std::vector<std::unique_ptr<DeviceServer>>& servers, std::ostream& told) {
  std::size_t devices = 0;
  for (const auto& server : servers) {
    told << "listening on " << server->address() << ": units";
    for (const SimulatedDevice& device : server->endpoint().devices()) {
      told << ' ' << static_cast<int>(device.unit);
    }
    told << '\n';
    devices += server->endpoint().devices().size();
  }
  told << "ready: " << servers.size() << " endpoints, " << devices << " devices" << std::endl;
}

}  // namespace

Result<DeviceTotals> serve_devices(std::vector<EndpointPlan> plans,
                                   const metering::TrialClock& clock, std::ostream& told) {
  boost::asio::io_context loop{1};
  boost::asio::signal_set signals{loop, SIGINT, SIGTERM};
  signals.async_wait([&](const boost::system::error_code&, int) { loop.stop(); });
  std::vector<std::unique_ptr<DeviceServer>> servers;
  for (EndpointPlan& plan : plans) {
    auto server =
        TRY(plan.transport == Transport::tcp ? open_tcp_server(loop, std::move(plan), clock)
                                             : open_serial_server(loop, std::move(plan), clock));
    servers.push_back(std::move(server));
  }
  tell(servers, told);
  loop.run();
  DeviceTotals totals{0, 0};
  for (const auto& server : servers) {
    totals.requests += server->endpoint().requests();
    totals.writes += server->endpoint().writes();
  }
  return totals;
}

}  // namespace recald::simulators
