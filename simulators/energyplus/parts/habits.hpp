/// People whose days differ: what the steady schedules of a model's drawings leave out.
#pragma once

#include <string>
#include <vector>

#include "simulators/building/calendar.hpp"
#include "simulators/energyplus/parts/building_parts.hpp"

namespace recald::simulators::energyplus {

/// A schedule that follows people: a standing share plus a span times the share present.
struct PeopleSchedule {
  std::string name;
  WeeklyShares presence;  ///< Present / assigned.
  double standing = 0.0;
  double span = 1.0;

  [[nodiscard]] WeeklyShares weekly() const;
};

/// A model's schedules for one calendar year, day by day, as a file that it refers to.
struct Habits {
  Json model;
  std::string csv;  ///< A column for each schedule, a row for each hour of local clock time.
};

/// How many come, when, and what they leave on vary from day to day and with the campus's season.
/// All schedules of one seed and year know of the same days.
/// @param file  The name under which the CSV will lie beside the model.
[[nodiscard]] Habits with_habits(Json model, const std::vector<PeopleSchedule>& schedules, int year,
                                 const Calendar& calendar, std::uint64_t seed,
                                 const std::string& file);

}  // namespace recald::simulators::energyplus
