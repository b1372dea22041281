#include "daemon/site/replay/sensor_weather.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/weather/merged_weather.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::Month;
using weather::SensorQuantity;
using weather::SensorValue;
using weather::WeatherHour;

constexpr std::chrono::hours kBridged{6};  // by a straight line: `weather::fill_gaps`

double within_bounds(const SensorQuantity& quantity, double value) {
  if (quantity.member == &WeatherHour::rel_humidity_pct) return std::min(value, 100.0);
  if (quantity.member == &WeatherHour::ghi_W_m2) return std::max(value, 0.0);
  return value;
}

/// One quantity of a sensor, as the store names it.
MeterConfig as_stored(const MeterConfig& sensor, const WeatherChannel& channel) {
  MeterConfig stored = sensor;
  stored.meter = stored_meter(sensor, channel);
  return stored;
}

bool is_of(const WeatherChannel& channel, std::size_t variable) {
  return channel.quantity->member == weather::kWeatherVariables[variable].member;
}

Result<std::vector<SensorValue>> read_values(const MeterConfig& sensor,
                                             const WeatherChannel& channel,
                                             const metering::TimeSpan& span, LiveReadings& live) {
  std::vector<SensorValue> values;
  const MeterConfig stored = as_stored(sensor, channel);
  TRY(live.for_each(stored, span, [&](const metering::Reading& reading) {
    if (reading.validity == metering::Validity::ok && std::isfinite(reading.mean_kW)) {
      values.push_back({reading.start, reading.mean_kW});
    }
  }));
  return values;
}

/// Finds the time when a sensor began to measure each variable.
Result<void> take_beginnings(const MeterConfig& sensor, LiveReadings& live,
                             weather::WeatherSource& source) {
  for (const WeatherChannel& channel : channels_of(sensor)) {
    const auto begun = TRY(live.first_start(as_stored(sensor, channel)));
    for (std::size_t v = 0; v < source.begun.size(); ++v) {
      if (is_of(channel, v)) source.begun[v] = begun;
    }
  }
  return {};
}

/// Shares of one month by source.
std::map<std::string, double> shares_of(const weather::MergedWeather& merged,
                                        const metering::TimeSpan& month,
                                        const std::vector<std::string>& names) {
  std::map<std::string, double> shares;
  double hours_in_month = 0.0;
  for (std::size_t i = 0; i < merged.source.size(); ++i) {
    // An hour belongs to the month that contains its middle.
    if (!month.contains(merged.series.begin + std::chrono::hours{i} + std::chrono::minutes{30}))
      continue;
    hours_in_month += 1.0;
    for (const std::size_t variable : kNeededWeather) {
      const std::size_t source = merged.source[i][variable];
      if (source > 0) shares[names[source - 1]] += 1.0;
    }
  }
  for (auto& [name, share] : shares) {
    share /= hours_in_month * static_cast<double>(kNeededWeather.size());
  }
  return shares;
}

/// The variables that no source measured in these months or before.
Result<std::vector<std::size_t>> never_measured(const weather::WeatherSeries& merged,
                                                const std::optional<FileWeather>& file,
                                                const SiteConfig& site, LiveReadings* live) {
  std::vector<std::size_t> lacking = weather::never_measured(merged);
  if (file) {
    const std::vector<std::size_t> of_file = weather::never_measured(file->series);
    std::erase_if(lacking, [&](std::size_t variable) {
      return std::ranges::find(of_file, variable) == of_file.end();
    });
  }
  for (const MeterConfig& sensor : site.sensors) {
    if (live == nullptr) break;
    for (const WeatherChannel& channel : channels_of(sensor)) {
      const auto begun = TRY(live->first_start(as_stored(sensor, channel)));
      if (begun) std::erase_if(lacking, [&](std::size_t v) { return is_of(channel, v); });
    }
  }
  return lacking;
}

