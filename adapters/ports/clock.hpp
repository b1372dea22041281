/// Where "now" comes from: a port, so that the whole daemon can run on a clock of a test's making.
#pragma once

#include <chrono>

#include "core/metering/civil_time.hpp"

namespace recald {

/// One instant on both clocks. Stamps and schedules go by the wall clock, which may jump; waiting,
/// time-outs and back-off go by the monotonic one, which never does.
struct Moment {
  std::chrono::sys_time<std::chrono::milliseconds> wall;
  std::chrono::milliseconds monotonic;  ///< Since some instant in this process's past.

  /// The wall clock's whole second, as readings are stamped.
  [[nodiscard]] metering::Instant instant() const {
    return std::chrono::floor<std::chrono::seconds>(wall);
  }
};

class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual metering::Instant now() const = 0;
};

/// Stands still until told; never goes back.
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
