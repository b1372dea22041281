/// The complete hourly weather of a site over the months it needs.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/job_result.hpp"

#include "core/metering/civil_time.hpp"
#include "core/metering/months/month_closer.hpp"
#include "core/result.hpp"
#include "core/weather/assumed_sky.hpp"
#include "core/weather/weather_series.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"

namespace recald::daemon {

/// Indices in `weather::kWeatherVariables` of the variables that a building model needs.
inline constexpr std::array<std::size_t, 4> kNeededWeather{0, 1, 2, 4};

struct SiteWeather {
  weather::FilledWeather filled;
  weather::ValuesTaken values;
  std::vector<std::string> notes = {};  ///< What was done to the weather, in words.
  /// Variables that no source ever measured and that `assume_sky` added to `filled.series`: indices
  /// in `weather::kWeatherVariables`, ascending.
  std::vector<std::size_t> assumed = {};
  /// For each needed month, the share of its hours from each source, with filled hours as
  /// "interpolated", "typical" and "assumed": means over the variables that a model needs.
  std::map<metering::Month, std::map<std::string, double>> from = {};
  /// For each month with a hole in the weather, a sentence that names it.
  std::map<metering::Month, std::string> silence = {};
};

/// "Wind and sun are not measured: they are assumed from the temperature and the clear sky, and
/// count as uncertain."; empty: nothing is assumed. @param assumed  As SiteWeather::assumed.
[[nodiscard]] std::string assumed_words(const std::vector<std::size_t>& assumed);
[[nodiscard]] bool is_assumed(const SiteWeather& weather, std::size_t variable);

/// What the models need and a site's weather lacks.
struct WeatherLack {
  std::string sentence;  ///< Set if the temperature is missing, without which no model runs.
  std::vector<std::size_t> assumed;  ///< As SiteWeather::assumed.
};

/// Reads a weather CSV for variables that it lacks and no sensor measures. @pre site.weather
/// @return or an error of reading the file.
[[nodiscard]] Result<WeatherLack> lack_of_weather(const SiteConfig& site);

/// Reads the site's weather file and the readings of its sensors, and fills the gaps it can.
/// Sensors take precedence, in the order of the site file. The file provides the hours that they
/// lack, or, if it is a typical year, the time before them. Variables that none of them ever had
/// are assumed. @pre site.weather
/// @param months  The months needed: an EPW file is placed in their years. With sensors, only
///                they are complete.
/// @param live    The readings of sensors; null: there are none yet.
/// @return or an error of reading; not_enough_data without the temperature.
[[nodiscard]] Result<SiteWeather> load_weather(const SiteConfig& site,
                                               const metering::LocalCalendar& calendar,
                                               const metering::MonthRange& months,
                                               LiveReadings* live = nullptr);

/// How much of the weather is known in each of these months, and from where, whether or not a
/// model can run on it.
/// @pre as load_weather, months.first <= months.last
/// @return or an error of reading.
[[nodiscard]] Result<std::vector<MonthWeather>> known_weather(
    const SiteConfig& site, const metering::LocalCalendar& calendar,
    const metering::MonthRange& months, LiveReadings* live = nullptr);
/// As above, for weather already read and the months it was requested for.
[[nodiscard]] std::vector<MonthWeather> known_weather(const SiteWeather& weather);

/// How the temperatures of the site's weather file are interpreted, and how that is known. Reads
/// the file. @pre site.weather with a file
[[nodiscard]] Result<weather::ValuesTaken> weather_values(const SiteConfig& site);

/// Share of a month's hours in which the weather was measured or interpolated, for the worst of the
/// variables that the models need and that are not assumed; 0 for a month outside the file.
[[nodiscard]] double weather_coverage(const SiteWeather& weather, metering::Month month);

/// Column of the variable that `weather_coverage` refers to: "ghi_W_m2".
[[nodiscard]] std::string_view least_known_variable(const SiteWeather& weather,
                                                    metering::Month month);

}  // namespace recald::daemon
