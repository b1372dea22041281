/// Values of the record's columns.
#pragma once

#include <string>
#include <string_view>

#include "adapters/ports/store.hpp"
#include "adapters/postgres/connection.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::record {

/// For `$1::timestamptz`.
[[nodiscard]] inline postgres::Parameter parameter(metering::Instant t) {
  return metering::to_string(t);
}

/// A column made by `extract(epoch FROM t)::bigint`.
[[nodiscard]] inline metering::Instant instant(const postgres::Rows& rows, int row, int column) {
  return metering::Instant{std::chrono::seconds{rows.integer(row, column)}};
}

/// The text without zero bytes, which PostgreSQL does not take: a gateway's batch is not refused
/// for ever because of one.
[[nodiscard]] std::string text_of(std::string_view text);

/// @return malformed: the record was written by somebody else.
[[nodiscard]] Result<JobKind> parse_job_kind(std::string_view name);

[[nodiscard]] std::string sha256_of(std::string_view bytes);

}  // namespace recald::record
