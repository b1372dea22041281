/// A year in which every step is what the test says: no building, no chance but the effect's own.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <memory>
#include <numbers>
#include <type_traits>

#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators::hand_made {

using std::chrono::sys_days;

inline metering::Day day_of(int year, unsigned month, unsigned day) {
  return std::chrono::year{year} / static_cast<int>(month) / static_cast<int>(day);
}

inline AirState air_at(double temperature_C, double relative_humidity) {
  return {temperature_C,
          relative_humidity * saturation_humidity_kg_kg(temperature_C, kSeaLevel_Pa)};
}

/// A continental climate by hand: -10 degC in January nights, 32 degC in July afternoons; every
/// tenth day it rains, or snows, for six hours; snow lies in the second half of January.
inline Outdoors outdoors_at(metering::Instant t) {
  const auto date = std::chrono::floor<std::chrono::days>(t);
  const metering::Day day{date};
  const double days = static_cast<double>((date - sys_days{day.year() / 1 / 1}).count());
  const double hour = static_cast<double>((t - date).count()) / 3600.0;
  const double wave = -std::cos(2.0 * std::numbers::pi * (days - 20.0) / 365.25);
  const double daily = -std::cos(2.0 * std::numbers::pi * (hour - 4.0) / 24.0);
  Outdoors outdoors{};
  outdoors.relative_humidity = 0.7;
  outdoors.air = air_at(11.0 + 15.0 * wave + 6.0 * daily, outdoors.relative_humidity);
  outdoors.pressure_Pa = kSeaLevel_Pa;
  outdoors.wind_speed_m_s = 4.0;
  outdoors.wind_from_deg = 270.0;
  outdoors.sun = sun_position(t, {40.0, 0.0, 0.0});
  const double up = std::max(0.0, outdoors.sun.up);
  outdoors.sky = {up > 0.0 ? 700.0 : 0.0, 120.0 * up, extraterrestrial_W_m2(t)};
  outdoors.global_horizontal_W_m2 = 820.0 * up;
  const bool wet = date.time_since_epoch().count() % 10 == 0 && hour < 6.0;
  outdoors.precipitation_mm_h = wet ? 2.0 : 0.0;
  const bool lying = day.month() == std::chrono::January && day.day() > std::chrono::day{15};
  outdoors.snow_cover_mm = lying ? 8.0 : 0.0;
  outdoors.ground_reflectance = lying ? 0.6 : 0.2;
  return outdoors;
}

inline DayKind kind_of(metering::Day day) {
  const std::chrono::weekday weekday{sys_days{day}};
  return weekday == std::chrono::Sunday     ? DayKind::sunday
         : weekday == std::chrono::Saturday ? DayKind::saturday
                                            : DayKind::workday;
}

/// What the hooks may turn, as it is without any effect.
struct Untouched {
  Operation operation{.rooms = {24.0, 21.0, 29.0, 17.0}, .air = {}, .envelope = {}, .plant = {}};
  ServiceLoad load{.cooling_W = 200e3,
                   .heating_W = 100e3,
                   .lights_and_plugs_W = 150e3,
                   .fans_W = 40e3,
                   .people_share = 0.0};
  UtilityPower power{300.0, 250.0, 120.0};
};

struct Step {
  Moment now;
  Operation operation;
  ServiceLoad load;
  UtilityPower power;
};

/// One moment in hand-made weather; the clock on the wall shows UTC.
inline Moment moment_at(metering::Instant t, const Outdoors& outdoors, double step_s = 900.0) {
  const auto date = std::chrono::floor<std::chrono::days>(t);
  const int minute = static_cast<int>((t - date).count() / 60);
  const DayKind kind = kind_of(date);
  const bool working = kind == DayKind::workday && minute >= 8 * 60 && minute < 18 * 60;
  return {.instant = t,
          .local = {metering::Day{date}, minute},
          .day_kind = kind,
          .outdoors = outdoors,
          .step_s = step_s,
          .people_share = working ? 0.8 : 0.0,
          .air_runs = working};
}

/// Lets the effect work on one step: what it made of everything.
inline Step step_of(HiddenEffect& effect, const Moment& now, const Untouched& untouched = {}) {
  Step step{now, untouched.operation, untouched.load, untouched.power};
  effect.operate(now, step.operation);
  effect.load(now, step.load);
  effect.supply(now, step.power);
  return step;
}

/// Walks whole days from `first`: `plan(day, Timetable&)` at midnight, `visit(const Moment&)` a
/// step.
template <class Plan, std::invocable<const Moment&> Visit>
void walk(metering::Day first, int days, std::chrono::seconds length, Plan plan, Visit visit) {
  for (int i = 0; i < days; ++i) {
    const sys_days date = sys_days{first} + std::chrono::days{i};
    Timetable timetable{.kind = kind_of(date), .air = {6.0, 20.0}};
    if (timetable.kind != DayKind::workday) timetable.air = {24.0, 0.0};
    plan(metering::Day{date}, timetable);
    for (std::chrono::seconds into{0}; into < std::chrono::days{1}; into += length) {
      const Outdoors outdoors = outdoors_at(date + into);
      visit(moment_at(date + into, outdoors, static_cast<double>(length.count())));
    }
  }
}

/// Runs the effect through whole days and shows what it made of each step to `visit(const Step&)`.
template <std::invocable<const Step&> Visit>
void run(HiddenEffect& effect, metering::Day first, int days, std::chrono::seconds length,
         Visit visit) {
  walk(
      first, days, length,
      [&](metering::Day day, Timetable& timetable) { effect.plan(day, timetable); },
      [&](const Moment& now) { visit(step_of(effect, now)); });
}

/// Whether `call(value)` leaves each bit of the value as it was.
template <class T, std::invocable<T&> Call>
[[nodiscard]] bool leaves_alone(T& value, Call call) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::array<std::byte, sizeof(T)> before;
  std::memcpy(before.data(), &value, sizeof(T));
  call(value);
  return std::memcmp(before.data(), &value, sizeof(T)) == 0;
}

/// Settings for an effect of one meter, or of a time.
inline EffectSettings on_meter(Utility meter) {
  EffectSettings settings;
  settings.meter = meter;
  return settings;
}
inline EffectSettings between(metering::Day from, metering::Day to) {
  EffectSettings settings = on_meter(Utility::electricity);
  settings.from = from;
  settings.to = to;
  return settings;
}

/// A kind of effect with this strength in this building, seeded alike each time.
inline std::unique_ptr<HiddenEffect> make(const EffectKind& kind, double strength,
                                          const Drawings& drawings = {},
                                          EffectSettings settings = {}) {
  settings.strength = strength;
  settings.rng = Rng{42, 7};
  return make(kind, settings, drawings);
}

}  // namespace recald::simulators::hand_made
