/// Numbers as people write them down.
#pragma once

#include <cmath>

namespace recald::blind {

/// To so many significant digits.
inline double rounded(double value, int digits) {
  if (value == 0.0) return 0.0;
  const double scale = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

}  // namespace recald::blind
