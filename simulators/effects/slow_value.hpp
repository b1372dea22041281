/// Slow responses: how a room, a sensor or a habit follows a quantity that changes fast.
#pragma once

#include <cmath>

namespace recald::simulators {

/// Follows another value with a time constant, for any step length.
class SlowValue {
 public:
  explicit SlowValue(double time_constant_s) : time_constant_s_(time_constant_s) {}

  /// Advances one step with a constant target; the first call starts at the target.
  double follow(double target, double step_s) {
    if (!begun_) value_ = target;
    begun_ = true;
    value_ += (1.0 - std::exp(-step_s / time_constant_s_)) * (target - value_);
    return value_;
  }
  [[nodiscard]] double value() const { return value_; }

 private:
  double time_constant_s_;
  double value_ = 0.0;
  bool begun_ = false;
};

/// A two-point controller: on above one limit, off below a lower one, unchanged in between.
class Hysteresis {
 public:
  Hysteresis(double off_below, double on_above) : off_below_(off_below), on_above_(on_above) {}

  bool update(double measured) {
    on_ = on_ ? measured >= off_below_ : measured > on_above_;
    return on_;
  }
  [[nodiscard]] bool on() const { return on_; }

 private:
  double off_below_;
  double on_above_;
  bool on_ = false;
};

/// 0 up to `from`, 1 from `to` on, linear in between; falling if `to` is below `from`.
[[nodiscard]] inline double ramp(double x, double from, double to) {
  const double share = (x - from) / (to - from);
  return share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
}

}  // namespace recald::simulators
