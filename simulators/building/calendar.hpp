/// Working days, holidays and the year of each kind of building.
#pragma once

#include <vector>

#include "core/metering/civil_time.hpp"
#include "simulators/building/drawings.hpp"

namespace recald::simulators {

enum class DayKind { workday, saturday, sunday };

[[nodiscard]] bool is_open(OpenDays days, DayKind kind);

class Calendar {
 public:
  explicit Calendar(Use use) : use_(use) {}

  /// Observed holidays of one year, in order: these days run like Sundays. A school's include its
  /// breaks but for the summer, a restaurant's all Mondays. A hotel has none.
  [[nodiscard]] std::vector<metering::Day> holidays_of(std::chrono::year year) const;

  /// A holiday counts as a Sunday.
  [[nodiscard]] DayKind kind_of(metering::Day day) const;

  /// Share of people who come at all because of semester, break or season; nobody tells the user.
  [[nodiscard]] double season_attendance(metering::Day day) const;

 private:
  Use use_;
};

}  // namespace recald::simulators
