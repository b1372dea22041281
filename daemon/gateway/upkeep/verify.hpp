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
  std::vector<std::string> problems;  ///< A sentence each; none: the store is sound.
  std::uint64_t intervals = 0;        ///< Rows, all revisions.
  std::uint64_t days_compared = 0;    ///< Days of a meter whose sum was held against its counter.
  std::uint64_t months_compared = 0;  ///< Closed again and held against what is stored.
};

/// What is said of a file with this damage.
[[nodiscard]] std::string damaged_file(std::string_view damage);

/// Reads the whole store and changes nothing.
///
/// - damage, rows that refer to nothing, intervals off their meter's grid;
/// - revisions of intervals and months without gaps;
/// - states of registers that can be read;
/// - the sum of a UTC day's intervals against the register's difference, within 2 r + 0.1 %, where
///   samples lie around both ends and nothing in between was reset, edited or wrapped;
/// - closed months against what closing them again gives, with the same release of the time zones.
/// @return or the store's failure to be read at all.
[[nodiscard]] Result<Verification> verify_store(Store& store, const SiteConfig& site,
                                                const metering::LocalCalendar& calendar);

}  // namespace recald::daemon
