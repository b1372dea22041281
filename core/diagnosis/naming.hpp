/// Decides which effect is present, and how certain that is, or that none can be named.
///
/// Signatures of the meters say how probable each effect is. The likeliest are fitted. A name needs
/// a high probability, and support from months that were not fitted. Where the model is exact
/// (tests), the survivors of the first look, no effect and an unknown effect are fitted alike and
/// compared by evidence instead.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/first_look.hpp"
#include "core/diagnosis/signature_names.hpp"
#include "core/diagnosis/usual_errors.hpp"
#include "core/executor.hpp"

namespace recald::diagnosis {

enum class Outcome { named, confusable, unknown, none };
[[nodiscard]] std::string_view to_string(Outcome outcome);

/// Fixed with the training population and published with every result. By signatures, those of
/// evidence, survivors and priors do not count.
struct NamingRules {
  double temperature = 1.0;     ///< T >= 1: supports, in units of their null scales, divided by it.
  double unknown_scale = 20.0;  ///< The unknown model's evidence is divided by it.
  bool errs_as_learnt = true;   ///< False: the model is exact and every null scale is 1 (tests).
  double least_probability = 0.8;
  double most_against = 1.0;     ///< Nats in units of the null scale, on the months to choose by,
                                 ///< beyond two standard errors.
  double least_evidence = 15.0;  ///< Support / null scale, or the null threshold if larger.
  int least_months = 10;      ///< With readings; in a shorter record a season looks like an effect.
  double least_move = 0.001;  ///< Of some meter's energy: sum of the changes per four-hour part.
  double confusable_share = 0.1;  ///< Probability of each member of a confusable set.
  double unknown_probability = 0.5;
  std::size_t survivors_min = 8;
  double survivor_gap = 1.0;  ///< Below the best of the first look, in units of null scale.
  double prior_none = 0.5;
  double prior_unknown = 0.1;
  std::vector<std::size_t> only = {};  ///< Candidates to fit; empty: those with the best looks.
};

/// A rival explanation after its fit.
struct Explanation {
  std::size_t candidate;  ///< Index into the list.
  JointFit fit;           ///< Without its Jacobian.
  double evidence_gain;   ///< L_k - L_none, nats.
  /// The smaller of the gains in the fit and in the first look, nats: if an effect gains only by
  /// moving the base parameters to quite another place, that supports the place, not the effect.
  /// The fit's gain if the model is exact.
  double support;
  double likelihood_gain = 0.0;  ///< Log likelihood at the mode minus none's, nats.
  double selected_gain;          ///< Log score on the months to choose by, minus none's.
  double selected_se;            ///< Of that, by month.
  double null_scale;      ///< Factor by which such gains are inflated where nothing is hidden.
  double first_look;      ///< Log Bayes factor of the first look.
  double move = 0.0;      ///< Largest share of a meter's energy that it changes.
  bool at_truncation;     ///< The posterior piles up at a bound that is not physical.
  std::string objection;  ///< Why it cannot be named, in words; empty: no reason.
};

struct NameProbability {
  std::string effect;  ///< Id, or "none", "unknown".
  int meter = -1;
  double probability;
  std::optional<std::size_t> explanation;  ///< The best explanation of this name.
};

struct Naming {
  Outcome outcome = Outcome::none;
  std::vector<NameProbability> probabilities;  ///< Descending.
  std::vector<Explanation> explanations;       ///< Descending in probability.
  std::optional<std::size_t> named;            ///< Index into explanations.
  std::vector<std::string> confusable;         ///< Ids of the set.
  double unknown_gain = 0.0;                   ///< L_U - L_none
  double null_threshold = 0.0;
  /// A better mode of the base model than the one that all were compared with, if the rivals found
  /// one. Their gain from it is already subtracted.
  std::optional<JointFit> better_base;
  std::string why;  ///< Why this outcome, one sentence.
};

/// Data used for naming: fitted months, and months to choose by.
struct NamingData {
  FitContext fit;                      ///< Months to fit.
  double unknown_log_evidence;         ///< L_U
  const Observations& select;          ///< Months to choose by; may be empty.
  std::span<const NoiseLevel> levels;  ///< Of the fitted noise.
  const UsualErrors& usual;            ///< Used in all fits.
  /// By signatures, of the same candidates; null: by the evidence of the fits.
  const SignatureNames* names = nullptr;
};

[[nodiscard]] Result<Naming> name_effect(Predictor& predictor, const NamingData& data,
                                         const JointFit& none,
                                         const std::vector<Candidate>& candidates,
                                         const FirstLook& look, const NamingRules& rules);

}  // namespace recald::diagnosis
