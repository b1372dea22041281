/// What is not there: a number that nobody has (not measured, not known, not defined), and types
/// that may be empty.
#pragma once

#include <limits>
#include <optional>

namespace recald {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

}  // namespace recald
