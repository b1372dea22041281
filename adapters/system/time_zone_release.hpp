/// Which release of the zone rules this system has: recorded with every monthly figure's export.
#pragma once

#include <string>

namespace recald::system {

/// "2025b" from the first line of the zone folder's tzdata.zi; "unknown" where there is none. The
/// zone library itself cannot tell when it reads the system's files.
[[nodiscard]] std::string time_zone_release();

}  // namespace recald::system
