/// The building is closed on public holidays that are not in its calendar.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"
#include "core/diagnosis/effects/support/public_holidays.hpp"

namespace recald::diagnosis::effects {
namespace {

/// @param calendar  As the parameter has it: from 1, chosen, not fitted.
const DateTable& holidays_of(double calendar) {
  const double last = static_cast<double>(kHolidayCalendars.size());
  return public_holidays(static_cast<std::size_t>(std::lround(std::clamp(calendar, 1.0, last))) -
                         1);
}

/// The building's own Sundays, by calendar month and local hour, as a model of a holiday.
class Sundays {
 public:
  struct Loads {
    double people_share = kAbsent;
    double lights_W = 0.0;
    double plugs_W = 0.0;
  };

  explicit Sundays(const model::Drivers& drivers) {
    for (const DriverHour& hour : drivers.hours) {
      if (hour.day != model::DayType::sunday_or_holiday) continue;
      loads_[month(hour)][local_hour(hour)] = {hour.occupied_fraction, hour.lights_W, hour.plugs_W};
    }
  }

  /// Nothing if the drivers have no Sunday in this calendar month.
  [[nodiscard]] std::optional<Loads> at(const DriverHour& hour) const {
    const Loads& loads = loads_[month(hour)][local_hour(hour)];
    return std::isnan(loads.people_share) ? std::nullopt : std::optional(loads);
  }

 private:
  static std::size_t month(const DriverHour& hour) {
    return static_cast<unsigned>(hour.date.month()) - 1;
  }
  static std::size_t local_hour(const DriverHour& hour) {
    return static_cast<std::size_t>(hour.local_hour);
  }
  std::array<std::array<Loads, 24>, 12> loads_;
};

}  // namespace

Effect missing_holidays() {
  return {
      .id = "missing_holidays",
      .title = "Public holidays missing from the calendar",
      .meaning =
          "On public holidays the building is closed or half empty, but they are workdays in the "
          "model's calendar. Add these dates to the site's holidays.",
      .physics =
          "on public holidays that the calendar has as workdays: on ×(1−a); people [–], "
          "lights [W] and plugs [W] move by a towards their Sunday values; a [–] 0…1",
      .on_meters =
          "All meters show a weekend profile on single dates that the model takes for working "
          "days.",
      .check = "The site's list of holidays against the dates on which the building was closed.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable =
          {{"stuck_meter",
            "The profile of the day: a stuck meter is flat or zero, an empty building shows a weak "
            "Sunday profile on all meters."},
           {"vacancy",
            "The dates: holidays are single days that return next year by the same rule."},
           {"semester_calendar", "Length: term breaks last weeks, holidays one day or two."},
           {"weekend_operation",
            "Ordinary Saturdays and Sundays: missing holidays do not change them."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("shut_share", "share of the building"),
                any_share("plant_share", "share of the plant that is off"),
                one_of_three("calendar", "1: North America, 2: Europe, 3: Britain")};
      },
      // Lights and plugs get the meter's own Sunday values, not an assumed share of the workday's:
      // in real meters holidays look like Sundays.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return operating([sundays = Sundays{facts.drivers}, holidays = &holidays_of(values[2]),
                              shut_share = values[0],
                              plant_share = values[1]](const DriverHour& hour, StepOperation& op) {
              if (hour.day != model::DayType::workday || !holidays->contains(hour.date)) return;
              op.daytime_share *= 1.0 - plant_share;
              if (const auto sunday = sundays.at(hour)) {
                op.people_share += shut_share * (sunday->people_share - op.people_share);
                op.lights_W += shut_share * (sunday->lights_W - op.lights_W);
                op.plugs_W += shut_share * (sunday->plugs_W - op.plugs_W);
              }
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
