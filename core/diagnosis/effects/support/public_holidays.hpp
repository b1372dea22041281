/// Public holidays that calendars of buildings leave out.
#pragma once

#include <array>

#include "core/diagnosis/effects/support/date_table.hpp"

namespace recald::diagnosis {

/// The calendars, each with most of the days on which offices are closed there.
inline constexpr std::array<const char*, 3> kHolidayCalendars{"North America", "Europe", "Britain"};

/// @param calendar  Place among them. @return of static storage.
[[nodiscard]] const DateTable& public_holidays(std::size_t calendar);

}  // namespace recald::diagnosis
