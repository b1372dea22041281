/// Typical amounts of a candidate and the shapes in which it may come.
#pragma once

#include <vector>

#include "core/diagnosis/posterior_algebra.hpp"
#include "core/diagnosis/site_problem.hpp"

namespace recald::diagnosis {

/// The amount that footprints are drawn with: the prior's mean, or one standard deviation from
/// neutral where the mean is nothing.
[[nodiscard]] double typical_value(const EffectParameter& parameter);

/// Prior of the factor on the typical deviation from neutral, of the candidate's first amount;
/// half-normal of scale 1 where it has nothing but shapes.
[[nodiscard]] AmountPrior amount_prior(const Candidate& candidate);

/// The values with all amounts at `factor` times their deviation from neutral, within their priors.
[[nodiscard]] std::vector<double> with_amount(const Candidate& candidate,
                                              std::vector<double> values, double factor);

/// Combinations of the scanned values of the effect's own parameters, amounts at typical values.
/// Days that a candidate begins or ends on are not among them.
[[nodiscard]] std::vector<std::vector<double>> own_shapes(const Candidate& candidate);

/// The same, and of several amounts also each alone, the others neutral: a building may be open on
/// Saturdays and shut on Sundays.
[[nodiscard]] std::vector<std::vector<double>> shapes_to_try(const Candidate& candidate);

}  // namespace recald::diagnosis
