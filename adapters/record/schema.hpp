/// The tables of a fleet's record in PostgreSQL. README.md in this folder says what is in them.
#pragma once

#include <string>

#include "adapters/postgres/connection.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::record {

inline constexpr int kSchemaVersion = 2;

/// Makes what is missing, and brings tables of an earlier version up to date. May be repeated, also
/// by two at once.
/// @return a sentence about what could not be done and is not needed to go on: roles; empty: all is
///         there. Or unsupported: a newer recald made it; malformed: the user may not make tables.
[[nodiscard]] Result<std::string> make_schema(postgres::Connection& connection);

/// @return unsupported with what to do, unless the schema is this one.
[[nodiscard]] Result<void> check_schema(postgres::Connection& connection);

/// Makes the months' partitions of the intervals that begin in this span, those that are missing.
/// @pre not within a transaction
[[nodiscard]] Result<void> make_partitions(postgres::Connection& connection,
                                           const metering::TimeSpan& span);

/// "interval_2024_03", where intervals that begin then are. What a wrong clock stamps before 2000
/// or after the known years has a partition of its own, which is always there.
[[nodiscard]] std::string partition_of(metering::Instant start);

}  // namespace recald::record
