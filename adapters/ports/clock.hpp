/// The source of "now": a port, so that the whole daemon can run on a test's clock.
#pragma once

#include <chrono>

#include "core/metering/civil_time.hpp"

namespace recald {

/// One instant on both clocks. Stamps and schedules use the wall clock, which may jump; waits,
/// time-outs and back-off use the monotonic one, which never does.
struct Moment {
  std::chrono::sys_time<std::chrono::milliseconds> wall;
  std::chrono::milliseconds monotonic;  ///< Since some instant before this process started.

  /// The wall clock in whole seconds, as used to stamp readings.
  [[nodiscard]] metering::Instant instant() const {
    return std::chrono::floor<std::chrono::seconds>(wall);
  }
};

class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual metering::Instant now() const = 0;
};

/// Stands still until set; never goes back.
class VirtualClock final : public Clock {
 public:
  explicit VirtualClock(metering::Instant start) : now_(start) {}

  [[nodiscard]] metering::Instant now() const override { return now_; }
  void advance_to(metering::Instant t) {
    if (t > now_) now_ = t;
  }

 private:
  metering::Instant now_;
};

}  // namespace recald
