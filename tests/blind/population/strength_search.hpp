/// How strong must an effect be to show this much?
#pragma once

#include <functional>

namespace recald::blind {

/// How visible an effect of this strength is, in the terms of the target: d*.
using Visibility = std::function<double(double strength)>;

struct StrengthFound {
  double strength = 0.0;
  double reached = 0.0;   ///< Visibility at that strength.
  bool attained = false;  ///< Within 5 % of the target; if not, even `limit` shows too little.
  int evaluations = 0;
};

/// Strength between 0 and `limit` (either sign) whose visibility is within 5 % of `target`, by
/// power laws through the ends of a bracket, bisected where they creep. Visibility is taken to be 0
/// at strength 0 and to grow with |strength|; where it jumps over the target the nearer side is
/// given, not attained.
/// @pre target > 0, limit != 0
[[nodiscard]] StrengthFound strength_for(double target, double limit, const Visibility& visibility);

}  // namespace recald::blind
