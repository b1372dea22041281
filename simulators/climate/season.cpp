#include "simulators/climate/season.hpp"

#include <cmath>
#include <numbers>

namespace recald::simulators {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace

double year_share_of(metering::Instant t) {
  const auto day = std::chrono::floor<std::chrono::days>(t);
  const std::chrono::year_month_day date{day};
  const std::chrono::sys_days new_year{date.year() / 1 / 1};
  const double days_in_year = date.year().is_leap() ? 366.0 : 365.0;
  return std::chrono::duration<double, std::ratio<86'400>>(t - new_year).count() / days_in_year;
}

SeasonalCurve::SeasonalCurve(const std::array<double, 12>& monthly_means)
    : mean_(0.0), cosine_{}, sine_{} {
  for (std::size_t month = 0; month < 12; ++month) {
    const double angle = kTurn * (static_cast<double>(month) + 0.5) / 12.0;
    mean_ += monthly_means[month] / 12.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double order = static_cast<double>(k + 1);
      // Monthly means flatten a harmonic by sin(x)/x, x = pi k / 12; this corrects it.
      const double x = std::numbers::pi * order / 12.0;
      const double weight = x / std::sin(x) / 6.0;
      cosine_[k] += weight * monthly_means[month] * std::cos(order * angle);
      sine_[k] += weight * monthly_means[month] * std::sin(order * angle);
    }
  }
}

SeasonalCurve::SeasonalCurve(double constant) : mean_(constant), cosine_{}, sine_{} {}

double SeasonalCurve::at(double year_share) const {
  const double c = std::cos(kTurn * year_share);
  const double s = std::sin(kTurn * year_share);
  return mean_ + cosine_[0] * c + sine_[0] * s + cosine_[1] * (c * c - s * s) +
         sine_[1] * 2.0 * s * c;
}

double winter_at(double year_share) { return 0.5 + 0.5 * std::cos(kTurn * (year_share - 0.05)); }

}  // namespace recald::simulators
