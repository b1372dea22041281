#include "daemon/gateway/run/watchdog.hpp"

#include <systemd/sd-daemon.h>

#include <chrono>
#include <cstdint>
#include <utility>

namespace recald::daemon {

void extend_start() {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point last{};
  const auto now = Clock::now();
  if (last != Clock::time_point{} && now - last < std::chrono::seconds{10}) return;
  last = now;
  sd_notify(0, "EXTEND_TIMEOUT_USEC=120000000");  // by two minutes from now
}

void feed_watchdog() { sd_notify(0, "WATCHDOG=1"); }

Watchdog::Watchdog(Loop& loop, std::function<bool()> is_well)
    : loop_(loop), is_well_(std::move(is_well)) {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) > 0) {
    // Half of the period, as sd_watchdog_enabled(3) recommends.
    period_ = std::chrono::milliseconds{microseconds / 2'000};
  }
}

void Watchdog::ready() {
  sd_notify(0, "READY=1");
  if (period_.count() > 0) feed();
}

void Watchdog::ending() { sd_notify(0, "STOPPING=1"); }

void Watchdog::feed() {
  loop_.after(period_, alive_.guard([this] { feed(); }));
  if (is_well_()) feed_watchdog();
}

}  // namespace recald::daemon
