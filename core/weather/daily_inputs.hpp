/// A day's weather in the terms that the energy of a building follows.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::weather {

/// A day in four figures, by which weather is compared with other weather.
inline constexpr std::array<std::string_view, 4> kDayMeans = {"temperature", "sun",
                                                              "humidity ratio", "wind speed"};
inline constexpr std::array<std::string_view, 4> kDayMeanUnits = {"°C", "W/m²", "g/kg", "m/s"};

struct DailyInputs {
  std::vector<metering::Day> days;
  Eigen::MatrixXd terms;  ///< (days x terms); a row is NaN where the day's weather is not whole.
  Eigen::MatrixXd means;  ///< (days x 4) in order of `kDayMeans`; likewise.
};

/// What a regression of a day's energy on the weather needs so that a straight line in each term
/// is enough. (T - b)+ is the mean over hours of what the temperature has above b.
///
///   today      T; (T - b)+ by day, 7 to 19 h, and over all hours; (b - T)+; sun, and sun on warm
///              days; humidity ratio above two thresholds; wind times cold
///   its peaks  temperature at 5 to 9 h, highest hour of temperature, sun and humidity ratio, and
///              what they have beyond thresholds
///   memory     yesterday's temperature and sun, and their means over the days before, which fade
///              by 1 - 1/e in three days: a warehouse remembers a week
///
/// A day before the series begins is taken to have been as the first day.
/// Means of a month are not enough: a month of 15 °C cools and heats, or does neither.
///
/// @param days  Local days, in any order.
/// @note  Needs temperature, humidity, wind and global irradiance of every hour; standard pressure
///        stands in for an absent one.
[[nodiscard]] DailyInputs daily_inputs(const WeatherSeries& weather,
                                       const metering::LocalCalendar& calendar,
                                       const std::vector<metering::Day>& days);

/// All local days of these months, month by month.
[[nodiscard]] std::vector<metering::Day> days_of(const std::vector<metering::Month>& months);

}  // namespace recald::weather
