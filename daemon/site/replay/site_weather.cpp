#include "daemon/site/replay/site_weather.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "adapters/csv/weather_csv.hpp"
#include "adapters/epw/epw.hpp"
#include "daemon/site/config/weather_sensors.hpp"
#include "daemon/site/replay/sensor_weather.hpp"

namespace recald::daemon {
namespace {

constexpr std::size_t kDryBulb = 0;  // index in `weather::kWeatherVariables`

Result<csv::WeatherCsv> read_csv(const WeatherConfig& config) {
  return csv::read_weather(config.files.front(),
                           {.stamps = config.stamps, .values = config.values});
}

Result<weather::WeatherSeries> read_csv(const WeatherConfig& config, SiteWeather& result) {
  auto read = TRY(read_csv(config));
  result.values = read.values;
  std::vector<std::string>& notes = result.notes;
  if (read.issues.total > 0) {
    notes.push_back(fmt::format("Weather file: {} bad line{} kept out, the first at line {}: {}.",
                                read.issues.total, read.issues.total == 1 ? "" : "s",
                                read.issues.listed.front().line,
                                read.issues.listed.front().reason));
  }
  if (!read.ignored_columns.empty()) {
    notes.push_back(
        fmt::format("Weather file: columns not used: {}.", fmt::join(read.ignored_columns, ", ")));
  }
  return std::move(read.series);
}

weather::ValuesTaken epw_values(const WeatherConfig& config) {
  if (config.values) return {*config.values, weather::KnownBy::declared};
  return {weather::RecordedValues::instant, weather::KnownBy::usage};
}

/// Reads the same file for each calendar year in turn. A typical year stands for every year; a
/// recorded year only for itself.
Result<FileWeather> read_epw_years(const WeatherConfig& config, const metering::MonthRange& months,
                                   SiteWeather& result) {
  result.values = epw_values(config);
  std::vector<std::string>& notes = result.notes;
  const auto own = TRY(epw::read_epw(config.files.front(), {}, result.values.values));
  if (!own.typical) {
    notes.insert(notes.end(), own.notes.begin(), own.notes.end());
    return FileWeather{own.series};
  }
  notes.push_back(
      "The weather is a typical year, not the weather of the measured months: misfit of single "
      "months says little.");
  weather::WeatherSeries all;
  // A year in local standard time ends within a day of the UTC year, so one more year on each side.
  for (int year = static_cast<int>(months.first.year()) - 1;
       year <= static_cast<int>(months.last.year()) + 1; ++year) {
    const auto one = TRY(epw::read_epw(config.files.front(), year, result.values.values));
    if (all.hours.empty()) all.begin = one.series.begin;
    all.hours.insert(all.hours.end(), one.series.hours.begin(), one.series.hours.end());
  }
  return FileWeather{std::move(all), true};
}

/// Several recorded years, each in its own file, in any order. Hours between them are absent.
Result<FileWeather> read_epw_list(const WeatherConfig& config, SiteWeather& result) {
  result.values = epw_values(config);
  std::map<metering::Instant, std::pair<std::string, weather::WeatherSeries>> years;
  for (const std::filesystem::path& file : config.files) {
    auto one = TRY(epw::read_epw(file, {}, result.values.values));
    const std::string name = file.filename().string();
    if (one.typical) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("{} is a typical year; only recorded years may be listed", name));
    }
    result.notes.insert(result.notes.end(), one.notes.begin(), one.notes.end());
    const metering::Instant begin = one.series.begin;
    const auto added = years.try_emplace(begin, name, std::move(one.series));
    if (!added.second) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("{} and {} are of the same year; list one of them",
                                 added.first->second.first, name));
    }
  }
  weather::WeatherSeries all{.begin = years.begin()->first, .hours = {}};
  for (auto& [begin, year] : years) {
    const auto gap = begin - all.end();
    if (gap < std::chrono::seconds{0}) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("{} begins before the year before it ends", year.first));
    }
    all.hours.resize(all.hours.size() + static_cast<std::size_t>(gap / std::chrono::hours{1}));
    all.hours.insert(all.hours.end(), year.second.hours.begin(), year.second.hours.end());
  }
  return FileWeather{std::move(all)};
}

/// @pre the site has a file
Result<FileWeather> read_file(const WeatherConfig& config, const metering::MonthRange& months,
                              SiteWeather& result) {
  if (config.files.size() > 1) return read_epw_list(config, result);
  if (config.format == WeatherFormat::epw) return read_epw_years(config, months, result);
  auto series = TRY(read_csv(config, result));
  return FileWeather{std::move(series)};
}

struct KnownShare {
  double share;
  std::size_t variable;  ///< Index in `weather::kWeatherVariables`.
};

