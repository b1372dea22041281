/// An endpoint that clients can connect to: a TCP port on 127.0.0.1 or a pseudo-terminal.
#pragma once

#include <memory>
#include <string>

#include "core/metering/registers/trial_clock.hpp"
#include "core/result.hpp"
#include "simulators/devices/device_endpoint.hpp"
#include "simulators/devices/device_plan.hpp"

namespace boost::asio {
class io_context;
}

namespace recald::simulators {

class DeviceServer {
 public:
  virtual ~DeviceServer() = default;

  /// Its address: "127.0.0.1:1502", "/tmp/ttyMETERS".
  [[nodiscard]] virtual std::string address() const = 0;
  [[nodiscard]] virtual const DeviceEndpoint& endpoint() const = 0;
};

/// Listens, except while the script says that the endpoint is down.
/// @param loop, clock  Outlive the server; the server outlives the loop's run.
/// @return the server, or io_failed when the port is not available.
[[nodiscard]] Result<std::unique_ptr<DeviceServer>> open_tcp_server(
    boost::asio::io_context& loop, EndpointPlan plan, const metering::TrialClock& clock);

/// Creates a pseudo-terminal and a link to it, which is removed with the server. Replaces an old
/// link of that name, but no other file.
/// @return the server, or io_failed.
[[nodiscard]] Result<std::unique_ptr<DeviceServer>> open_serial_server(
    boost::asio::io_context& loop, EndpointPlan plan, const metering::TrialClock& clock);

}  // namespace recald::simulators
