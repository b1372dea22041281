#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Days that are working days only on paper: bridge days, the week after Christmas, closing days
/// that the house decides on, days when snow keeps people at home.
class MissingHolidays final : public EffectWithSettings {
 public:
  MissingHolidays(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), calendar_(drawings.calendar) {}

  void plan(metering::Day day, Timetable& timetable) override {
    Rng& rng = settings_.rng;
    const bool house_day = rng.uniform() < kHouseDaysAYear / 250.0;
    const bool stays_home = rng.uniform() < 0.5 && fresh_mm_ > kClosingSnow_mm;
    const double away_share = rng.uniform(0.75, 1.0);
    const bool caretaker_told = rng.uniform() < 0.6;
    const double early_closing_h = rng.uniform(10.0, 14.0);
    if (!settings_.covers(day) || timetable.kind != DayKind::workday) return;
    const bool planned = house_day || after_christmas(day) || bridges(day);
    if (!planned && !stays_home) return;
    timetable.attendance *= 1.0 - settings_.strength * away_share;
    // On a planned day someone may switch the plant off early; snow comes without notice.
    if (planned && caretaker_told && timetable.air.to_h > early_closing_h) {
      timetable.air.to_h -= settings_.strength * (timetable.air.to_h - early_closing_h);
    }
  }

  void operate(const Moment& now, Operation& /*operation*/) override {
    const Outdoors& outdoors = now.outdoors;
    const double snow_mm_h = outdoors.snow_share * outdoors.precipitation_mm_h;
    const double rain_mm_h = outdoors.precipitation_mm_h - snow_mm_h;
    const bool freezes = outdoors.air.temperature_C < 0.5;
    const double slippery_mm_h = snow_mm_h + (freezes ? rain_mm_h : 0.0);
    const double hours = now.step_s / 3600.0;
    fresh_mm_ += slippery_mm_h * hours - fresh_mm_ * std::min(1.0, hours / kRoadsCleared_h);
  }

 private:
  static constexpr double kHouseDaysAYear = 4.0;
  static constexpr double kRoadsCleared_h = 8.0;
  static constexpr double kClosingSnow_mm = 4.0;  ///< Fresh snow as water; ten times as deep.

  [[nodiscard]] static bool after_christmas(metering::Day day) {
    return day.month() == std::chrono::December && day.day() > std::chrono::day{25};
  }
  [[nodiscard]] bool bridges(metering::Day day) const {
    const auto is_free = [&](metering::Day other) {
      return calendar_.kind_of(other) != DayKind::workday;
    };
    const std::chrono::sys_days here{day};
    return is_free(here - std::chrono::days{1}) && is_free(here + std::chrono::days{1});
  }

  Calendar calendar_;
  double fresh_mm_ = 0.0;  ///< Snow and freezing rain of the last hours, as water.
};

}  // namespace

EffectKind missing_holidays() {
  return {.id = "missing_holidays",
          .title = "Closing days missing in the calendar",
          .group = EffectClass::schedules,
          .sentence =
              "On some days that the calendar calls working days (bridge days, the days after "
              "Christmas, closing days of the house, snow) hardly anyone comes: the meters show "
              "much less than on other working days.",
          .strength = {0.0, 0.85, 1.0, "share of the people who stay away on such a day"},
          .turns = "closing days",
          .make = make_effect<MissingHolidays>};
}

}  // namespace recald::simulators