/// Whether the sensor had begun to measure the variable and stored nothing in the hole, not even
/// values that were rejected.
Result<bool> is_silent_in(const weather::WeatherHole& hole, const MeterConfig& sensor,
                          LiveReadings& live) {
  for (const WeatherChannel& channel : channels_of(sensor)) {
    if (!is_of(channel, hole.variable)) continue;
    const MeterConfig stored = as_stored(sensor, channel);
    const auto begun = TRY(live.first_start(stored));
    if (!begun || *begun >= hole.span.begin) return false;
    // A hole begins and ends on the hour, and the sensor may have values for up to
    // half of that hour.
    const metering::TimeSpan inner{hole.span.begin + std::chrono::hours{1},
                                   hole.span.end - std::chrono::hours{1}};
    bool is_silent = true;
    TRY(live.for_each(stored, inner, [&](const metering::Reading& reading) {
      is_silent = is_silent && reading.validity == metering::Validity::missing;
    }));
    return is_silent;
  }
  return false;
}

/// "Sensor 'roof' was silent", or "Nothing is known" if silence is not the reason.
Result<std::string> reason_of(const weather::WeatherHole& hole, const SiteConfig& site,
                              LiveReadings* live) {
  std::vector<MeterConfig> silent;
  for (const MeterConfig& sensor : site.sensors) {
    if (live == nullptr) break;
    const auto is_silent = TRY(is_silent_in(hole, sensor, *live));
    if (is_silent) silent.push_back(sensor);
  }
  const auto measures = [&](const MeterConfig& sensor) {
    return std::ranges::any_of(channels_of(sensor), [&](const WeatherChannel& channel) {
      return is_of(channel, hole.variable);
    });
  };
  const auto measuring = std::ranges::count_if(site.sensors, measures);
  if (silent.empty() || std::ssize(silent) < measuring) return "Nothing is known";
  std::string words = sensor_words(silent);
  words.front() = 'S';
  return words + (silent.size() == 1 ? " was silent" : " were silent");
}

/// "Sensor 'roof' was silent from … to … (dry_bulb_C)."; empty: no significant hole.
Result<std::string> silence_of(const weather::WeatherSeries& series,
                               const metering::TimeSpan& month, const SiteConfig& site,
                               const SiteWeather& weather, LiveReadings* live) {
  std::vector<weather::WeatherHole> worst;  // of the variable with the longest one
  const auto longest = [](const std::vector<weather::WeatherHole>& holes) {
    return std::ranges::max_element(
        holes, {}, [](const weather::WeatherHole& hole) { return hole.span.length(); });
  };
  for (const std::size_t variable : kNeededWeather) {
    if (is_assumed(weather, variable)) continue;
    auto holes = weather::holes_in(series, variable, month, kBridged);
    if (holes.empty()) continue;
    if (worst.empty() || longest(holes)->span.length() > longest(worst)->span.length()) {
      worst = std::move(holes);
    }
  }
  if (worst.empty()) return "";
  const weather::WeatherHole& hole = *longest(worst);
  const auto reason = reason_of(hole, site, live);
  if (!reason) return reason;
  return fmt::format(
      "{} from {} to {} ({}){}.", *reason, metering::to_string(hole.span.begin),
      metering::to_string(hole.span.end), weather::kWeatherVariables[hole.variable].name,
      worst.size() > 1 ? fmt::format(" and at {} other times", worst.size() - 1) : "");
}

/// "Weather: 2024-01 to 2024-03 from weather.csv; 2024-04 from weather.csv and sensor 'roof'."
std::string source_words(const std::map<Month, std::map<std::string, double>>& from) {
  struct Run {
    Month first;
    Month last;
    std::string words;
  };
  std::vector<Run> runs;
  for (const auto& [month, shares] : from) {
    std::vector<std::string_view> names;
    for (const auto& [name, share] : shares) names.push_back(name);
    std::string words =
        names.empty() ? "from nowhere" : fmt::format("from {}", fmt::join(names, " and "));
    if (!runs.empty() && runs.back().words == words) {
      runs.back().last = month;
    } else {
      runs.push_back({month, month, std::move(words)});
    }
  }
  std::string text = "Weather: ";
  for (const Run& run : runs) {
    if (&run != &runs.front()) text += "; ";
    text += metering::to_string(run.first);
    if (run.last != run.first) text += " to " + metering::to_string(run.last);
    text += " " + run.words;
  }
  return text + ".";
}

}  // namespace

