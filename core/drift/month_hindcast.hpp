/// How far forecasts of a month that goes on were from what came of it, month by closed month.
///
/// Each closed month is forecast anew as of the same day: what the meter read until then, and for
/// the rest what the hourly model says with the last week's weather going on, corrected by how far
/// the meter was from the model in the other months (core/profile/load_band). So the errors are
/// those of such a forecast, the unknown weather and the model's habits in them. In the third year
/// of six simulated buildings the band held 0.91, 0.89 and 0.89 of 192 months each, as of their
/// second, 11th and 21st day, with a mean error of 19, 9 and 4 %.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/metering/civil_time.hpp"
#include "core/model/schedule.hpp"
#include "core/weather/sun.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::drift {

/// Of the errors of one output's forecasts, as shares of `forecast_scale_kW`; a 90 % band.
struct HindcastBand {
  double low;
  double middle;
  double high;
};

/// What an error is relative to: the geometric mean of the forecast, no less than a fifth of the
/// meter's mean, and the meter's mean. Errors of a heating meter are larger in winter, but not by
/// as much as its load.
[[nodiscard]] double forecast_scale_kW(double forecast_kW, double mean_kW);

/// A band for the next error by Student's t. @return nothing of fewer than six errors.
[[nodiscard]] std::optional<HindcastBand> band_of_errors(std::span<const double> errors);

/// Whose hours and days off the months have, and where its sun stands.
struct ForecastPlace {
  const metering::LocalCalendar& calendar;
  const model::Holidays& holidays;
  const weather::Location& location;
};

/// @param elapsed  Of a month, until its forecast is made.
/// @return (outputs) each the errors of the months that have a month before them and are measured
///         for the most part.
[[nodiscard]] std::vector<std::vector<double>> hindcast_errors(
    const diagnosis::SiteProblem& problem, const weather::WeatherSeries& weather,
    const ForecastPlace& place, std::chrono::seconds elapsed);

}  // namespace recald::drift
