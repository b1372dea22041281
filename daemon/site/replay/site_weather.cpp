#include "daemon/site/replay/site_weather.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "adapters/csv/weather_csv.hpp"
#include "adapters/epw/epw.hpp"
#include "daemon/site/config/weather_sensors.hpp"
#include "daemon/site/replay/sensor_weather.hpp"

namespace recald::daemon {
namespace {

constexpr std::size_t kSun = 4;  // in `weather::kWeatherVariables`

Result<csv::WeatherCsv> read_csv(const WeatherConfig& config) {
  return csv::read_weather(config.file, {.stamps = config.stamps, .values = config.values});
}

Result<weather::WeatherSeries> read_csv(const WeatherConfig& config, SiteWeather& result) {
  auto read = read_csv(config);
  if (!read) return tl::unexpected(read.error());
  result.values = read->values;
  std::vector<std::string>& notes = result.notes;
  if (read->issues.total > 0) {
    notes.push_back(fmt::format("Weather file: {} bad line{} kept out, the first at line {}: {}.",
                                read->issues.total, read->issues.total == 1 ? "" : "s",
                                read->issues.listed.front().line,
                                read->issues.listed.front().reason));
  }
  if (!read->ignored_columns.empty()) {
    notes.push_back(
        fmt::format("Weather file: columns not used: {}.", fmt::join(read->ignored_columns, ", ")));
  }
  return std::move(read->series);
}

weather::ValuesTaken epw_values(const WeatherConfig& config) {
  if (config.values) return {*config.values, weather::KnownBy::declared};
  return {weather::RecordedValues::instant, weather::KnownBy::usage};
}

/// One calendar year after the other from the same file. A typical year stands for each of them; a
/// recorded year only for itself.
Result<FileWeather> read_epw_years(const WeatherConfig& config, const metering::MonthRange& months,
                                   SiteWeather& result) {
  result.values = epw_values(config);
  std::vector<std::string>& notes = result.notes;
  const auto own = epw::read_epw(config.file, {}, result.values.values);
  if (!own) return tl::unexpected(own.error());
  if (!own->typical) {
    notes.insert(notes.end(), own->notes.begin(), own->notes.end());
    return FileWeather{own->series};
  }
  notes.push_back(
      "The weather is a typical year, not the weather of the measured months: misfit of single "
      "months says little.");
  weather::WeatherSeries all;
  // A year of local standard time ends within a day of the UTC year, so one more on each side.
  for (int year = static_cast<int>(months.first.year()) - 1;
       year <= static_cast<int>(months.last.year()) + 1; ++year) {
    const auto one = epw::read_epw(config.file, year, result.values.values);
    if (!one) return tl::unexpected(one.error());
    if (all.hours.empty()) all.begin = one->series.begin;
    all.hours.insert(all.hours.end(), one->series.hours.begin(), one->series.hours.end());
  }
  return FileWeather{std::move(all), true};
}

/// @pre the site has a file
Result<FileWeather> read_file(const WeatherConfig& config, const metering::MonthRange& months,
                              SiteWeather& result) {
  if (config.format == WeatherFormat::epw) return read_epw_years(config, months, result);
  auto series = read_csv(config, result);
  if (!series) return tl::unexpected(series.error());
  return FileWeather{std::move(*series)};
}

struct KnownShare {
  double share;
  std::size_t variable;  ///< Position in `weather::kWeatherVariables`.
};

/// Of the needed variables the one that is known least; none of a month that the file does not
/// touch.
KnownShare least_known(const weather::FilledWeather& filled, metering::Month month) {
  const auto found = std::ranges::find(filled.coverage, month, &weather::WeatherCoverage::month);
  if (found == filled.coverage.end()) return {0.0, kNeededWeather.front()};
  KnownShare least{1.0, kNeededWeather.front()};
  for (const std::size_t variable : kNeededWeather) {
    const double share = found->measured[variable] + found->interpolated[variable];
    if (share < least.share) least = {share, variable};
  }
  return least;
}

bool has_any(const weather::WeatherSeries& series, std::size_t variable) {
  const auto member = weather::kWeatherVariables[variable].member;
  return std::ranges::any_of(
      series.hours, [&](const weather::WeatherHour& hour) { return std::isfinite(hour.*member); });
}

/// @param is_absent  Of a needed variable.
/// @param whose      "the weather in weather.csv"
template <class IsAbsent>
WeatherLack lack_of(IsAbsent is_absent, const std::string& whose) {
  std::vector<std::string_view> absent;
  for (const std::size_t variable : kNeededWeather) {
    if (is_absent(variable)) absent.push_back(weather::kWeatherVariables[variable].name);
  }
  if (absent.empty()) return {};
  const bool no_sun = is_absent(kSun);
  return {fmt::format("{} has no {}. {} Add what is missing, or give an EPW file", whose,
                      fmt::join(absent, ", "),
                      no_sun ? "Without the sun no model can be run: calibrate, report, profile, "
                               "doe, drift and diagnose do not work. replay, run, import and "
                               "export do."
                             : "diagnose assumes usual values, but calibrate, report, profile, doe "
                               "and drift do not work. replay, run, import and export do."),
          no_sun};
}

std::string whose_weather(const SiteConfig& site) {
  if (site.sensors.empty()) return "the weather in " + site.weather->file.filename().string();
  std::string whose = "the weather of " + sensor_words(site.sensors);
  if (!site.weather->file.empty()) {
    whose += " and in " + site.weather->file.filename().string();
  }
  return whose;
}

bool is_measured(const SiteConfig& site, std::size_t variable) {
  const std::string_view name = weather::kWeatherVariables[variable].name;
  return std::ranges::any_of(site.sensors, [&](const MeterConfig& sensor) {
    return std::ranges::any_of(quantities_of(sensor),
                               [&](const auto* quantity) { return quantity->name == name; });
  });
}

/// Of a file alone: what it has, and where it ends before a month does.
void describe_file(const SiteConfig& site, const metering::LocalCalendar& calendar,
                   const metering::MonthRange& months, const weather::WeatherSeries& series,
                   SiteWeather& result) {
  const std::string name = site.weather->file.filename().string();
  for (metering::Month month = months.first; month <= months.last;
       month = metering::next_month(month)) {
    const auto found =
        std::ranges::find(result.filled.coverage, month, &weather::WeatherCoverage::month);
    double measured = 0.0;
    for (const std::size_t variable : kNeededWeather) {
      if (found == result.filled.coverage.end()) break;
      measured += found->measured[variable] / static_cast<double>(kNeededWeather.size());
    }
    result.from[month][name] = measured;
    if (series.end() >= calendar.month_span(month).end) continue;
    result.silence[month] = fmt::format("{} ends at {}.", name, metering::to_string(series.end()));
  }
}

/// What was filled, beside what the sources have.
void add_filled_shares(SiteWeather& result) {
  for (auto& [month, from] : result.from) {
    const auto found =
        std::ranges::find(result.filled.coverage, month, &weather::WeatherCoverage::month);
    if (found == result.filled.coverage.end()) continue;
    for (const std::size_t variable : kNeededWeather) {
      from["interpolated"] +=
          found->interpolated[variable] / static_cast<double>(kNeededWeather.size());
      from["typical"] += found->typical[variable] / static_cast<double>(kNeededWeather.size());
    }
  }
}

/// @pre site.weather
Result<SiteWeather> read_all(const SiteConfig& site, const metering::LocalCalendar& calendar,
                             const metering::MonthRange& months, LiveReadings* live) {
  SiteWeather result;
  if (site.sensors.empty()) {
    const auto file = read_file(*site.weather, months, result);
    if (!file) return tl::unexpected(file.error());
    result.filled = weather::fill_gaps(file->series, calendar);
    describe_file(site, calendar, months, file->series, result);
  } else {
    std::optional<FileWeather> file;
    if (!site.weather->file.empty()) {
      auto read = read_file(*site.weather, months, result);
      if (!read) return tl::unexpected(read.error());
      file = std::move(*read);
    }
    const auto series = merge_with_sensors(site, calendar, months, file, live, result);
    if (!series) return tl::unexpected(series.error());
    result.filled = weather::fill_gaps(*series, calendar);
  }
  add_filled_shares(result);
  return result;
}

}  // namespace

Result<WeatherLack> lack_of_weather(const SiteConfig& site) {
  const WeatherConfig& config = *site.weather;
  weather::WeatherSeries series;
  if (!config.file.empty()) {
    if (config.format == WeatherFormat::epw) return WeatherLack{};  // has all of it
    auto read = read_csv(config);
    if (!read) return tl::unexpected(read.error());
    series = std::move(read->series);
  }
  return lack_of(
      [&](std::size_t variable) {
        return !has_any(series, variable) && !is_measured(site, variable);
      },
      whose_weather(site));
}

Result<SiteWeather> load_weather(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                 const metering::MonthRange& months, LiveReadings* live) {
  auto result = read_all(site, calendar, months, live);
  if (!result) return result;
  WeatherLack lack =
      lack_of([&](std::size_t variable) { return !has_any(result->filled.series, variable); },
              whose_weather(site));
  if (lack.stops_all) return failure(ErrorCode::not_enough_data, std::move(lack.sentence));
  result->lack = std::move(lack.sentence);
  return result;
}

Result<std::vector<MonthWeather>> known_weather(const SiteConfig& site,
                                                const metering::LocalCalendar& calendar,
                                                const metering::MonthRange& months,
                                                LiveReadings* live) {
  const auto read = read_all(site, calendar, months, live);
  if (!read) return tl::unexpected(read.error());
  return known_weather(*read);
}

std::vector<MonthWeather> known_weather(const SiteWeather& weather) {
  std::vector<MonthWeather> months;
  for (const auto& [month, from] : weather.from) {
    months.push_back({metering::to_string(month), weather_coverage(weather.filled, month), from});
  }
  return months;
}

Result<weather::ValuesTaken> weather_values(const SiteConfig& site) {
  if (site.weather->format == WeatherFormat::epw) return epw_values(*site.weather);
  const auto read = read_csv(*site.weather);
  if (!read) return tl::unexpected(read.error());
  return read->values;
}

double weather_coverage(const weather::FilledWeather& filled, metering::Month month) {
  return least_known(filled, month).share;
}

std::string_view least_known_variable(const weather::FilledWeather& filled, metering::Month month) {
  return weather::kWeatherVariables[least_known(filled, month).variable].name;
}

}  // namespace recald::daemon
