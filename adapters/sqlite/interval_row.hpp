/// Reads a row of the `interval` table.
#pragma once

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

inline std::int64_t seconds_of(metering::Instant t) { return t.time_since_epoch().count(); }
inline metering::Instant instant_of(std::int64_t seconds) {
  return metering::Instant{std::chrono::seconds{seconds}};
}

inline constexpr auto kIntervalColumns = "t_start, revision, mean_kW, validity, late, reasons";

/// @pre columns as in `kIntervalColumns`
inline StoredInterval read_interval(const Statement& row, std::uint32_t meter) {
  return {{.meter = meter,
           .start = instant_of(row.integer(0)),
           .mean_kW = row.real(2),
           .validity = static_cast<metering::Validity>(row.integer(3)),
           .reasons = static_cast<metering::Reason>(row.integer(5)),
           .late = row.integer(4) != 0},
          static_cast<int>(row.integer(1))};
}

}  // namespace recald::sqlite
