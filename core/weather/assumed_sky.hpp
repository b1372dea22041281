/// Humidity, wind and sun of a place where only the temperature is measured.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/weather/sun.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::weather {

/// Positions in `kWeatherVariables` of what can be assumed: humidity, wind speed, global sun.
inline constexpr std::array<std::size_t, 3> kAssumable{1, 2, 4};

/// Those of `kAssumable` of which the series has no value at all.
[[nodiscard]] std::vector<std::size_t> never_measured(const WeatherSeries& series);

/// How far the truth may be from what is assumed, in all hours together.
struct SkyError {
  double dew_point_K = 0.0;  ///< Added to the dew point.
  double wind_factor = 1.0;
  double sun_factor = 1.0;
};

/// One standard deviation, rounded up from what a maritime station shows (Cambridge, 48 months of
/// 2015 to 2018): the sun's sum over a month was 0.75 to 1.05 of what is assumed, 0.89 on average;
/// the mean dew point 1.5 K below to 1.8 K above; the mean wind 1.1 to 2.2 times.
inline constexpr SkyError kSkyErrorSd{.dew_point_K = 2.0, .wind_factor = 1.4, .sun_factor = 1.2};

/// Fills each of `variables` in every hour that has a dry bulb, whatever stood there; other hours
/// and variables stay as they are. Days are those of the mean sun.
///
/// - Humidity: the dew point is the day's lowest dry bulb (Allen et al. 1998, FAO Irrigation and
///   Drainage Paper 56, eq. 48); at most 100 %.
/// - Wind: 3 m/s.
/// - Sun: a cloudless sky times a factor of the day, at most 1, so that the day's sum is the
///   extraterrestrial one times 0.7 (1 - exp(-b dT^2.4)), b = 0.036 exp(-0.154 dT_mean): dT in K is
///   the day's highest dry bulb less the mean of its lowest and that of the day after, dT_mean its
///   mean over 31 days. A wide range is that of a day without clouds.
///
/// @param variables  Of `kAssumable`.
/// @param error      The sun may then be more than a cloudless sky; humidity stays at most 100 %.
/// @see Bristow and Campbell (1984), Agric. For. Meteorol. 31, 159-166.
void assume_sky(WeatherSeries& series, const Location& location,
                std::span<const std::size_t> variables, const SkyError& error = {});

}  // namespace recald::weather
