/// The building is closed on public holidays that are not in its calendar.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/absent.hpp"
#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/public_holidays.hpp"

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
    for (const model::DriverHour& hour : drivers.hours) {
      if (hour.day != model::DayType::sunday_or_holiday) continue;
      loads_[month(hour)][local_hour(hour)] = {hour.occupied_fraction, hour.lights_W, hour.plugs_W};
    }
  }

  /// Nothing if the drivers have no Sunday in this calendar month.
  [[nodiscard]] std::optional<Loads> at(const model::DriverHour& hour) const {
    const Loads& loads = loads_[month(hour)][local_hour(hour)];
    return std::isnan(loads.people_share) ? std::nullopt : std::optional(loads);
  }

 private:
  static std::size_t month(const model::DriverHour& hour) {
    return static_cast<unsigned>(hour.date.month()) - 1;
  }
  static std::size_t local_hour(const model::DriverHour& hour) {
    return static_cast<std::size_t>(hour.local_hour);
  }
  std::array<std::array<Loads, 24>, 12> loads_;
};

/// Lights and plugs get the meter's own Sunday values, not an assumed share of the workday's: in
/// real meters holidays look like Sundays.
class MissingHolidays final : public model::hourly::Alteration {
 public:
  MissingHolidays(const model::Drivers& drivers, double shut_share, double plant_share,
                  double calendar)
      : sundays_(drivers),
        holidays_(&holidays_of(calendar)),
        shut_share_(shut_share),
        plant_share_(plant_share) {}

  void operate(const model::DriverHour& hour, model::hourly::StepOperation& op) const override {
    if (hour.day != model::DayType::workday || !holidays_->contains(hour.date)) return;
    op.daytime_share *= 1.0 - plant_share_;
    if (const auto sunday = sundays_.at(hour)) {
      op.people_share += shut_share_ * (sunday->people_share - op.people_share);
      op.lights_W += shut_share_ * (sunday->lights_W - op.lights_W);
      op.plugs_W += shut_share_ * (sunday->plugs_W - op.plugs_W);
    }
  }

 private:
  Sundays sundays_;
  const DateTable* holidays_;  // Of static storage.
  double shut_share_;
  double plant_share_;
};

std::vector<EffectParameter> parameters_of_missing_holidays(const SiteFacts&) {
  return {{.name = "shut_share",
           .unit = "share of the building",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0},
          {.name = "plant_share",
           .unit = "share of the plant that is off",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0},
          {.name = "calendar",
           .unit = "1: North America, 2: Europe, 3: Britain",
           .prior = UniformPrior{0.5, 3.5},
           .neutral = kAbsent,
           .scan = {1.0, 2.0, 3.0},
           .choice = true}};
}

std::unique_ptr<model::hourly::Alteration> bind_missing_holidays(const SiteFacts& facts,
                                                                 std::span<const double> values,
                                                                 int) {
  return std::make_unique<MissingHolidays>(facts.drivers, values[0], values[1], values[2]);
}

}  // namespace

Effect missing_holidays();

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
      .parameters = parameters_of_missing_holidays,
      .bind = bind_missing_holidays,
  };
}

}  // namespace recald::diagnosis::effects
