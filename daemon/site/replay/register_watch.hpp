/// Detects whether the values of a meter are those of a cumulative register instead of
/// amounts per interval.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/metering/reading.hpp"

namespace recald::daemon {

/// Takes a meter's readings in order.
class RegisterWatch {
 public:
  void take(const metering::Reading& reading) {
    if (!std::isfinite(reading.mean_kW)) return;
    if (last_) {
      const double rise_kW = reading.mean_kW - *last_;
      if (rise_kW > 0.0) ++rises_;
      if (rise_kW < 0.0) ++falls_;
      largest_rise_kW_ = std::max(largest_rise_kW_, rise_kW);
    }
    last_ = reading.mean_kW;
  }

  /// True if values hardly ever fall: a register falls only on reset or wrap. A building's
  /// consumption falls about as often as it rises.
  [[nodiscard]] bool is_register() const { return rises_ >= 20 && falls_ * 200 <= rises_; }

  /// 1.5 times the largest rise between two intervals, rounded up to two digits.
  [[nodiscard]] double rated_kW() const {
    const double most = 1.5 * largest_rise_kW_;
    const double step = std::pow(10.0, std::floor(std::log10(std::max(most, 1e-6))) - 1.0);
    return std::ceil(most / step) * step;
  }

 private:
  std::optional<double> last_;
  std::uint64_t rises_ = 0;
  std::uint64_t falls_ = 0;
  double largest_rise_kW_ = 0.0;
};

}  // namespace recald::daemon
