/// Checks a store for consistency: its file, its keys, its counters, its months.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/store.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

struct Verification {
  std::vector<std::string> problems;  ///< One sentence each; none: the store is sound.
  std::uint64_t intervals = 0;        ///< Rows, including all revisions.
  std::uint64_t days_compared = 0;    ///< Meter days whose sum was compared with the counter.
  std::uint64_t months_compared = 0;  ///< Closed again and compared with what is stored.
};

/// The sentence about a file with this damage.
[[nodiscard]] std::string damaged_file(std::string_view damage);

/// Reads the whole store and changes nothing. Checks:
///
/// - damage, rows that refer to nothing, intervals off their meter's grid;
/// - revisions of intervals and months, which must have no gaps;
/// - states of registers, which must be readable;
/// - the sum of a UTC day's intervals against the register's difference, within 2 r + 0.1 %, if
///   there are samples around both ends and nothing in between was reset, edited or wrapped;
/// - closed months against closing them again, with the same time zone release.
/// @return the verification, or the store's failure to be read at all.
[[nodiscard]] Result<Verification> verify_store(Store& store, const SiteConfig& site,
                                                const metering::LocalCalendar& calendar);

}  // namespace recald::daemon
