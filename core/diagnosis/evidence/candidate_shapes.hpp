/// Typical amounts of a candidate and its possible shapes.
#pragma once

#include <vector>

#include "core/diagnosis/evidence/site_problem.hpp"

namespace recald::diagnosis {

/// A scanned parameter is not an amount, even if it has a neutral value: a clock two hours off is
/// not twice a clock one hour off.
[[nodiscard]] bool is_amount(const EffectParameter& parameter);

/// The amount used to draw footprints: the prior's mean, or one standard deviation from neutral if
/// the mean is neutral.
[[nodiscard]] double typical_value(const EffectParameter& parameter);

/// Whether the effect may take away as well as add: its amount has either sign.
[[nodiscard]] bool may_take_away(const Candidate& candidate);

/// The values with all amounts at `factor` times their deviation from neutral, within their priors.
[[nodiscard]] std::vector<double> with_amount(const Candidate& candidate,
                                              std::vector<double> values, double factor);

/// Combinations of the scanned values of the effect's own parameters, with typical amounts.
/// Excludes a candidate's first and last days.
[[nodiscard]] std::vector<std::vector<double>> own_shapes(const Candidate& candidate);

/// As above, and with several amounts also each one alone, the others neutral: a building may be
/// open on Saturdays and closed on Sundays.
[[nodiscard]] std::vector<std::vector<double>> shapes_to_try(const Candidate& candidate);

}  // namespace recald::diagnosis
