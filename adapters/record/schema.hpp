/// The tables of a fleet's record in PostgreSQL.
#pragma once

#include "adapters/postgres/connection.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::record {

inline constexpr int kSchemaVersion = 1;

/// Makes what is missing and brings an older schema to this one. May be repeated.
/// @return or unsupported: a newer recald made it.
[[nodiscard]] Result<void> make_schema(postgres::Connection& connection);

/// @return unsupported with what to do, unless the schema is this one.
[[nodiscard]] Result<void> check_schema(postgres::Connection& connection);

/// Makes the months' partitions of the intervals that begin in this span.
[[nodiscard]] Result<void> make_partitions(postgres::Connection& connection,
                                           const metering::TimeSpan& span);

}  // namespace recald::record
