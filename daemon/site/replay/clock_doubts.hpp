/// Whether an export's clock changes are those of the zone that it is read in.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/table/read_table.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::daemon {

struct OtherClock {
  std::string because;             ///< A clause: which time came twice on which day.
  std::vector<std::string> zones;  ///< Some that put their clocks back then; one at least.
};

/// A clock that is put back on days on which that of the calendar is not, but on which other zones
/// put theirs back, every time.
/// @return nothing where that is not so, as where a few rows come twice
[[nodiscard]] std::optional<OtherClock> other_clock(const table::ClockFacts& facts,
                                                    const metering::LocalCalendar& calendar);

}  // namespace recald::daemon
