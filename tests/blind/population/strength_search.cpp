#include "tests/blind/population/strength_search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::blind {
namespace {

constexpr double kTolerance = 0.05;
constexpr int kEvaluations = 10;

struct Look {
  double strength;
  double reached;
};

/// Where a power law through both ends reaches the target; a straight line where the weaker end
/// shows nothing.
double between(const Look& low, const Look& high, double target) {
  if (low.reached <= 0.0) {
    return low.strength + target / high.reached * (high.strength - low.strength);
  }
  const double share = std::log(target / low.reached) / std::log(high.reached / low.reached);
  return low.strength * std::pow(high.strength / low.strength, share);
}

/// The same where that crept along one end: visibility grows like a root, or sets in late.
double further(const Look& low, const Look& high, double target) {
  if (low.strength == 0.0) return high.strength * std::pow(target / high.reached, 2.0);
  if (low.reached <= 0.0) return 0.5 * (low.strength + high.strength);
  return low.strength * std::sqrt(high.strength / low.strength);
}

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
  Look low{0.0, 0.0};
  Look high{limit, try_strength(limit)};
  int same_side = 0;
  while (!found.attained && high.reached > target && found.evaluations < kEvaluations) {
    const double strength =
        std::abs(same_side) >= 2 ? further(low, high, target) : between(low, high, target);
    const Look look{strength, try_strength(strength)};
    same_side = look.reached > target ? std::max(same_side, 0) + 1 : std::min(same_side, 0) - 1;
    (look.reached > target ? high : low) = look;
  }
  return found;
}

}  // namespace recald::blind
