/// Lines of simpler methods, from what a diagnosis has computed anyway: no run of the model more.
#pragma once

#include <array>
#include <string_view>

#include "tests/blind/running/diagnosis_line.hpp"

namespace recald::blind {

/// refit_only    base parameters alone, calibrated anew: adds nothing, says none.
/// aic           the candidate of the lowest AIC = 2 k - 2 ln L, added if lower than without.
///               Probabilities are Akaike weights.
/// first_look    the best by the linear first look alone, added if its log Bayes factor is above
///               five, taken as it is and not in units of its null scale.
/// unknown_only  the model with anonymous terms alone: unknown if its log Bayes factor is above
///               five; names nothing.
inline constexpr std::array<std::string_view, 4> kBaselines{"refit_only", "aic", "first_look",
                                                            "unknown_only"};

/// None of them refits with what it adds, so their lines have no gap.
///
/// @param run  Its method is one of `kBaselines`.
/// @return malformed; not_found if the diagnosis lacks the key that the method needs:
///         aic         candidates[].log_likelihood_gain, at the mode, above the base model's;
///         first_look  first_look[]: effect, log_bayes_factor; every candidate, not only those
///                     that were worth a fit.
[[nodiscard]] Result<Json> baseline_line(const Json& diagnosis, const CaseRun& run);

}  // namespace recald::blind
