/// A month's weather in the few means over which a model's discrepancy may vary.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::weather {

struct MonthlyInputs {
  std::vector<std::string> names;  ///< (p)
  Eigen::MatrixXd values;          ///< (months x p)
};

/// Monthly means of dry bulb, relative humidity and wind speed, and the mean wind vector's
/// direction as sine and cosine: the seed's model inputs, but for its wind direction in plain
/// degrees, in which 359° and 1° are as far apart as they can be. Variables that the weather lacks
/// in some of the months, or that do not vary, are left out.
[[nodiscard]] MonthlyInputs monthly_inputs(const WeatherSeries& weather,
                                           const metering::LocalCalendar& calendar,
                                           const std::vector<metering::Month>& months);

}  // namespace recald::weather
