/// The weather of a site over the months it needs, whole and hourly.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/job_result.hpp"

#include "core/metering/civil_time.hpp"
#include "core/metering/month_closer.hpp"
#include "core/result.hpp"
#include "core/weather/assumed_sky.hpp"
#include "core/weather/weather_series.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"

namespace recald::daemon {

/// Positions in `weather::kWeatherVariables` of what a building model cannot do without.
inline constexpr std::array<std::size_t, 4> kNeededWeather{0, 1, 2, 4};

struct SiteWeather {
  weather::FilledWeather filled;
  weather::ValuesTaken values;
  std::vector<std::string> notes = {};  ///< What was done to it, in words.
  /// What no source has ever measured and `filled.series` has all the same, by `assume_sky`:
  /// positions in `weather::kWeatherVariables`, ascending.
  std::vector<std::size_t> assumed = {};
  /// Of the months that are needed, the share of its hours that each source has, filled ones as
  /// "interpolated", "typical" and "assumed": means over what a model needs.
  std::map<metering::Month, std::map<std::string, double>> from = {};
  /// Of months with a stretch without weather a sentence that names it.
  std::map<metering::Month, std::string> silence = {};
};

/// "Wind and sun are not measured: they are assumed from the temperature and the clear sky, and
/// count as uncertain."; empty: nothing is assumed. @param assumed  As SiteWeather::assumed.
[[nodiscard]] std::string assumed_words(const std::vector<std::size_t>& assumed);
[[nodiscard]] bool is_assumed(const SiteWeather& weather, std::size_t variable);

/// What a site's weather lacks of what the models need.
struct WeatherLack {
  std::string sentence;              ///< No model runs without the temperature; empty: it is there.
  std::vector<std::size_t> assumed;  ///< As SiteWeather::assumed.
};

/// Reads the columns and rows of a weather CSV for what is in none of them, and measured by no
/// sensor. @pre site.weather
/// @return or what reading the file finds.
[[nodiscard]] Result<WeatherLack> lack_of_weather(const SiteConfig& site);

/// Reads the site's weather file and what its sensors have measured, and fills what it can. Sensors
/// come first, in order of the site file; the file has the hours that they lack, or, as a typical
/// year, the time before them. What none of them has ever had is assumed. @pre site.weather
/// @param months  Those that are needed: an EPW file is laid on their years. With sensors, only
///                they are whole.
/// @param live    Where sensors' readings are; null: nothing was read of them yet.
/// @return or what reading finds; not_enough_data without the temperature.
[[nodiscard]] Result<SiteWeather> load_weather(const SiteConfig& site,
                                               const metering::LocalCalendar& calendar,
                                               const metering::MonthRange& months,
                                               LiveReadings* live = nullptr);

/// How much is known of the weather of each of these months, and from where, whatever a model
/// lacks.
/// @pre as load_weather, months.first <= months.last
/// @return or what reading finds.
[[nodiscard]] Result<std::vector<MonthWeather>> known_weather(
    const SiteConfig& site, const metering::LocalCalendar& calendar,
    const metering::MonthRange& months, LiveReadings* live = nullptr);
/// The same of weather that has been read, for the months that were asked for.
[[nodiscard]] std::vector<MonthWeather> known_weather(const SiteWeather& weather);

/// What the temperatures of the site's weather file are taken for, and how that is known. Reads the
/// file. @pre site.weather with a file
[[nodiscard]] Result<weather::ValuesTaken> weather_values(const SiteConfig& site);

/// Share of a month's hours in which the weather was measured or interpolated, worst of the
/// variables that the models need and that are not assumed; 0 for a month that the file does not
/// touch.
[[nodiscard]] double weather_coverage(const SiteWeather& weather, metering::Month month);

/// Column of the variable that `weather_coverage` speaks of: "ghi_W_m2".
[[nodiscard]] std::string_view least_known_variable(const SiteWeather& weather,
                                                    metering::Month month);

}  // namespace recald::daemon
