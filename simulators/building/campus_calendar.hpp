/// Working days, holidays and the university's year.
#pragma once

#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::simulators {

/// Observed campus holidays of one year, in order: these days run like Sundays.
[[nodiscard]] std::vector<metering::Day> holidays_of(std::chrono::year year);

enum class DayKind { workday, saturday, sunday };

/// A holiday counts as a Sunday.
[[nodiscard]] DayKind day_kind(metering::Day day);

/// Share of people who come at all because of semester, break or season; nobody tells the user.
[[nodiscard]] double season_attendance(metering::Day day);

}  // namespace recald::simulators
