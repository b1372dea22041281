/// The release of the system's time zone rules, recorded in every export of monthly figures.
#pragma once

#include <string>

namespace recald::system {

/// "2025b" from the first line of the zone folder's tzdata.zi; "unknown" if there is none. The zone
/// library cannot tell when it reads the system's files.
[[nodiscard]] std::string time_zone_release();

}  // namespace recald::system
