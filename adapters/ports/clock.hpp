/// Where "now" comes from: a port, so that the whole daemon can run on a clock of a test's making.
#pragma once

#include "core/metering/civil_time.hpp"

namespace recald {

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
