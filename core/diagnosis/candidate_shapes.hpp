/// Typical amounts of a candidate and its possible shapes.
#pragma once

#include <vector>

#include "core/diagnosis/posterior_algebra.hpp"
#include "core/diagnosis/site_problem.hpp"

namespace recald::diagnosis {

/// The amount used to draw footprints: the prior's mean, or one standard deviation from neutral if
/// the mean is neutral.
[[nodiscard]] double typical_value(const EffectParameter& parameter);

/// Prior of the factor on the typical deviation from neutral, for the candidate's first amount;
/// half-normal of scale 1 if it has only shapes.
[[nodiscard]] AmountPrior amount_prior(const Candidate& candidate);

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
