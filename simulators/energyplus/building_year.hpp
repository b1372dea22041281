/// A building through one calendar year: what an EnergyPlus model says of it, and by the quarter of
/// an hour what its schedules say.
///
/// Models of any origin are looked at by what refers to what, not by names: a schedule has a role
/// because fans, lights or thermostats follow it.
#pragma once

#include <string>
#include <vector>

#include "simulators/building/calendar.hpp"
#include "simulators/energyplus/parts/building_parts.hpp"
#include "simulators/energyplus/parts/schedule_year.hpp"
#include "simulators/energyplus/weather_files.hpp"

namespace recald::simulators::energyplus {

/// What follows a schedule.
enum class Role {
  presence,
  lights,
  equipment,
  fans,         ///< 1 while air handlers run, or blow without pause.
  outdoor_air,  ///< Of the least flow.
  heating_setpoint,
  cooling_setpoint,
  supply_temperature,
  added,  ///< Followed by what an effect put in.
};

/// What the year is like, the same with and without a hidden effect.
struct YearAround {
  int year;
  std::vector<metering::Day> holidays;
  std::vector<WeatherHour> hours;  ///< Of the year, in order.
  double floor_m2;
};

class BuildingYear {
 public:
  /// Each role gets schedules of its own, "FANS FOR OUTDOOR AIR"; whoever else follows the original
  /// goes on doing so.
  BuildingYear(Json model, ScheduleYear schedules, const YearAround& around);

  [[nodiscard]] Json& model() { return model_; }
  [[nodiscard]] const Json& model() const { return model_; }
  [[nodiscard]] const YearAround& around() const { return around_; }
  [[nodiscard]] const std::vector<metering::Day>& days() const { return days_; }
  /// Whether it is a holiday, Saturday or Sunday.
  [[nodiscard]] DayKind kind_of(std::size_t day) const { return kinds_[day]; }

  [[nodiscard]] bool has(Role role) const { return !names_of(role).empty(); }
  /// Of the schedules in this role; empty if nothing follows one.
  [[nodiscard]] std::vector<std::string> names_of(Role role) const;
  [[nodiscard]] Quarters& schedule(const std::string& name) { return schedules_.at(name); }
  [[nodiscard]] const Quarters& schedule(const std::string& name) const {
    return schedules_.at(name);
  }
  /// nullptr where the model has none of this name, or a constant that EnergyPlus does not tell of.
  [[nodiscard]] const Quarters* find_schedule(const std::string& name) const {
    const auto found = schedules_.find(name);
    return found == schedules_.end() ? nullptr : &found->second;
  }

  /// `change(day, quarter, value)` gives each schedule of the role its new values.
  template <class Change>
  void change(Role role, const Change& change) {
    for (const std::string& name : names_of(role)) {
      Quarters& quarters = schedules_.at(name);
      for (std::size_t i = 0; i < quarters.size(); ++i) {
        quarters[i] = change(i / kQuartersPerDay, i % kQuartersPerDay, quarters[i]);
      }
    }
  }
  /// A schedule that the model did not have, and its name. @pre a value for each quarter hour
  std::string add_schedule(const std::string& name, Quarters quarters);

  /// The hour that a quarter hour lies in, as if the clock showed standard time. @param day  Of the
  /// year.
  [[nodiscard]] const WeatherHour& weather_at(std::size_t day, std::size_t quarter) const;

  /// The model with its schedules in a file beside it, and that file: a column a schedule.
  struct Written {
    Json model;
    std::string csv;
  };
  [[nodiscard]] Written write(const std::string& csv_name) const;

 private:
  void give_roles();

  Json model_;
  ScheduleYear schedules_;
  const YearAround& around_;
  std::vector<metering::Day> days_;
  std::vector<DayKind> kinds_;
  std::map<std::string, Role> roles_;  ///< By schedule, in capitals.
};

}  // namespace recald::simulators::energyplus
