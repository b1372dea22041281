/// The course of the year: smooth curves through monthly means, and the strength of a season.
#pragma once

#include <array>

#include "core/metering/civil_time.hpp"

namespace recald::simulators {

/// 0 at the start of January, 1 at the end of December, UTC.
[[nodiscard]] double year_share_of(metering::Instant t);

/// Twelve monthly means as a smooth curve through the year (mean and two harmonics).
class SeasonalCurve {
 public:
  explicit SeasonalCurve(const std::array<double, 12>& monthly_means);

  /// Constant all year, exactly.
  explicit SeasonalCurve(double constant);

  /// @param year_share  0 at the start of January, 1 at the end of December.
  [[nodiscard]] double at(double year_share) const;

 private:
  double mean_;
  std::array<double, 2> cosine_;
  std::array<double, 2> sine_;
};

/// 1 in mid-winter, 0 in mid-summer of the northern hemisphere.
[[nodiscard]] double winter_at(double year_share);

/// A quantity that grows towards winter.
struct WinterRise {
  double summer;
  double rise;
  [[nodiscard]] double at(double winter) const { return summer + rise * winter; }
};

/// A quantity that grows towards summer; a negative rise falls.
struct SummerRise {
  double winter;
  double rise;
  [[nodiscard]] double at(double winter_now) const { return winter + rise * (1.0 - winter_now); }
};

}  // namespace recald::simulators
