/// Weather of one place out of several sources: sensors, then a file for the time before them.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/weather/weather_series.hpp"

namespace recald::weather {

struct WeatherSource {
  const WeatherSeries* series;
  bool is_sensor = false;
  /// The weather of no year in particular: it stands for a variable until an earlier source begins
  /// to measure it, and fills no gap afterwards.
  bool is_typical_year = false;
  /// When it began to measure each variable, be it long before the span: the same hour is merged
  /// alike whatever span is asked for. Absent: not yet.
  std::array<std::optional<Instant>, kWeatherVariables.size()> begun = {};
};

struct MergedWeather {
  WeatherSeries series;
  /// Of each hour and variable the source that it is from, counted from 1; 0: none has it.
  std::vector<std::array<std::uint8_t, kWeatherVariables.size()>> source;
};

/// Each hour and variable from the first source that has it. Where a sensor measures the global
/// irradiance, beam and diffuse of another source are left out: they would contradict it.
/// @param span  On the UTC hour; what none of the sources has is absent.
[[nodiscard]] MergedWeather merge_weather(const metering::TimeSpan& span,
                                          std::span<const WeatherSource> sources);

/// A stretch in which a variable is absent.
struct WeatherHole {
  std::size_t variable;  ///< Of `kWeatherVariables`.
  metering::TimeSpan span;
};

/// Stretches of one variable within `span` that are longer than `shortest`, in order of time.
[[nodiscard]] std::vector<WeatherHole> holes_in(const WeatherSeries& series, std::size_t variable,
                                                const metering::TimeSpan& span,
                                                std::chrono::seconds shortest);

}  // namespace recald::weather
