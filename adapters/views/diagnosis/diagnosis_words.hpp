/// A diagnosis in words, for the person who runs the building: the same on a terminal and a page.
#pragma once

#include <string>
#include <vector>

#include "adapters/views/diagnosis/diagnosis_data.hpp"
#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"

namespace recald::views {

struct OutcomeWords {
  std::string headline;                ///< The answer, one sentence.
  std::vector<std::string> sentences;  ///< Why, how sure, what to do next.
};

/// @param others  Gaps of other models than the hourly one.
/// @pre the diagnosis has a pass.
[[nodiscard]] OutcomeWords outcome_words(const diagnosis::Diagnosis& diagnosis,
                                         const diagnosis::SiteProblem& site,
                                         const std::vector<diagnosis::ModelGap>& others = {});

/// What the model lacks most likely, for the first screen of a calibration's page: the meaning of
/// what was named, else the answer. @pre the diagnosis has a pass.
[[nodiscard]] std::string most_likely_words(const diagnosis::Diagnosis& diagnosis,
                                            const diagnosis::SiteProblem& site);

/// For a terminal. @pre the diagnosis has a pass.
[[nodiscard]] std::string diagnosis_words(const diagnosis::Diagnosis& diagnosis,
                                          const diagnosis::SiteProblem& site,
                                          const std::vector<diagnosis::ModelGap>& others = {});

/// "Meter's scale is wrong (Steam)": an effect's title, with the meter of an effect of one meter.
/// `none` and `unknown` are "No effect" and "Something else".
/// @param meter  -1: none.
[[nodiscard]] std::string effect_label(const diagnosis::SiteProblem& site, std::string_view effect,
                                       int meter);

/// "12 Mar 2021"
[[nodiscard]] std::string day_words(metering::Day day);

/// "At all times of the record." or "Since about 12 Mar 2021 (90 %: 1 Mar 2021 to 20 Mar 2021)."
[[nodiscard]] std::string when_words(const diagnosis::SiteProblem& site,
                                     const diagnosis::Addition& addition);

/// Rivals of each effect that was added, or of the confusable set, or of the likeliest effect.
[[nodiscard]] std::vector<Separation> separations_of(const diagnosis::Diagnosis& diagnosis,
                                                     const diagnosis::SiteProblem& site);

/// Effects that cannot be judged at this site, and why; each once.
[[nodiscard]] std::vector<diagnosis::NotIdentifiable> not_seen_here(
    const diagnosis::Diagnosis& diagnosis);

}  // namespace recald::views
