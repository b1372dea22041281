#include "daemon/site/replay/site_weather.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "adapters/csv/weather_csv.hpp"
#include "adapters/epw/epw.hpp"

namespace recald::daemon {
namespace {

/// Positions in `weather::kWeatherVariables` of what a building model cannot do without.
constexpr std::array<std::size_t, 4> kNeeded = {0, 1, 2, 4};
constexpr std::size_t kSun = 4;

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
Result<weather::WeatherSeries> read_epw_years(const WeatherConfig& config,
                                              const metering::MonthRange& months,
                                              SiteWeather& result) {
  result.values = epw_values(config);
  std::vector<std::string>& notes = result.notes;
  const auto own = epw::read_epw(config.file, {}, result.values.values);
  if (!own) return tl::unexpected(own.error());
  if (!own->typical) {
    notes.insert(notes.end(), own->notes.begin(), own->notes.end());
    return own->series;
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
  return all;
}

struct KnownShare {
  double share;
  std::size_t variable;  ///< Position in `weather::kWeatherVariables`.
};

/// Of the needed variables the one that is known least; none of a month that the file does not
/// touch.
KnownShare least_known(const weather::FilledWeather& filled, metering::Month month) {
  const auto found = std::ranges::find(filled.coverage, month, &weather::WeatherCoverage::month);
  if (found == filled.coverage.end()) return {0.0, kNeeded.front()};
  KnownShare least{1.0, kNeeded.front()};
  for (const std::size_t variable : kNeeded) {
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

WeatherLack lack_of(const weather::WeatherSeries& series, const std::filesystem::path& file) {
  std::vector<std::string_view> absent;
  for (const std::size_t variable : kNeeded) {
    if (!has_any(series, variable)) absent.push_back(weather::kWeatherVariables[variable].name);
  }
  if (absent.empty()) return {};
  const bool no_sun = !has_any(series, kSun);
  return {fmt::format("the weather in {} has no {}. {} Add what is missing, or give an EPW file",
                      file.filename().string(), fmt::join(absent, ", "),
                      no_sun ? "Without the sun no model can be run: calibrate, report, profile, "
                               "doe, drift and diagnose do not work. replay, run, import and "
                               "export do."
                             : "diagnose assumes usual values, but calibrate, report, profile, doe "
                               "and drift do not work. replay, run, import and export do."),
          no_sun};
}

}  // namespace

Result<WeatherLack> lack_of_weather(const SiteConfig& site) {
  if (site.weather->format == WeatherFormat::epw) return WeatherLack{};  // has all of it
  const auto read = read_csv(*site.weather);
  if (!read) return tl::unexpected(read.error());
  return lack_of(read->series, site.weather->file);
}

Result<SiteWeather> load_weather(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                 const metering::MonthRange& months) {
  SiteWeather result;
  const auto series = site.weather->format == WeatherFormat::epw
                          ? read_epw_years(*site.weather, months, result)
                          : read_csv(*site.weather, result);
  if (!series) return tl::unexpected(series.error());
  WeatherLack lack = lack_of(*series, site.weather->file);
  if (lack.stops_all) return failure(ErrorCode::not_enough_data, std::move(lack.sentence));
  result.lack = std::move(lack.sentence);
  result.filled = weather::fill_gaps(*series, calendar);
  return result;
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
