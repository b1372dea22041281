/// The weather of a site over the months it needs, whole and hourly.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/metering/month_closer.hpp"
#include "core/result.hpp"
#include "core/weather/weather_series.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

struct SiteWeather {
  weather::FilledWeather filled;
  weather::ValuesTaken values;
  std::vector<std::string> notes;  ///< What was done to it, in words.
  std::string lack = {};           ///< WeatherLack::sentence.
};

/// What a weather file lacks of what the models need, and what still works without it.
struct WeatherLack {
  std::string sentence;    ///< Empty: it lacks nothing.
  bool stops_all = false;  ///< No model runs without the sun.
};

/// Reads the columns and rows of a weather CSV for what is in none of them. @pre site.weather
/// @return or what reading the file finds.
[[nodiscard]] Result<WeatherLack> lack_of_weather(const SiteConfig& site);

/// Reads the site's weather file and fills what it can. @pre site.weather
/// @param months  Those that are needed: an EPW file is laid on their years.
/// @return or what reading finds; not_enough_data for a file without the sun.
[[nodiscard]] Result<SiteWeather> load_weather(const SiteConfig& site,
                                               const metering::LocalCalendar& calendar,
                                               const metering::MonthRange& months);

/// What the temperatures of the site's weather file are taken for, and how that is known. Reads the
/// file. @pre site.weather
[[nodiscard]] Result<weather::ValuesTaken> weather_values(const SiteConfig& site);

/// Share of a month's hours in which the weather was measured or interpolated, worst of the
/// variables that the models need; 0 for a month that the file does not touch.
[[nodiscard]] double weather_coverage(const weather::FilledWeather& filled, metering::Month month);

/// Column of the variable that `weather_coverage` speaks of: "ghi_W_m2".
[[nodiscard]] std::string_view least_known_variable(const weather::FilledWeather& filled,
                                                    metering::Month month);

}  // namespace recald::daemon
