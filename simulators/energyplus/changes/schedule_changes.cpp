#include <algorithm>
#include <array>
#include <cmath>

#include "simulators/energyplus/changes/changes.hpp"

namespace recald::simulators::energyplus::changes {
namespace {

constexpr double kQuartersPerHour = 4.0;

/// Fans that stop, so that they can run when they should not.
bool has_stopping_fans(const BuildingYear& building) {
  for (const std::string& name : building.names_of(Role::fans)) {
    const Quarters& quarters = building.schedule(name);
    if (*std::ranges::min_element(quarters) <= 0.0 && *std::ranges::max_element(quarters) > 0.0) {
      return true;
    }
  }
  return false;
}

bool has_set_back(const BuildingYear& building) {
  for (const std::string& name : building.names_of(Role::heating_setpoint)) {
    const auto [least, most] = std::ranges::minmax(building.schedule(name));
    if (most - least >= 1.5 && least > 5.0) return true;
  }
  return false;
}

/// Least of each day: what stands in lights and machines when nobody is there.
double standing(const BuildingYear& building, const std::string& name, std::size_t day) {
  const double* first = building.schedule(name).data() + day * kQuartersPerDay;
  return *std::min_element(first, first + kQuartersPerDay);
}

/// People, and what they switch on, by a factor of the day.
template <class Factor>
void change_attendance(BuildingYear& building, const Factor& of_day) {
  for (const Role role : {Role::presence, Role::lights, Role::equipment}) {
    for (const std::string& name : building.names_of(role)) {
      std::vector<double> stands;
      for (std::size_t day = 0; day < building.days().size(); ++day) {
        stands.push_back(role == Role::presence ? 0.0 : standing(building, name, day));
      }
      Quarters& quarters = building.schedule(name);
      for (std::size_t i = 0; i < quarters.size(); ++i) {
        const std::size_t day = i / kQuartersPerDay;
        quarters[i] = std::min(stands[day] + of_day(day) * (quarters[i] - stands[day]),
                               std::max(quarters[i], 1.0));
      }
    }
  }
}

unsigned month_of(const BuildingYear& building, std::size_t day) {
  return static_cast<unsigned>(building.days()[day].month());
}

unsigned day_of_month(const BuildingYear& building, std::size_t day) {
  return static_cast<unsigned>(building.days()[day].day());
}

/// Monday is 1.
unsigned weekday_of(const BuildingYear& building, std::size_t day) {
  return std::chrono::weekday{std::chrono::sys_days{building.days()[day]}}.iso_encoding();
}

void after_hours(BuildingYear& building, double hours, Rng rng) {
  constexpr double kMostDays = 0.8;
  std::vector<int> quarters;
  for (std::size_t day = 0; day < building.days().size(); ++day) {
    const double late_h = hours / kMostDays * rng.uniform(0.6, 1.4);
    const bool happens = rng.uniform() < kMostDays && building.kind_of(day) == DayKind::workday;
    quarters.push_back(happens ? static_cast<int>(std::lround(kQuartersPerHour * late_h)) : 0);
  }
  stretch_operation(building, [&](std::size_t day) { return std::pair(0, quarters[day]); });
}

void early_start(BuildingYear& building, double hours, Rng /*rng*/) {
  constexpr double kWarm_C = 15.0;
  constexpr double kColder_K = 10.0;  // At 5 degC the strength counts in full.
  stretch_operation(building, [&](std::size_t day) {
    if (building.kind_of(day) != DayKind::workday) return std::pair(0, 0);
    const double dawn_C = building.weather_at(day, 20).at_end.air.temperature_C;
    const double share = std::clamp((kWarm_C - dawn_C) / kColder_K, 0.0, 1.5);
    const double monday = weekday_of(building, day) == 1 ? 1.3 : 1.0;
    return std::pair(static_cast<int>(std::lround(kQuartersPerHour * hours * share * monday)), 0);
  });
}

void weekend_operation(BuildingYear& building, double days_a_week, Rng /*rng*/) {
  for (const Role role :
       {Role::fans, Role::outdoor_air, Role::heating_setpoint, Role::cooling_setpoint}) {
    for (const std::string& name : building.names_of(role)) {
      Quarters& quarters = building.schedule(name);
      const auto at = [&](std::size_t day) {
        return quarters.begin() + static_cast<std::ptrdiff_t>(day * kQuartersPerDay);
      };
      std::optional<std::size_t> workday;
      for (std::size_t day = 0; day < building.days().size(); ++day) {
        if (building.kind_of(day) == DayKind::workday) workday = day;
        const unsigned weekday = weekday_of(building, day);
        const bool runs = weekday == 6 || (weekday == 7 && days_a_week > 1.5);
        if (runs && workday) std::copy_n(at(*workday), kQuartersPerDay, at(day));
      }
    }
  }
}

void night_setback_missing(BuildingYear& building, double share, Rng /*rng*/) {
  for (const Role role : {Role::heating_setpoint, Role::cooling_setpoint}) {
    for (const std::string& name : building.names_of(role)) {
      Quarters& quarters = building.schedule(name);
      const auto [least, most] = std::ranges::minmax(quarters);
      const double by_day = role == Role::heating_setpoint ? most : least;
      for (double& value : quarters) value += share * (by_day - value);
    }
  }
}

void missing_holidays(BuildingYear& building, double share, Rng rng) {
  constexpr double kChance = 0.02;
  std::vector<bool> stay_away;
  for (std::size_t day = 0; day < building.days().size(); ++day) {
    const bool is_workday = building.kind_of(day) == DayKind::workday;
    const bool after_christmas = month_of(building, day) == 12 && day_of_month(building, day) > 25;
    const bool before = day > 0 && building.kind_of(day - 1) == DayKind::sunday &&
                        weekday_of(building, day) == 5;  // A bridge between holiday and weekend.
    const bool drawn = rng.uniform() < kChance;
    stay_away.push_back(is_workday && (after_christmas || before || drawn));
  }
  change_attendance(building, [&](std::size_t day) { return stay_away[day] ? 1.0 - share : 1.0; });
}

void semester_calendar(BuildingYear& building, double share, Rng /*rng*/) {
  change_attendance(building, [&](std::size_t day) {
    const unsigned month = month_of(building, day);
    const unsigned of_month = day_of_month(building, day);
    const bool summer =
        (month == 6 && of_month >= 10) || month == 7 || (month == 8 && of_month <= 20);
    const bool winter = (month == 12 && of_month >= 15) || (month == 1 && of_month <= 8);
    return summer || winter ? 1.0 - share : 1.0;
  });
}

void vacancy(BuildingYear& building, double share, Rng /*rng*/) {
  change_attendance(building, [&](std::size_t /*day*/) { return 1.0 - share; });
}

void hybrid_work(BuildingYear& building, double share, Rng rng) {
  std::vector<double> chance;
  for (std::size_t day = 0; day < building.days().size(); ++day) {
    chance.push_back(rng.uniform(0.9, 1.1));
  }
  change_attendance(building, [&](std::size_t day) {
    constexpr std::array<double, 7> kAtHome{0.55, 0.25, 0.2, 0.3, 0.7, 0.0, 0.0};
    const double at_home = kAtHome[weekday_of(building, day) - 1] * chance[day];
    return 1.0 - share * std::min(at_home, 1.0);
  });
}

}  // namespace

void add_schedule_changes(std::vector<HiddenChange>& all) {
  all.insert(all.end(),
             {// Midnight ends it.
              {"after_hours", 0.5, 4.0, "", has_stopping_fans, after_hours},
              {"early_start", 0.75, 5.0, "", has_stopping_fans, early_start},
              {"weekend_operation", 2.0, 2.0, "", has_stopping_fans, weekend_operation},
              {"night_setback_missing", 0.3, 1.0, "", has_set_back, night_setback_missing},
              {"missing_holidays", 0.5, 1.0, "", has_people, missing_holidays},
              {"semester_calendar", 0.2, 1.0, "", has_people, semester_calendar},
              {"vacancy", 0.2, 1.0, "", has_people, vacancy, Course::for_a_while, kDated},
              {"hybrid_work", 0.3, 1.0, "", has_people, hybrid_work}});
}

}  // namespace recald::simulators::energyplus::changes
