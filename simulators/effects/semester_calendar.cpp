#include <algorithm>
#include <optional>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Days between two dates of one year.
double days_from(metering::Day from, metering::Day to) {
  return static_cast<double>((std::chrono::sys_days{to} - std::chrono::sys_days{from}).count());
}

/// People of a teaching institution leave between terms. The dates vary a little from year to year,
/// and people leave and return over several days.
class SemesterCalendar final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void plan(metering::Day day, Timetable& timetable) override {
    if (year_ != day.year()) begin_year(day.year());
    if (settings_.covers(day)) timetable.attendance *= 1.0 - settings_.strength * away_share(day);
  }

 private:
  void begin_year(std::chrono::year year) {
    year_ = year;
    Rng& rng = settings_.rng;
    january_shift_d_ = rng.uniform(-4.0, 4.0);
    spring_shift_d_ = rng.uniform(-5.0, 5.0);
    summer_shift_d_ = rng.uniform(-5.0, 5.0);
    autumn_shift_d_ = rng.uniform(-4.0, 4.0);
    december_shift_d_ = rng.uniform(-4.0, 4.0);
  }

  /// Of the people who follow the terms, the share that is away on this day.
  [[nodiscard]] double away_share(metering::Day day) const {
    using namespace std::chrono;
    const double date_d = days_from(day.year() / January / 1, day);
    const auto between = [&](double first_d, double last_d, double edge_d) {
      return ramp(date_d, first_d - edge_d, first_d) * ramp(date_d, last_d + edge_d, last_d);
    };
    const double january = ramp(date_d, 13.0 + january_shift_d_, 8.0 + january_shift_d_);
    const double spring = between(72.0 + spring_shift_d_, 78.0 + spring_shift_d_, 2.0);
    const double summer = between(138.0 + summer_shift_d_, 226.0 + summer_shift_d_, 8.0);
    const double autumn = between(283.0 + autumn_shift_d_, 287.0 + autumn_shift_d_, 2.0);
    const double december = ramp(date_d, 347.0 + december_shift_d_, 352.0 + december_shift_d_);
    return std::max(
        {0.95 * std::max(january, december), 0.7 * spring, 0.85 * summer, 0.5 * autumn});
  }

  std::optional<std::chrono::year> year_;
  double january_shift_d_ = 0.0;
  double spring_shift_d_ = 0.0;
  double summer_shift_d_ = 0.0;
  double autumn_shift_d_ = 0.0;
  double december_shift_d_ = 0.0;
};

}  // namespace

EffectKind semester_calendar() {
  return {.id = "semester_calendar",
          .title = "Term breaks",
          .group = EffectClass::schedules,
          .sentence =
              "People are away between terms, in summer and around New Year every year: lights and "
              "plugs fall for weeks while the plant runs as usual.",
          .strength = {0.0, 0.7, 1.0, "share of the people who follow the terms"},
          .turns = "attendance",
          .make = make_effect<SemesterCalendar>};
}

}  // namespace recald::simulators
