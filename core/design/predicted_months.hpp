/// Months that a design's runs did not simulate, predicted from the runs' days and the weather.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/model/schedule.hpp"
#include "core/result.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::design {

/// The days of all runs.
struct SimulatedDays {
  const std::vector<metering::Day>& days;  ///< Ascending; they need not be adjacent.
  const Eigen::MatrixXd& values;           ///< (runs x outputs * days), output-major.
  std::vector<bool> is_peak;  ///< (outputs) The highest power of a day, kW; else its energy, kWh.
};

/// Weather of the days and of the months to predict, and which days are days off.
struct PredictionWeather {
  const weather::WeatherSeries& series;
  const metering::LocalCalendar& calendar;
  const model::Holidays& holidays;
};

/// A month that cannot be predicted, since its weather is known on too few of its days.
struct LittleWeather {
  metering::Month month;
  int known_days;
  int days;
};

/// Predicted months whose mean of one of `weather::kDayMeans` no simulated month came near.
struct UnseenWeather {
  std::size_t quantity;
  double low;   ///< Of the simulated months.
  double high;  ///< Likewise.
  struct Mean {
    metering::Month month;
    double mean;
  };
  std::vector<Mean> beyond;
};

struct PredictedMonths {
  std::vector<metering::Month> months;  ///< Ascending.
  Eigen::MatrixXd figures;              ///< (runs x outputs * months), output-major.
  Eigen::VectorXd error_sd;             ///< (outputs) of a figure, output unit.
  Eigen::MatrixXd month_error_sd;       ///< (outputs x months) the same, by the time of year.
  std::vector<LittleWeather> left_out;
  std::vector<UnseenWeather> unseen;
};

/// Predicts the figures of every run (`regression::fit_weather_response`). Their error is that of
/// simulated months when left out, common to all runs of a month rather than independent.
///
/// @param simulated  The months of the days: passed over where they are wanted.
/// @param wanted     In any order. One that lacks the weather of more than a tenth of its days is
///                   left out.
/// @return the months, none where none is wanted; not_enough_data: the weather covers less than
///         three of the simulated ones; not_finite: a value.
[[nodiscard]] Result<PredictedMonths> predict_other_months(
    const SimulatedDays& days, const std::vector<metering::Month>& simulated,
    const PredictionWeather& weather, std::vector<metering::Month> wanted);

}  // namespace recald::design
