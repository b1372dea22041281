/// What a simulated building makes of weather that it was not simulated with: a regression of each
/// run's days on their weather.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/result.hpp"

namespace recald::regression {

/// Days as the regression sees them, whichever run they are of.
struct ResponseDays {
  Eigen::MatrixXd terms;    ///< (days x terms) of the weather, finite, as `weather::daily_inputs`.
  std::vector<int> kinds;   ///< (days) 0…2: working day, Saturday, Sunday.
  Eigen::VectorXd season;   ///< (days) phase of the year, rad; what schedules do with the seasons.
  std::vector<int> months;  ///< (days) 0, 1, … ascending: the month that a day belongs to.

  [[nodiscard]] Eigen::Index count() const { return terms.rows(); }
  [[nodiscard]] int month_count() const { return months.empty() ? 0 : months.back() + 1; }
};

/// How well months that were left out are predicted.
struct ResponseError {
  double penalty;       ///< Chosen.
  double spread_share;  ///< Chosen; of a peak's days, see `fit_weather_response`. 0 for energy.
  double sd;            ///< Root mean square over runs and months, in the output's unit.
  Eigen::VectorXd by_month;  ///< (months) the same, over runs.
};

struct WeatherResponse {
  Eigen::VectorXd term_means;
  Eigen::VectorXd term_scales;
  Eigen::MatrixXd coefficients;  ///< (columns x outputs * runs), output-major; of scaled days.
  Eigen::VectorXd means;         ///< (outputs * runs) of each run's days.
  Eigen::VectorXd scales;        ///< (outputs * runs)
  Eigen::VectorXd spreads;       ///< (outputs * runs) sd of days left out, in the output's unit.
  std::vector<bool> is_peak;     ///< (outputs)
  std::vector<ResponseError> errors;  ///< (outputs)
};

/// Of each output of each run, ridge regression of the day's value (its energy, or its highest
/// power) on the day's weather:
///
///     min  |y - B c|^2 + penalty |c|^2,   B = [1, kinds, X, X kinds, X cos s, X sin s, …]
///
/// with y and the terms X centred and scaled to unit spread, s the phase of the year. B is that of
/// all runs, so B'B + penalty I = L L' is factorised once a penalty. The penalty is chosen for each
/// output among 0.3, 1, 3, 10 and 30 by months left out whole. They need no other fit: with
/// Z = L^-1 B', H = Z' Z and r = (I - H) y, the days m of a month have the left-out residuals
/// (I - H_mm)^-1 r_m.
///
/// A month's energy is the mean of its days. Its peak is the expected highest of its days, which
/// have a spread about their prediction: without it the highest of thirty is too low, with all of
/// it often too high, because the spread is not of each day anew. So 0, half or all of the spread
/// is taken, whichever predicts left-out months best.
///
/// @param values   (runs x outputs * days), output-major: energy in kWh/day or power in kW.
/// @param is_peak  (outputs)
/// @return the fit; not_enough_data: fewer than three months; not_finite: a value.
/// @note   With n days, c columns (326 of 52 terms), N runs times outputs: a penalty costs
///         c^2 n + c^3 / 3 + 4 n c N flops, all five 6e9 of 730 days, 200 runs and six outputs.
/// @see    Hastie, Tibshirani, Friedman (2009), The Elements of Statistical Learning, eqs. (3.44)
///         and (5.26), the latter here for blocks.
[[nodiscard]] Result<WeatherResponse> fit_weather_response(const ResponseDays& days,
                                                           const Eigen::MatrixXd& values,
                                                           const std::vector<bool>& is_peak);

/// @return (runs x outputs * months) of the days' months, output-major: kWh/day or kW.
/// @pre the same terms as in the fit
/// @note 2 n c N flops, and for peaks 64 x 31 error functions a run and month.
[[nodiscard]] Eigen::MatrixXd predict_months(const WeatherResponse& response,
                                             const ResponseDays& days);

}  // namespace recald::regression