Result<SensorWeather> read_sensor(const MeterConfig& sensor, const metering::TimeSpan& span,
                                  LiveReadings& live) {
  const std::chrono::seconds interval = sensor.meter.interval;
  std::vector<weather::WeatherRecord> records;
  records.reserve(static_cast<std::size_t>(span.length() / interval));
  for (Instant start = span.begin; start < span.end; start += interval) {
    records.push_back({start, {}});
  }
  SensorWeather read;
  for (const WeatherChannel& channel : channels_of(sensor)) {
    auto values = TRY(read_values(sensor, channel, span, live));
    if (is_dry_bulb(*channel.quantity)) {
      read.frozen_intervals += weather::forget_frozen(values, interval);
    }
    for (const SensorValue& one : values) {
      const auto slot = static_cast<std::size_t>((one.start - span.begin) / interval);
      if (!std::isfinite(one.value) || slot >= records.size()) continue;
      records[slot].values.*channel.quantity->member = within_bounds(*channel.quantity, one.value);
    }
  }
  const bool instants = sensor.values == weather::RecordedValues::instant;
  read.series = TRY(weather::to_hourly(
      records, interval,
      instants ? weather::ValuesStand::at_its_start : weather::ValuesStand::over_the_record));
  return read;
}

Result<weather::WeatherSeries> merge_with_sensors(const SiteConfig& site,
                                                  const metering::LocalCalendar& calendar,
                                                  const metering::MonthRange& months,
                                                  const std::optional<FileWeather>& file,
                                                  LiveReadings* live, SiteWeather& result) {
  const metering::TimeSpan span{
      std::chrono::floor<std::chrono::hours>(calendar.month_span(months.first).begin) -
          std::chrono::hours{24},
      std::chrono::ceil<std::chrono::hours>(calendar.month_span(months.last).end) +
          std::chrono::hours{24}};
  std::vector<SensorWeather> sensors;
  std::vector<std::string> names;  // one per source
  for (const MeterConfig& sensor : site.sensors) {
    if (live == nullptr) continue;
    auto read = TRY(read_sensor(sensor, span, *live));
    names.push_back("sensor '" + sensor.meter.id + "'");
    if (read.frozen_intervals > 0) {
      result.notes.push_back(
          fmt::format("Sensor '{}': {} intervals of a dry bulb that stood still are not used.",
                      sensor.meter.id, read.frozen_intervals));
    }
    sensors.push_back(std::move(read));
  }
  std::vector<weather::WeatherSource> sources;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    sources.push_back({&sensors[i].series, true});
    if (!file || !file->is_typical_year) continue;
    TRY(take_beginnings(site.sensors[i], *live, sources.back()));
  }
  if (file) {
    sources.push_back({&file->series, false, file->is_typical_year});
    names.push_back(files_words(site.weather->files));
  }
  weather::MergedWeather merged = weather::merge_weather(span, sources);
  result.assumed = TRY(never_measured(merged.series, file, site, live));
  for (Month month = months.first; month <= months.last; month = metering::next_month(month)) {
    const metering::TimeSpan of_month = calendar.month_span(month);
    result.from[month] = shares_of(merged, of_month, names);
    auto silence = TRY(silence_of(merged.series, of_month, site, result, live));
    if (!silence.empty()) result.silence[month] = std::move(silence);
  }
  result.notes.push_back(source_words(result.from));
  return std::move(merged.series);
}

}  // namespace recald::daemon
