/// Daily change-point regression of one meter on the outdoor temperature, and months from it.
///
///     E = base(kind of day) + h max(0, T_h - T) + c max(0, T - T_c) + e
///
/// It needs a meter and a temperature and nothing of the building: the yardstick that every
/// calibrated model has to beat, and what forecasts a site that has no model.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/change_point/curve.hpp"
#include "core/change_point/day_noise.hpp"
#include "core/change_point/meter_day.hpp"
#include "core/display/unit.hpp"
#include "core/metering/civil_time.hpp"
#include "core/model/schedule.hpp"
#include "core/result.hpp"

namespace recald::change_point {

/// What was learnt of one meter. Energies are of a day.
struct Regression {
  std::array<double, model::kDayTypes> base_kWh;  ///< By kind of day; some may share one.
  std::vector<Curve> curves;                      ///< One, or one for open and one for closed days.
  std::array<std::size_t, model::kDayTypes> curve_of;  ///< By kind of day.

  /// Parameters in order: base loads by number, then of each curve the slopes and balance
  /// temperatures that its form has (h, T_h, c, T_c; with four parameters h, c, T).
  std::array<int, model::kDayTypes> base_number;  ///< By kind of day, from 0.
  Eigen::MatrixXd parameter_covariance;           ///< (p x p) kWh, kWh/K and °C.
  ScatterByLevel scatter;                         ///< sd of a day about what is expected.
  double day_correlation;                         ///< Of successive days, AR(1).
  double month_variance;  ///< Of what a month is off as a whole, in squares of its days' mean sd.
  double widening;        ///< Factor on all variances, for a sd learnt from few months.

  int days;          ///< Usable ones, that it was fitted to …
  double mean_kWh;   ///< … what they use on average, without sign …
  double coldest_C;  ///< … and between which temperatures they lie. NaN: hardly any is known.
  double warmest_C;
  std::string no_temperature_because;  ///< Why temperatures were not looked at; empty if they were.

  /// kWh of a day. A kind of day that training hardly had counts as the next kind.
  [[nodiscard]] double expected_kWh(model::DayType type, double dry_bulb_C) const;
};

inline constexpr int kLeastDays = 60;

/// Fits the regression. The forms with no temperature and with three to five parameters, and
/// whether kinds of day share base load and curve, are chosen by cross-validation in blocks of a
/// calendar month (of a sixth of the days where they touch fewer than six months). Outlying days
/// lose their weight in a few rounds of iterated reweighting.
///
/// The covariance of the parameters is the sandwich of least squares under the noise found: scatter
/// by level, AR(1) from day to day, and an error common to a month, whose variance is such that
/// the months left out by the cross-validation have a mean square of one in units of what was
/// expected of them. Balance temperatures are linearised, with the range of temperatures as a
/// prior (uniform, so its variance is range² / 12).
///
/// @param days  Ascending dates, each once; gaps allowed. Any kinds of day.
/// @return the fit, or
///         not_enough_data  fewer than 60 days with a usable energy;
///         not_finite       an infinite energy;
///         out_of_range     a temperature that no place on earth has.
///         If fewer than 60 usable days have a temperature, or all but ten on either side lie
///         within 3 K, the form without temperature is fitted and `no_temperature_because` says
///         why.
/// @note   A few milliseconds for two years. Same input, same bits, on one build.
/// @see    Kissock, Haberl, Claridge (2003), Inverse Modeling Toolkit: Numerical Algorithms, ASHRAE
///         Trans. 109(2) (RP-1050); ASHRAE Guideline 14-2014, annex D.
[[nodiscard]] Result<Regression> fit_regression(std::span<const MeterDay> days);

/// For people: "3-parameter heating: 210 kWh/day on workdays, 80 on Saturdays and Sundays and
/// holidays; 14.2 kWh/day more per K below 15.3 °C." A negative slope reads "less".
/// @param units    Of the meter.
/// @param outdoor  The unit of temperatures.
[[nodiscard]] std::string describe(const Regression& regression,
                                   const display::MeterUnits& units = {},
                                   const display::Unit& outdoor = {"°C"});

}  // namespace recald::change_point
