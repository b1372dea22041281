#include <fcntl.h>
#include <fmt/format.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "simulators/devices/device_connection.hpp"
#include "simulators/devices/device_server.hpp"

namespace recald::simulators {
namespace {

namespace fs = std::filesystem;
using Connection = DeviceConnection<boost::asio::posix::stream_descriptor>;

/// A pseudo-terminal without line editing. Its far end stays open here too, because the near end
/// reports an error while no client has it open.
class Pseudoterminal {
 public:
  static Result<std::unique_ptr<Pseudoterminal>> open() {
    std::unique_ptr<Pseudoterminal> made{new Pseudoterminal};
    std::array<char, 128> name{};
    if (::openpty(&made->near_, &made->far_, name.data(), nullptr, nullptr) != 0) {
      return failure(ErrorCode::io_failed,
                     fmt::format("no pseudo-terminal ({})", std::strerror(errno)));
    }
    termios settings{};
    ::tcgetattr(made->far_, &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(made->far_, TCSANOW, &settings);
    made->device_ = name.data();
    return made;
  }
  ~Pseudoterminal() {
    if (near_ >= 0) ::close(near_);
    if (far_ >= 0) ::close(far_);
  }
  Pseudoterminal(const Pseudoterminal&) = delete;
  Pseudoterminal& operator=(const Pseudoterminal&) = delete;

  [[nodiscard]] const std::string& device() const { return device_; }
  /// Hands the descriptor over to the caller.
  [[nodiscard]] int release_near() { return std::exchange(near_, -1); }

 private:
  Pseudoterminal() = default;

  int near_ = -1;
  int far_ = -1;
  std::string device_;
};

/// @return the error, or none.
std::error_code make_link(const fs::path& link, const std::string& device) {
  std::error_code error;
  if (fs::is_symlink(link, error)) fs::remove(link, error);
  fs::create_symlink(device, link, error);
  return error;
}

class SerialServer final : public DeviceServer {
 public:
  SerialServer(boost::asio::io_context& loop, EndpointPlan plan, const metering::TrialClock& clock,
               std::unique_ptr<Pseudoterminal> terminal)
      : link_(std::move(plan.link)),
        terminal_(std::move(terminal)),
        endpoint_(Transport::rtu, std::move(plan.devices), std::move(plan.faults), clock.start),
        line_(std::make_shared<Connection>(
            boost::asio::posix::stream_descriptor{loop, terminal_->release_near()}, endpoint_,
            clock, [] {})) {
    line_->start();
  }
  ~SerialServer() override {
    std::error_code ignored;
    // A later server may have set its own link there.
    if (fs::read_symlink(link_, ignored) == terminal_->device()) fs::remove(link_, ignored);
  }
  SerialServer(const SerialServer&) = delete;
  SerialServer& operator=(const SerialServer&) = delete;

  [[nodiscard]] std::string address() const override { return link_.string(); }
  [[nodiscard]] const DeviceEndpoint& endpoint() const override { return endpoint_; }

 private:
  fs::path link_;
  std::unique_ptr<Pseudoterminal> terminal_;
  DeviceEndpoint endpoint_;
  std::shared_ptr<Connection> line_;
};

}  // namespace

Result<std::unique_ptr<DeviceServer>> open_serial_server(boost::asio::io_context& loop,
                                                         EndpointPlan plan,
                                                         const metering::TrialClock& clock) {
  auto terminal = TRY(Pseudoterminal::open());
  const std::string device = terminal->device();
  const fs::path link = plan.link;
  auto server = std::make_unique<SerialServer>(loop, std::move(plan), clock, std::move(terminal));
  if (const auto error = make_link(link, device)) {
    return failure(ErrorCode::io_failed, fmt::format("cannot make the link {} ({}); choose a name "
                                                     "that is free",
                                                     link.string(), error.message()));
  }
  return server;
}

}  // namespace recald::simulators
