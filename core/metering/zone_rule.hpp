/// How a time zone's clock goes on after the last change that its file lists.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::metering {

/// From `at` on, local time is `utc_offset` ahead of UTC.
struct OffsetChange {
  Instant at;
  std::chrono::seconds utc_offset;
  bool operator==(const OffsetChange&) const = default;
};

/// "CET-1CEST,M3.5.0,M10.5.0/3": the rule at the end of the zone's file (RFC 8536, section 3.3),
/// which the zone library does not read. Empty if the file has none or cannot be read.
[[nodiscard]] std::string zone_rule_of(const std::string& zone_name);

/// The changes of the known years by such a rule, in order; none if it has none or is not
/// understood.
/// @see POSIX.1-2017, 8.3, TZ; with hours of -167…167, as RFC 8536 allows.
[[nodiscard]] std::vector<OffsetChange> zone_rule_changes(std::string_view rule);

}  // namespace recald::metering
