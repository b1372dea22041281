/// Days of a meter that follows the regression's own form, with noise whose parts are known.
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/change_point/curve.hpp"
#include "core/change_point/meter_day.hpp"
#include "core/model/schedule.hpp"
#include "core/random/rng.hpp"

namespace recald::change_point {

struct SimulatedMeter {
  std::array<double, model::kDayTypes> base_kWh{1000.0, 600.0, 500.0};
  Curve open;    ///< Of workdays.
  Curve closed;  ///< Of the other days.
  double day_sd_kWh = 50.0;
  double day_correlation = 0.4;
  double month_sd_kWh = 0.0;
};

inline Curve curve_3p_heating() {
  return {.form = Form::heating_3p, .heating_slope_kWh_K = 30.0, .heating_balance_C = 14.0};
}
inline Curve curve_3p_cooling() {
  return {.form = Form::cooling_3p, .cooling_slope_kWh_K = 40.0, .cooling_balance_C = 12.0};
}
inline Curve curve_4p() {
  return {.form = Form::two_slopes_4p,
          .heating_slope_kWh_K = 30.0,
          .heating_balance_C = 12.0,
          .cooling_slope_kWh_K = -8.0,
          .cooling_balance_C = 12.0};
}
inline Curve curve_5p() {
  return {.form = Form::two_slopes_5p,
          .heating_slope_kWh_K = 30.0,
          .heating_balance_C = 8.0,
          .cooling_slope_kWh_K = 40.0,
          .cooling_balance_C = 16.0};
}

inline SimulatedMeter meter_with(const Curve& curve) { return {.open = curve, .closed = curve}; }

inline const std::chrono::sys_days kFirstDay{std::chrono::year{2021} / 1 / 1};

/// Days from 1 January 2021. Temperatures between about -8 and 30 °C, correlated from day to day.
inline std::vector<MeterDay> simulate(const SimulatedMeter& meter, int days, Rng& rng) {
  std::vector<MeterDay> made;
  double weather = rng.normal();
  double noise = rng.normal();
  double of_month = 0.0;
  for (int i = 0; i < days; ++i) {
    const metering::Day date{kFirstDay + std::chrono::days{i}};
    weather = 0.75 * weather + std::sqrt(1.0 - 0.75 * 0.75) * rng.normal();
    const double rho = meter.day_correlation;
    noise = rho * noise + std::sqrt(1.0 - rho * rho) * rng.normal();
    if (i == 0 || unsigned{date.day()} == 1) of_month = rng.normal();
    const double season = std::cos(2.0 * std::numbers::pi * (i - 20) / 365.25);
    const double t = 11.0 - 11.0 * season + 3.5 * weather;
    const model::DayType type = model::day_type(date, {});
    const Curve& curve = type == model::DayType::workday ? meter.open : meter.closed;
    const double energy = meter.base_kWh[static_cast<std::size_t>(type)] + curve.at(t) +
                          meter.day_sd_kWh * noise + meter.month_sd_kWh * of_month;
    made.push_back({date, type, energy, t});
  }
  return made;
}

}  // namespace recald::change_point
