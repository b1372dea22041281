/// How much support each effect gets where nothing is hidden.
#pragma once

#include <string_view>

namespace recald::diagnosis {

/// Factor by which an effect's support is inflated in buildings without any hidden effect: one plus
/// the mean of its positive support there. It would hardly exceed 1 if models had only random and
/// usual errors. Their other errors resemble some effects (often a server room, never missing
/// holidays), whose evidence counts correspondingly less.
/// @return the mean over all effects for one that was not visible in the training population.
/// @see tests/results/diagnosis.md for that population.
[[nodiscard]] double null_scale(std::string_view effect);

/// Root mean square of the scores of effects in such buildings; 1 if models had only random
/// and usual errors.
inline constexpr double null_score_spread = 3.1;

}  // namespace recald::diagnosis
