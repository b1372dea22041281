/// A hidden effect alone on a bench: days, hours and weather are made by hand, and what it turned
/// is handed back.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "simulators/effects/effect_kind.hpp"
#include "tests/simulators/effects/hand_made_year.hpp"

namespace recald::simulators {

using hand_made::day_of;

inline metering::Day next(metering::Day day) {
  return std::chrono::sys_days{day} + std::chrono::days{1};
}

// A week without holidays.
inline const metering::Day kMonday = day_of(2021, 6, 7);
inline const metering::Day kTuesday = day_of(2021, 6, 8);
inline const metering::Day kFriday = day_of(2021, 6, 11);
inline const metering::Day kSaturday = day_of(2021, 6, 12);
inline const metering::Day kSunday = day_of(2021, 6, 13);

inline constexpr RunningHours kNever{24.0, 0.0};

inline EffectSettings strength_of(double strength) {
  EffectSettings settings;
  settings.strength = strength;
  settings.rng = Rng{7, 1};
  return settings;
}

inline EffectSettings strength_from(double strength, metering::Day from) {
  EffectSettings settings = strength_of(strength);
  settings.from = from;
  return settings;
}

/// 15 degC, dew point about 9 degC, a breeze, no sun.
inline Outdoors mild_day() {
  Outdoors outdoors{};
  outdoors.air = {15.0, 0.007};
  outdoors.pressure_Pa = 101'325.0;
  outdoors.relative_humidity = 0.65;
  outdoors.wind_speed_m_s = 3.0;
  outdoors.wind_from_deg = 270.0;
  outdoors.sky_temperature_C = 5.0;
  return outdoors;
}

class Bench {
 public:
  Bench(const EffectKind& kind, const EffectSettings& settings, const Drawings& drawings = {})
      : calendar_(drawings.use), effect_(make(kind, settings, drawings)) {}

  /// The day's timetable: 7 to 19 h on working days, unless the test says otherwise.
  Timetable plan(metering::Day day) {
    const DayKind kind = calendar_.kind_of(day);
    return plan(day, kind == DayKind::workday ? RunningHours{7.0, 19.0} : kNever);
  }
  Timetable plan(metering::Day day, RunningHours air) {
    Timetable timetable{.kind = calendar_.kind_of(day), .air = air};
    effect_->plan(day, timetable);
    hours_ = timetable.air;
    return timetable;
  }

  /// One step that begins at this local hour; local time is taken for UTC.
  Operation operate(metering::Day day, double hour) {
    Operation operation = as_built();
    effect_->operate(moment(day, hour), operation);
    return operation;
  }
  /// Steps to this hour of the day and returns what the last one turned.
  Operation operate_until(metering::Day day, double hour) {
    Operation operation = as_built();
    for (double at_h = 0.0; at_h <= hour; at_h += step_s / 3600.0) {
      operation = operate(day, at_h);
    }
    return operation;
  }
  ServiceLoad load(metering::Day day, double hour, ServiceLoad load = {}) {
    effect_->load(moment(day, hour), load);
    return load;
  }
  UtilityPower supply(metering::Day day, double hour, UtilityPower power) {
    effect_->supply(moment(day, hour), power);
    return power;
  }

  [[nodiscard]] static Operation as_built() {
    Operation operation{};
    operation.rooms = {
        .cooling_C = 24.0, .heating_C = 21.0, .night_cooling_C = 29.0, .night_heating_C = 17.0};
    return operation;
  }

  Outdoors outdoors = mild_day();
  double people_share = 0.0;
  double step_s = 900.0;

 private:
  [[nodiscard]] Moment moment(metering::Day day, double hour) const {
    const auto minute = static_cast<int>(hour * 60.0 + 0.5);
    return {.instant = std::chrono::sys_days{day} + std::chrono::minutes{minute},
            .local = {day, minute},
            .day_kind = calendar_.kind_of(day),
            .outdoors = outdoors,
            .step_s = step_s,
            .people_share = people_share,
            .air_runs = hour >= hours_.from_h && hour < hours_.to_h};
  }

  Calendar calendar_;
  std::unique_ptr<HiddenEffect> effect_;
  RunningHours hours_ = kNever;
};

/// Hours in which the timetable lets air handlers run.
inline double hours(const RunningHours& air) {
  return air.to_h > air.from_h ? air.to_h - air.from_h : 0.0;
}

}  // namespace recald::simulators
