/// A first model of a building of which little more is known than what it is used for and how large
/// it is: typical constructions and loads, each marked as a guess.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/metering/months/month_closer.hpp"
#include "core/metering/reading.hpp"
#include "core/result.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::daemon {

struct StarterFacts {
  std::string use;  ///< One of `starter_uses`.
  double floor_area_m2 = 0.0;
  int storeys = 1;
  std::optional<int> built;     ///< Year; absent: before there were codes.
  int climate_zone = 4;         ///< See `climate_zone_of`.
  metering::MonthRange months;  ///< That the meters have.
  /// What may be modelled: ids of the site's meters and what they measure.
  std::vector<std::pair<std::string, metering::Utility>> meters;
};

[[nodiscard]] std::span<const std::string_view> starter_uses();

/// 1 (very hot) to 8 (subarctic), after the degree days of a year.
/// @return not_enough_data for less than 300 days of temperatures.
/// @see ANSI/ASHRAE Standard 169-2013, table A-3 (thermal zones).
[[nodiscard]] Result<int> climate_zone_of(const weather::WeatherSeries& weather);

/// [period], [[model]] and [building] of a site file, with a comment at each guess: how far off it
/// may be and what it is typical of.
/// @return invalid_value for a use that is not known (the nearest is named), an area or storeys out
///         of reason, or meters of which a model has none.
[[nodiscard]] Result<std::string> starter_model(const StarterFacts& facts);

}  // namespace recald::daemon
