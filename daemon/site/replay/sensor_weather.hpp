/// Weather measured by a site's sensors, from the store, completed by the weather file.
#pragma once

#include <optional>

#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

struct SensorWeather {
  weather::WeatherSeries series;     ///< Covers the span; absent if the sensor has no value.
  std::size_t frozen_intervals = 0;  ///< Intervals with a frozen dry bulb, which are not used.
};

/// Hourly means of the accepted values. Humidity above 100 % and sun below zero, which sensors
/// report, are clipped.
/// @param span  On the UTC hour.
/// @return or the store's failure. @pre a weather sensor
[[nodiscard]] Result<SensorWeather> read_sensor(const MeterConfig& sensor,
                                                const metering::TimeSpan& span, LiveReadings& live);

/// Weather from a file.
struct FileWeather {
  weather::WeatherSeries series;
  bool is_typical_year = false;
};

/// The weather of these months and a day on each side, so that gaps at their ends can be bridged;
/// not filled yet. Fills `result` with notes, variables never measured, sources and silences.
/// @param file  Absent: only the sensors.
/// @param live  Null: the sensors have no readings yet.
/// @return or the store's failure. @pre the site has sensors
[[nodiscard]] Result<weather::WeatherSeries> merge_with_sensors(
    const SiteConfig& site, const metering::LocalCalendar& calendar,
    const metering::MonthRange& months, const std::optional<FileWeather>& file, LiveReadings* live,
    SiteWeather& result);

}  // namespace recald::daemon
