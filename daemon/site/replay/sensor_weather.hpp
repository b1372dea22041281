/// What the weather sensors of a site have measured, as the store has it, with the weather file
/// where they have nothing.
#pragma once

#include <optional>

#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

struct SensorWeather {
  weather::WeatherSeries series;     ///< Covers the span; absent where the sensor has no value.
  std::size_t frozen_intervals = 0;  ///< Of a dry bulb that stood still: not used.
};

/// Hours of the means that are believed. Humidity above 100 % and a sun below zero, which sensors
/// show, are cut off.
/// @param span  On the UTC hour.
/// @return or the store's failure. @pre a weather sensor
[[nodiscard]] Result<SensorWeather> read_sensor(const MeterConfig& sensor,
                                                const metering::TimeSpan& span, LiveReadings& live);

/// Weather as a file has it.
struct FileWeather {
  weather::WeatherSeries series;
  bool is_typical_year = false;
};

/// The weather of these months and a day on each side, over which gaps at their ends are bridged;
/// not filled. What is to be told of it goes into `result`: notes, what was never
/// measured, where it is from, silence.
/// @param file  Absent: the sensors alone.
/// @param live  Null: nothing of the sensors yet.
/// @return or the store's failure. @pre the site has sensors
[[nodiscard]] Result<weather::WeatherSeries> merge_with_sensors(
    const SiteConfig& site, const metering::LocalCalendar& calendar,
    const metering::MonthRange& months, const std::optional<FileWeather>& file, LiveReadings* live,
    SiteWeather& result);

}  // namespace recald::daemon
