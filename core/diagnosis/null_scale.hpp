/// What was learnt of each effect where nothing was hidden.
#pragma once

#include <string_view>

namespace recald::diagnosis {

/// Mean square of an effect's score z in buildings without any hidden effect, at least 1; it would
/// be 1 if models erred by chance alone. A building model errs in ways that some effects can mimic
/// (an open damper much, a step at a date little), so their evidence counts by so much less.
/// @return the mean over all effects for one that was not there when this was learnt.
/// @see README.md for the population that taught it.
[[nodiscard]] double null_scale(std::string_view effect);

}  // namespace recald::diagnosis
