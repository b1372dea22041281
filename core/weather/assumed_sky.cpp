#include "core/weather/assumed_sky.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/weather/psychrometrics.hpp"

namespace recald::weather {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr double kWind_m_s = 3.0;
constexpr double kClearTransmittance = 0.7;   // A
constexpr double kRangeExponent = 2.4;        // C
constexpr double kRangeFactor = 0.036;        // of B
constexpr double kRangeFactorDecay = 0.154;   // 1/K, of B
constexpr std::ptrdiff_t kDaysEachSide = 15;  // of the mean range
constexpr minutes kSunStep{10};               // the sun rises and sets inside an hour

/// One day of the mean sun.
struct SunDay {
  double lowest_C = std::numeric_limits<double>::infinity();
  double highest_C = -std::numeric_limits<double>::infinity();
  double clear_W_m2 = 0.0;             ///< Sum over its hours.
  double extraterrestrial_W_m2 = 0.0;  ///< The same.
  double range_K = kAbsent;
  double share = kAbsent;  ///< Of the cloudless sky.
};

struct HourOfSun {
  double clear_W_m2 = 0.0;
  double extraterrestrial_W_m2 = 0.0;
};

HourOfSun mean_over_hour(Instant start, const Location& location) {
  HourOfSun mean;
  constexpr auto kSteps = static_cast<double>(hours{1} / kSunStep);
  for (Instant t = start + kSunStep / 2; t < start + hours{1}; t += kSunStep) {
    const SunPosition sun = sun_position(t, location);
    mean.clear_W_m2 += clear_sky_W_m2(sun) / kSteps;
    mean.extraterrestrial_W_m2 += extraterrestrial_W_m2(sun, t) / kSteps;
  }
  return mean;
}

/// The days of a series, and in which of them each hour lies.
class SunDays {
 public:
  SunDays(const WeatherSeries& series, const Location& location)
      : sun_(series.hours.size()), day_(series.hours.size()) {
    const seconds ahead{std::lround(240.0 * location.longitude_deg)};  // 4 min a degree
    const auto day_of = [&](Instant t) {
      return std::chrono::floor<std::chrono::days>(t + minutes{30} + ahead);
    };
    for (std::size_t i = 0; i < sun_.size(); ++i) {
      const Instant start = series.begin + hours{i};
      sun_[i] = mean_over_hour(start, location);
      day_[i] = static_cast<std::size_t>((day_of(start) - day_of(series.begin)).count());
      days_.resize(day_[i] + 1);
      SunDay& day = days_.back();
      day.clear_W_m2 += sun_[i].clear_W_m2;
      day.extraterrestrial_W_m2 += sun_[i].extraterrestrial_W_m2;
      const double dry_bulb_C = series.hours[i].dry_bulb_C;
      if (!std::isfinite(dry_bulb_C)) continue;
      day.lowest_C = std::min(day.lowest_C, dry_bulb_C);
      day.highest_C = std::max(day.highest_C, dry_bulb_C);
    }
    measure_ranges();
    share_sky();
  }

  [[nodiscard]] double lowest_C(std::size_t hour) const { return days_[day_[hour]].lowest_C; }
  [[nodiscard]] double sun_W_m2(std::size_t hour) const {
    return days_[day_[hour]].share * sun_[hour].clear_W_m2;
  }

 private:
  void measure_ranges() {
    for (std::size_t d = 0; d < days_.size(); ++d) {
      SunDay& day = days_[d];
      if (!std::isfinite(day.lowest_C)) continue;
      const bool has_next = d + 1 < days_.size() && std::isfinite(days_[d + 1].lowest_C);
      const double next_C = has_next ? days_[d + 1].lowest_C : day.lowest_C;
      // Warmer air that came in overnight leaves no range: the day was not clear.
      day.range_K = std::max(day.highest_C - 0.5 * (day.lowest_C + next_C), 0.0);
    }
  }

  [[nodiscard]] double mean_range_K(std::ptrdiff_t d) const {
    double sum_K = 0.0;
    double count = 0.0;
    const std::ptrdiff_t end = std::min(d + kDaysEachSide + 1, std::ssize(days_));
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(d - kDaysEachSide, 0); i < end; ++i) {
      const double range_K = days_[static_cast<std::size_t>(i)].range_K;
      if (!std::isfinite(range_K)) continue;
      sum_K += range_K;
      count += 1.0;
    }
    return sum_K / count;
  }

  void share_sky() {
    for (std::size_t d = 0; d < days_.size(); ++d) {
      SunDay& day = days_[d];
      if (!std::isfinite(day.range_K)) continue;
      const double b = kRangeFactor *
                       std::exp(-kRangeFactorDecay * mean_range_K(static_cast<std::ptrdiff_t>(d)));
      const double transmittance =
          kClearTransmittance * (1.0 - std::exp(-b * std::pow(day.range_K, kRangeExponent)));
      // A low sun gets less through a cloudless sky than A.
      day.share = day.clear_W_m2 > 0.0
                      ? std::min(transmittance * day.extraterrestrial_W_m2 / day.clear_W_m2, 1.0)
                      : 0.0;
    }
  }

  std::vector<HourOfSun> sun_;
  std::vector<std::size_t> day_;
  std::vector<SunDay> days_;
};

double humidity_pct(double dew_point_C, double dry_bulb_C) {
  return std::min(100.0 * saturation_pressure_Pa(dew_point_C) / saturation_pressure_Pa(dry_bulb_C),
                  100.0);
}

}  // namespace

std::vector<std::size_t> never_measured(const WeatherSeries& series) {
  std::vector<std::size_t> found;
  for (const std::size_t variable : kAssumable) {
    const auto member = kWeatherVariables[variable].member;
    const auto is_measured = [&](const WeatherHour& hour) { return std::isfinite(hour.*member); };
    if (std::ranges::none_of(series.hours, is_measured)) found.push_back(variable);
  }
  return found;
}

void assume_sky(WeatherSeries& series, const Location& location,
                std::span<const std::size_t> variables, const SkyError& error) {
  if (variables.empty() || series.hours.empty()) return;
  const auto is_assumed = [&](double WeatherHour::*member) {
    return std::ranges::any_of(variables, [&](std::size_t variable) {
      assert(std::ranges::find(kAssumable, variable) != kAssumable.end());
      return kWeatherVariables[variable].member == member;
    });
  };
  const bool humidity = is_assumed(&WeatherHour::rel_humidity_pct);
  const bool wind = is_assumed(&WeatherHour::wind_speed_m_s);
  const bool sun = is_assumed(&WeatherHour::ghi_W_m2);
  const SunDays days{series, location};
  for (std::size_t i = 0; i < series.hours.size(); ++i) {
    WeatherHour& hour = series.hours[i];
    if (!std::isfinite(hour.dry_bulb_C)) continue;
    if (humidity) {
      hour.rel_humidity_pct = humidity_pct(days.lowest_C(i) + error.dew_point_K, hour.dry_bulb_C);
    }
    if (wind) hour.wind_speed_m_s = error.wind_factor * kWind_m_s;
    if (sun) hour.ghi_W_m2 = error.sun_factor * days.sun_W_m2(i);
  }
}

}  // namespace recald::weather
