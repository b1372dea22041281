#include "daemon/commands/meters/bus_access.hpp"

#include <fmt/format.h>

#include <thread>

#include "adapters/system/files/file_holders.hpp"

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kGapMin{50};
constexpr milliseconds kTimeout{1'000};

}  // namespace

std::optional<std::string> why_bus_is_taken(const BusConfig& bus) {
  const auto* serial = std::get_if<modbus::SerialPort>(&bus.endpoint);
  if (serial == nullptr) return {};
  const auto holders = system::holders_of(serial->device);
  if (holders.empty()) return {};
  const system::FileHolder& holder = holders.front();
  return fmt::format(
      "serial port {} of bus '{}' is open in process {} ({}); two programs on one serial line "
      "corrupt each other's frames, so stop it first",
      serial->device, bus.name, holder.process, holder.name);
}

milliseconds timeout_of(const BusConfig& bus, milliseconds of_meter) {
  if (of_meter > milliseconds{0}) return of_meter;
  return bus.timeout > milliseconds{0} ? bus.timeout : kTimeout;
}

BusAccess::BusAccess(const BusConfig& bus)
    : gap_(std::max(bus.request_gap, kGapMin)), connection_(bus.endpoint) {}

void BusAccess::pause() {
  if (!std::exchange(is_first_, false)) std::this_thread::sleep_for(gap_);
}

TimedRead BusAccess::ask(const modbus::ReadRequest& request, milliseconds timeout) {
  pause();
  const auto begin = steady_clock::now();
  modbus::ReadResult result = connection_.read(request, timeout);
  return {std::move(result), std::chrono::duration_cast<milliseconds>(steady_clock::now() - begin)};
}

}  // namespace recald::daemon