/// The least known of the needed variables; its share is 0 for a month outside the file.
KnownShare least_known(const SiteWeather& weather, metering::Month month) {
  const auto& coverage = weather.filled.coverage;
  const auto found = std::ranges::find(coverage, month, &weather::WeatherCoverage::month);
  if (found == coverage.end()) return {0.0, kNeededWeather.front()};
  KnownShare least{1.0, kNeededWeather.front()};
  for (const std::size_t variable : kNeededWeather) {
    if (is_assumed(weather, variable)) continue;
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

std::string no_dry_bulb_words(const SiteConfig& site) {
  std::string whose = "in " + files_words(site.weather->files);
  if (!site.sensors.empty()) {
    whose =
        "of " + sensor_words(site.sensors) + (site.weather->files.empty() ? "" : " and " + whose);
  }
  return "the weather " + whose +
         " has no dry_bulb_C. Without the temperature no model can be run: calibrate, report, "
         "profile, doe, drift and diagnose do not work. replay, run, import and export do. Add it, "
         "or give an EPW file";
}

/// The plain name of a variable that may be assumed: "humidity".
std::string_view plain_name(std::size_t variable) {
  static constexpr std::array<std::string_view, 3> kNames = {"humidity", "wind", "sun"};
  const auto found = std::ranges::find(weather::kAssumable, variable);
  return kNames.at(static_cast<std::size_t>(found - weather::kAssumable.begin()));
}

bool is_measured(const SiteConfig& site, std::size_t variable) {
  const std::string_view name = weather::kWeatherVariables[variable].name;
  return std::ranges::any_of(site.sensors, [&](const MeterConfig& sensor) {
    return std::ranges::any_of(quantities_of(sensor),
                               [&](const auto* quantity) { return quantity->name == name; });
  });
}

/// Describes a file without sensors: what it has, and where it ends before a month does.
void describe_file(const SiteConfig& site, const metering::LocalCalendar& calendar,
                   const metering::MonthRange& months, const weather::WeatherSeries& series,
                   SiteWeather& result) {
  const std::string name = files_words(site.weather->files);
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

/// Adds what was filled to the shares of the sources.
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
    if (result.assumed.empty()) continue;
    const double has_dry_bulb =
        found->measured[kDryBulb] + found->interpolated[kDryBulb] + found->typical[kDryBulb];
    from["assumed"] = has_dry_bulb * static_cast<double>(result.assumed.size()) /
                      static_cast<double>(kNeededWeather.size());
  }
}

/// @pre site.weather
Result<SiteWeather> read_all(const SiteConfig& site, const metering::LocalCalendar& calendar,
                             const metering::MonthRange& months, LiveReadings* live) {
  SiteWeather result;
  if (site.sensors.empty()) {
    const auto file = TRY(read_file(*site.weather, months, result));
    result.assumed = weather::never_measured(file.series);
    result.filled = weather::fill_gaps(file.series, calendar);
    describe_file(site, calendar, months, file.series, result);
  } else {
    std::optional<FileWeather> file;
    if (!site.weather->files.empty()) {
      file = TRY(read_file(*site.weather, months, result));
    }
    const auto series = TRY(merge_with_sensors(site, calendar, months, file, live, result));
    result.filled = weather::fill_gaps(series, calendar);
  }
  // A site without a location has no model, so nothing needs the missing variables.
  if (site.location && !result.assumed.empty()) {
    weather::assume_sky(result.filled.series, *site.location, result.assumed);
    result.notes.push_back(assumed_words(result.assumed));
  }
  add_filled_shares(result);
  return result;
}

}  // namespace

std::string assumed_words(const std::vector<std::size_t>& assumed) {
  if (assumed.empty()) return "";
  std::string names;
  for (std::size_t i = 0; i < assumed.size(); ++i) {
    if (i > 0) names += i + 1 < assumed.size() ? ", " : " and ";
    names += plain_name(assumed[i]);
  }
  names.front() = static_cast<char>(std::toupper(names.front()));
  const bool is_one = assumed.size() == 1;
  return fmt::format(
      "{} {} not measured: {} assumed from the temperature and the clear sky, and {} as uncertain.",
      names, is_one ? "is" : "are", is_one ? "it is" : "they are", is_one ? "counts" : "count");
}

bool is_assumed(const SiteWeather& weather, std::size_t variable) {
  return std::ranges::find(weather.assumed, variable) != weather.assumed.end();
}

Result<WeatherLack> lack_of_weather(const SiteConfig& site) {
  const WeatherConfig& config = *site.weather;
  weather::WeatherSeries series;
  if (!config.files.empty()) {
    if (config.format == WeatherFormat::epw) return WeatherLack{};  // EPW files have all variables
    auto read = TRY(read_csv(config));
    series = std::move(read.series);
  }
  WeatherLack lack;
  if (!has_any(series, kDryBulb) && !is_measured(site, kDryBulb)) {
    lack.sentence = no_dry_bulb_words(site);
  }
  lack.assumed = weather::never_measured(series);
  std::erase_if(lack.assumed, [&](std::size_t variable) { return is_measured(site, variable); });
  return lack;
}

Result<SiteWeather> load_weather(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                 const metering::MonthRange& months, LiveReadings* live) {
  auto result = read_all(site, calendar, months, live);
  if (result && !has_any(result->filled.series, kDryBulb)) {
    return failure(ErrorCode::not_enough_data, no_dry_bulb_words(site));
  }
  return result;
}

Result<std::vector<MonthWeather>> known_weather(const SiteConfig& site,
                                                const metering::LocalCalendar& calendar,
                                                const metering::MonthRange& months,
                                                LiveReadings* live) {
  const auto read = TRY(read_all(site, calendar, months, live));
  return known_weather(read);
}

std::vector<MonthWeather> known_weather(const SiteWeather& weather) {
  std::vector<MonthWeather> months;
  for (const auto& [month, from] : weather.from) {
    months.push_back({metering::to_string(month), weather_coverage(weather, month), from});
  }
  return months;
}

Result<weather::ValuesTaken> weather_values(const SiteConfig& site) {
  if (site.weather->format == WeatherFormat::epw) return epw_values(*site.weather);
  const auto read = TRY(read_csv(*site.weather));
  return read.values;
}

double weather_coverage(const SiteWeather& weather, metering::Month month) {
  return least_known(weather, month).share;
}

std::string_view least_known_variable(const SiteWeather& weather, metering::Month month) {
  return weather::kWeatherVariables[least_known(weather, month).variable].name;
}

}  // namespace recald::daemon
