/// An endpoint that is reached from outside: a TCP port on 127.0.0.1 or a pseudo-terminal.
#pragma once

#include <memory>
#include <string>

#include "core/metering/trial_clock.hpp"
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

  /// Where it is reached: "127.0.0.1:1502", "/tmp/ttyMETERS".
  [[nodiscard]] virtual std::string address() const = 0;
  [[nodiscard]] virtual const DeviceEndpoint& endpoint() const = 0;
};

/// Listens, and is away while the script says so.
/// @param loop, clock  Outlive the server; the server outlives the loop's run.
/// @return or io_failed when the port cannot be had.
[[nodiscard]] Result<std::unique_ptr<DeviceServer>> open_tcp_server(
    boost::asio::io_context& loop, EndpointPlan plan, const metering::TrialClock& clock);

/// Makes a pseudo-terminal and the link to it; the link goes with the server. A link of the same
/// name from before is replaced, another file is not.
/// @return or io_failed.
[[nodiscard]] Result<std::unique_ptr<DeviceServer>> open_serial_server(
    boost::asio::io_context& loop, EndpointPlan plan, const metering::TrialClock& clock);

}  // namespace recald::simulators
