/// Whether an export's clock is the building's or stays on winter time all year.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "adapters/table/read_table.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/site/setup/survey_hints.hpp"

namespace recald::daemon {

/// A zone of one offset: "Etc/GMT-1". Nothing for offsets that are no whole hours.
[[nodiscard]] std::optional<std::string> zone_of_offset(std::chrono::seconds offset);

/// Of the zone's winter time, a zone that never changes: "Etc/GMT-1". Nothing for offsets that are
/// no whole hours.
[[nodiscard]] std::optional<std::string> fixed_zone(const metering::LocalCalendar& calendar,
                                                    metering::Instant around);

/// Why a clock stays on winter time, as a clause: it needs values in every hour that the zone's
/// clock skips, and only one of each that it shows twice, of one change each at least. One stamp
/// that does not exist is a slip of some program, or the end of the hour before.
/// @param span      Of the readings.
/// @param per_hour  Stamps that an hour has.
/// @return nothing where that is not so.
[[nodiscard]] std::optional<std::string> fixed_clock_because(
    const table::ClockFacts& facts, const metering::TimeSpan& span, double per_hour,
    const metering::LocalCalendar& calendar);

/// The same by rows, whatever their values; only a number counts in the hour that is skipped.
[[nodiscard]] std::optional<std::string> fixed_clock_by_rows(
    const table::ClockFacts& facts, const metering::TimeSpan& span, double per_hour,
    const metering::LocalCalendar& calendar);

/// A question where rows are those of a clock that stays on winter time, and their values are zero
/// or blank.
[[nodiscard]] std::optional<OpenQuestion> winter_time_question(
    const std::filesystem::path& file, const table::ClockFacts& facts,
    const metering::TimeSpan& span, double per_hour, const metering::LocalCalendar& calendar);

}  // namespace recald::daemon
