/// Working days, holidays and the seasons of each kind of building.
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

  /// Observed holidays of one year, in order; these days run like Sundays. For a school they
  /// include its breaks except the summer, for a restaurant all Mondays. A hotel has none.
  [[nodiscard]] std::vector<metering::Day> holidays_of(std::chrono::year year) const;

  /// Holidays count as Sundays.
  [[nodiscard]] DayKind kind_of(metering::Day day) const;

  /// Share of people who come on account of semester, breaks and season; hidden from the user.
  [[nodiscard]] double season_attendance(metering::Day day) const;

 private:
  Use use_;
};

}  // namespace recald::simulators
