#include "core/assessment/interval_coverage.hpp"

#include <cassert>
#include <cmath>
#include <string>

namespace recald::assessment {

Result<IntervalCoverage> interval_coverage(std::span<const double> measured,
                                           std::span<const double> lower,
                                           std::span<const double> upper) {
  assert(measured.size() == lower.size() && measured.size() == upper.size());
  IntervalCoverage coverage{0, 0};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (std::isnan(measured[i])) continue;
    const std::string where = "the interval of point " + std::to_string(i + 1);
    if (std::isnan(lower[i]) || std::isnan(upper[i])) {
      return failure(ErrorCode::not_finite, where + " has a bound that is not a number");
    }
    if (lower[i] > upper[i]) {
      return failure(ErrorCode::invalid_value, where + " has its lower bound above its upper one");
    }
    ++coverage.n;
    if (lower[i] <= measured[i] && measured[i] <= upper[i]) ++coverage.inside;
  }
  if (coverage.n == 0) {
    return failure(ErrorCode::not_enough_data, "coverage needs at least one measured point");
  }
  return coverage;
}

}  // namespace recald::assessment
