/// What stands in the place of a number that nobody has: not measured, not known, not defined.
#pragma once

#include <limits>

namespace recald {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

}  // namespace recald
