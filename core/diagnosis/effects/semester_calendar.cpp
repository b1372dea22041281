/// Fewer people in term breaks.
#include <chrono>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/date_table.hpp"
#include "core/diagnosis/effects/support/presence.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

/// The break over New Year is marked in both of its years.
void mark_winter(std::chrono::year year, unsigned from_december, unsigned to_january,
                 DateTable& table) {
  table.mark(year / 1 / 1, year / 1 / to_january);
  table.mark(year / 12 / from_december, year / 12 / 31);
}

/// Schools: mid-June to mid-August, two weeks at New Year, one week in spring.
DateTable school_breaks() {
  using namespace std::chrono;  // NOLINT: calendar literals
  DateTable table;
  for (int y = DateTable::kFirstYear; y <= DateTable::kLastYear; ++y) {
    const year year{y};
    const sys_days spring = sys_days{year / April / Monday[1]};
    mark_winter(year, 20, 3, table);
    table.mark(spring, spring + days{4});
    table.mark(year / 6 / 15, year / 8 / 15);
  }
  return table;
}

/// American colleges: mid-May to late August, four weeks at New Year, one week in March.
DateTable college_breaks() {
  using namespace std::chrono;  // NOLINT: calendar literals
  DateTable table;
  for (int y = DateTable::kFirstYear; y <= DateTable::kLastYear; ++y) {
    const year year{y};
    const sys_days spring = sys_days{year / March / Monday[2]};
    mark_winter(year, 15, 10, table);
    table.mark(spring, spring + days{4});
    table.mark(year / 5 / 12, year / 8 / 20);
  }
  return table;
}

/// Continental universities: February to March, mid-July to September, two weeks at New Year.
DateTable university_breaks() {
  DateTable table;
  for (int y = DateTable::kFirstYear; y <= DateTable::kLastYear; ++y) {
    const std::chrono::year year{y};
    mark_winter(year, 22, 6, table);
    table.mark(year / 2 / 15, year / 3 / 31);
    table.mark(year / 7 / 15, year / 9 / 30);
  }
  return table;
}

const DateTable& breaks_of(double calendar) {
  static const DateTable school = school_breaks();
  static const DateTable college = college_breaks();
  static const DateTable university = university_breaks();
  if (calendar < 1.5) return school;
  return calendar < 2.5 ? college : university;
}

}  // namespace

Effect semester_calendar() {
  return {
      .id = "semester_calendar",
      .title = "Term breaks",
      .meaning =
          "During school or university breaks fewer people are in the building: lights and "
          "machines use less, less heat has to be removed, and in winter more has to be supplied.",
      .physics =
          "in term breaks: people [–] ×(1−a), lights and plugs above their least of the "
          "month [W] ×(1−0.8a); a [–] 0…0.7",
      .on_meters =
          "Electricity and chilled water are lower for the weeks of term breaks, each year again; "
          "heat is higher in winter.",
      .check = "The academic calendar of the building's users.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable = {{"vacancy", "Whether it returns next year on the same term dates."},
                     {"missing_holidays", "The length: single days or whole weeks."},
                     {"hybrid_work", "Whether the weekdays differ from each other during term."},
                     {"solar_gain_change",
                      "Electricity: shading does not change it, missing people do. The academic "
                      "calendar settles it."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "absent_share",
                 .unit = "share of the people",
                 .prior = UniformPrior{0.0, 0.7},
                 .neutral = 0.0},
                one_of_three("calendar", "1: school, 2: college, 3: university")};
      },
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return operating([standby = StandbyLoads{facts.drivers}, breaks = &breaks_of(values[1]),
                              absent_share = values[0]](const DriverHour& hour, StepOperation& op) {
              if (breaks->contains(hour.date)) change_presence(-absent_share, standby, hour, op);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
