/// What was learnt of each effect where nothing was hidden.
#pragma once

#include <string_view>

namespace recald::diagnosis {

/// By what an effect's support is inflated in buildings without any hidden effect: one plus the
/// mean of its positive support there. It would hardly exceed 1 if models erred by chance and by
/// their usual errors alone. What they otherwise do wrong some effects can mimic (a server room
/// much, missing holidays not at all), so their evidence counts by so much less.
/// @return the mean over all effects for one that was not visible when this was learnt.
/// @see tests/results/diagnosis.md for the population that taught it.
[[nodiscard]] double null_scale(std::string_view effect);

/// Root mean square of the scores of effects in such buildings; 1 if models erred by chance and by
/// their usual errors alone.
inline constexpr double null_score_spread = 3.1;

}  // namespace recald::diagnosis
