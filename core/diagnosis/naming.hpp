/// Which effect, how sure, or honestly none of them.
///
/// Survivors of the first look, no effect and an unknown effect are fitted alike and weighed by
/// their evidence. A name needs a high probability, evidence beyond what chance gives where nothing
/// is hidden, and months that did not fit it on its side.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/first_look.hpp"
#include "core/diagnosis/usual_errors.hpp"
#include "core/executor.hpp"

namespace recald::diagnosis {

enum class Outcome { named, confusable, unknown, none };
[[nodiscard]] std::string_view to_string(Outcome outcome);

/// What was fixed on the training population and is published with every result.
struct NamingRules {
  double temperature = 1.0;     ///< T >= 1: supports, in units of their null scales, divided by it.
  double unknown_scale = 20.0;  ///< The unknown model's evidence is divided by it.
  bool errs_as_learnt = true;   ///< False: the model is exact and every null scale 1 (tests).
  double least_probability = 0.8;
  double most_against = 1.0;     ///< Nats in units of the null scale, on the months to choose by,
                                 ///< beyond two standard errors.
  double least_evidence = 15.0;  ///< Support / null scale, or the null threshold if larger.
  int least_months = 10;         ///< With readings: in less, a season looks like an effect.
  double least_move = 0.001;     ///< Of some meter's energy, sum of what it moves a four-hour part.
  double confusable_share = 0.1;  ///< Probability of each member of a confusable set.
  double unknown_probability = 0.5;
  std::size_t survivors_min = 8;
  double survivor_gap = 1.0;  ///< Of the first look below the best, by null scale.
  double prior_none = 0.5;
  double prior_unknown = 0.1;
  std::vector<std::size_t> only = {};  ///< Candidates to fit; empty: those that the looks favour.
};

/// A rival explanation after its fit.
struct Explanation {
  std::size_t candidate;  ///< Index into the list.
  JointFit fit;           ///< Without its Jacobian.
  double evidence_gain;   ///< L_k - L_none, nats.
  /// Of the fit and of the first look the lesser, nats: what an effect gains only by leading the
  /// base parameters to quite another place speaks for the place. The fit's where the model is
  /// exact.
  double support;
  double likelihood_gain = 0.0;  ///< Log likelihood at the mode above none's, nats.
  double selected_gain;          ///< Log score on the months to choose by, above none's.
  double selected_se;            ///< Of that, by month.
  double null_scale;             ///< By which such gains are inflated where nothing is hidden.
  double first_look;             ///< Log Bayes factor of the first look.
  double move = 0.0;             ///< Share of the energy of the meter that it moves most.
  bool at_truncation;            ///< A posterior piled at an end that is no physical end.
  std::string objection;         ///< What keeps it from being named, in words; empty: nothing.
};

struct NameProbability {
  std::string effect;  ///< Id, or "none", "unknown".
  int meter = -1;
  double probability;
  std::optional<std::size_t> explanation;  ///< The best one of this name.
};

struct Naming {
  Outcome outcome = Outcome::none;
  std::vector<NameProbability> probabilities;  ///< Descending.
  std::vector<Explanation> explanations;       ///< Descending in support by null scale.
  std::optional<std::size_t> named;            ///< Index into explanations.
  std::vector<std::string> confusable;         ///< Ids of the set.
  double unknown_gain = 0.0;                   ///< L_U - L_none
  double null_threshold = 0.0;
  /// The base model at a better mode than the one that all was measured by, where the rivals have
  /// shown one. What they owe to it is taken off already.
  std::optional<JointFit> better_base;
  std::string why;  ///< Why this outcome, one sentence.
};

/// Data that a naming is judged by: fitted months, and months to choose by.
struct NamingData {
  FitContext fit;                      ///< Months to fit.
  double unknown_log_evidence;         ///< L_U
  const Observations& select;          ///< Months to choose by; may be empty.
  std::span<const NoiseLevel> levels;  ///< Of the fitted noise.
  const UsualErrors& usual;            ///< That all are fitted with.
};

[[nodiscard]] Result<Naming> name_effect(Predictor& predictor, const NamingData& data,
                                         const JointFit& none,
                                         const std::vector<Candidate>& candidates,
                                         const FirstLook& look, const NamingRules& rules);

}  // namespace recald::diagnosis
