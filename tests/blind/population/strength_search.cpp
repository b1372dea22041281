#include "tests/blind/population/strength_search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::blind {
namespace {

constexpr double kTolerance = 0.05;
constexpr int kEvaluations = 12;

}  // namespace

StrengthFound strength_for(double target, double limit, const Visibility& visibility) {
  assert(target > 0.0 && limit != 0.0);
  StrengthFound found;
  const auto try_strength = [&](double strength) {
    const double reached = visibility(strength);
    ++found.evaluations;
    if (found.evaluations == 1 || std::abs(reached - target) < std::abs(found.reached - target)) {
      found.strength = strength;
      found.reached = reached;
      found.attained = std::abs(reached / target - 1.0) <= kTolerance;
    }
    return reached;
  };
  double low = 0.0;
  double low_gap = -target;
  double high = limit;
  double high_gap = try_strength(limit) - target;
  int same_side = 0;
  while (!found.attained && high_gap > 0.0 && found.evaluations < kEvaluations) {
    double share = low_gap / (low_gap - high_gap);
    // Footprints that saturate would pull the secant to one end again and again.
    if (std::abs(same_side) >= 2) share = 0.5;
    const double strength = low + std::clamp(share, 0.02, 0.98) * (high - low);
    const double gap = try_strength(strength) - target;
    same_side = gap > 0.0 ? std::max(same_side, 0) + 1 : std::min(same_side, 0) - 1;
    (gap > 0.0 ? high : low) = strength;
    (gap > 0.0 ? high_gap : low_gap) = gap;
  }
  return found;
}

}  // namespace recald::blind
