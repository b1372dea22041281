#include "core/weather/merged_weather.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "core/absent.hpp"

namespace recald::weather {
namespace {

using std::chrono::hours;

constexpr std::size_t kSources = 255;  // that an hour's source has room for

bool is_beam_or_diffuse(const WeatherVariable& variable) {
  return variable.member == &WeatherHour::dni_W_m2 || variable.member == &WeatherHour::dhi_W_m2;
}

/// One variable from the source `s`, where none before it has any.
void take(MergedWeather& merged, std::size_t variable, std::span<const WeatherSource> sources,
          std::size_t s) {
  const auto member = kWeatherVariables[variable].member;
  const auto is_measured_at = [&](Instant t) {
    return std::ranges::any_of(sources.first(s), [&](const WeatherSource& earlier) {
      return earlier.begun[variable] && *earlier.begun[variable] <= t;
    });
  };
  for (std::size_t i = 0; i < merged.series.hours.size(); ++i) {
    const Instant t = merged.series.begin + hours{i};
    if (merged.source[i][variable] > 0) continue;
    if (sources[s].is_typical_year && is_measured_at(t)) continue;
    const WeatherHour* const hour = sources[s].series->find(t);
    if (hour == nullptr || !std::isfinite(hour->*member)) continue;
    merged.series.hours[i].*member = hour->*member;
    merged.source[i][variable] = static_cast<std::uint8_t>(s + 1);
  }
}

void forget(MergedWeather& merged, std::size_t variable) {
  for (std::size_t i = 0; i < merged.series.hours.size(); ++i) {
    merged.series.hours[i].*kWeatherVariables[variable].member = kAbsent;
    merged.source[i][variable] = 0;
  }
}

bool is_sun_from_a_sensor(const MergedWeather& merged, std::span<const WeatherSource> sources) {
  for (std::size_t v = 0; v < kWeatherVariables.size(); ++v) {
    if (kWeatherVariables[v].member != &WeatherHour::ghi_W_m2) continue;
    for (const auto& hour : merged.source) {
      if (hour[v] > 0 && sources[hour[v] - 1U].is_sensor) return true;
    }
  }
  return false;
}

}  // namespace

MergedWeather merge_weather(const metering::TimeSpan& span,
                            std::span<const WeatherSource> sources) {
  assert(sources.size() <= kSources && span.begin <= span.end);
  MergedWeather merged;
  merged.series.begin = span.begin;
  merged.series.hours.resize(static_cast<std::size_t>(span.length() / hours{1}));
  merged.source.resize(merged.series.hours.size());
  for (std::size_t s = 0; s < sources.size(); ++s) {
    for (std::size_t v = 0; v < kWeatherVariables.size(); ++v) {
      take(merged, v, sources, s);
    }
  }
  if (!is_sun_from_a_sensor(merged, sources)) return merged;
  for (std::size_t v = 0; v < kWeatherVariables.size(); ++v) {
    if (is_beam_or_diffuse(kWeatherVariables[v])) forget(merged, v);
  }
  return merged;
}

std::vector<WeatherHole> holes_in(const WeatherSeries& series, std::size_t variable,
                                  const metering::TimeSpan& span, std::chrono::seconds shortest) {
  const auto member = kWeatherVariables[variable].member;
  std::vector<WeatherHole> holes;
  std::optional<Instant> since;
  const auto end_hole = [&](Instant end) {
    if (since && end - *since > shortest) holes.push_back({variable, {*since, end}});
    since.reset();
  };
  for (Instant t = std::chrono::ceil<hours>(span.begin); t < span.end; t += hours{1}) {
    const WeatherHour* const hour = series.find(t);
    if (hour != nullptr && std::isfinite(hour->*member)) {
      end_hole(t);
    } else if (!since) {
      since = t;
    }
  }
  end_hole(std::chrono::ceil<hours>(span.end));
  return holes;
}

}  // namespace recald::weather
