#include "core/assessment/interval_score.hpp"

#include <algorithm>
#include <cassert>

namespace recald::assessment {

double interval_score(const Interval& interval, double coverage, double measured) {
  assert(interval.low <= interval.high);
  assert(coverage > 0.0 && coverage < 1.0);
  const double missed_by = std::max({0.0, interval.low - measured, measured - interval.high});
  return interval.high - interval.low + 2.0 / (1.0 - coverage) * missed_by;
}

}  // namespace recald::assessment
