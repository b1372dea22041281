/// How strong must an effect be to move so much of a meter?
#pragma once

#include <functional>
#include <optional>

#include "tests/blind/population/population_kind.hpp"

namespace recald::blind {

/// Strengths of one sign. `least` and `most` may be the same: an effect that is there or not.
struct StrengthLimits {
  double least;
  double most;
};

/// What an effect of this strength moves of the meter that it moves most.
using ShareOf = std::function<Result<double>(double strength)>;

/// A strength that moves a share of the bin, by power laws from the middle of the limits, in as
/// many tries. @return nothing where none was found; what `share_of` refuses.
[[nodiscard]] Result<std::optional<double>> strength_in(const ShareBin& wanted,
                                                        const StrengthLimits& limits, int tries,
                                                        const ShareOf& share_of);

}  // namespace recald::blind
