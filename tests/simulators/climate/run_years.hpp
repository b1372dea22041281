/// Whole years of a climate at its city, step by step, for tests.
#pragma once

#include <cmath>
#include <functional>

#include "simulators/climate/normals.hpp"
#include "simulators/climate/weather.hpp"

namespace recald::simulators {

/// Calls `see(month 1…12, hour 0…23 by the mean sun, weather)` for whole years from 2021.
inline void run_years(ClimateKind kind, int years, std::uint64_t seed, std::chrono::seconds step,
                      const std::function<void(unsigned, int, const Outdoors&)>& see) {
  using namespace std::chrono;
  const Place& place = comparable_city(kind).place;
  const sys_days first = 2021y / January / 1;
  const seconds behind_utc{std::lround(-place.longitude_deg * 240.0)};
  WeatherGenerator weather(climate_of(kind, place), first + behind_utc,
                           stream_of(seed, Stream::weather), step);
  const sys_days after = (2021y + std::chrono::years{years}) / January / 1;
  for (sys_seconds now = first; now < after; now += step) {
    const auto day = floor<days>(now);
    see(static_cast<unsigned>(year_month_day{day}.month()),
        static_cast<int>(floor<hours>(now - day).count()), weather.advance());
  }
}

}  // namespace recald::simulators
