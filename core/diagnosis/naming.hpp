/// Decides which effect is present, and how certain that is, or that none can be named.
///
/// Signatures of the meters say how probable each effect is. The likeliest are fitted to the day
/// parts. A name needs a high probability, and support from months that were not fitted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/check/ground.hpp"
#include "core/diagnosis/check/held_scores.hpp"
#include "core/diagnosis/naming/signature_names.hpp"

namespace recald::diagnosis {

enum class Outcome { named, confusable, unknown, none };
[[nodiscard]] std::string_view to_string(Outcome outcome);

/// Fixed, and published with every result.
struct NamingRules {
  double least_probability = 0.5;  ///< Of a name: likelier than all others together.
  double set_probability = 0.8;    ///< Of a confusable set: of all its members together.
  double worth_a_fit = 0.1;        ///< Probability. Also that of each member of a set.
  std::size_t fits_max = 3;
  double unknown_probability = 0.5;
  int least_months = 10;      ///< With readings; in a shorter record a season looks like an effect.
  double least_move = 0.001;  ///< Of some meter's energy: sum of the changes per four-hour part.
};

/// A rival explanation after its fit.
struct Explanation {
  std::size_t candidate = 0;   ///< Index into the list.
  JointFit fit;                ///< Without its Jacobian.
  double evidence_gain = 0.0;  ///< Log evidence of the fit minus the base model's, nats.
  ScoreGain selected = {};     ///< Log score on the months to choose by, minus the base model's.
  double move = 0.0;           ///< Largest share of a meter's energy that it changes.
  bool at_truncation = false;  ///< The posterior piles up at a bound that is not physical.
  std::string objection = {};  ///< Why it cannot be named, in words; empty: no reason.
};

struct NameProbability {
  std::string effect;  ///< Id, or "none", "unknown".
  int meter = -1;
  double probability;
  std::optional<std::size_t> explanation;  ///< Its fit, if it was likely enough for one.
  std::vector<EffectSign> signs = {};      ///< By what it shows.
};

struct Naming {
  Outcome outcome = Outcome::none;
  std::vector<NameProbability> probabilities;  ///< Descending.
  std::vector<Explanation> explanations;       ///< In the order in which they were fitted.
  std::optional<std::size_t> named;            ///< Index into explanations.
  std::vector<std::string> confusable;         ///< Ids of the set.
  std::string why;                             ///< Why this outcome, one sentence.
  double prior_none = kEvenPrior;  ///< That nothing is missing, as the probabilities have it.
};

/// The probabilities of `naming`, in their order, had another prior been stated for none.
/// @param prior_none  Above 0 and below 1.
[[nodiscard]] std::vector<double> probabilities_at(const Naming& naming, double prior_none);

/// Where the fit of an effect starts.
struct EffectStart {
  std::size_t candidate = 0;   ///< Index into the list.
  std::vector<double> values;  ///< Of its parameters.
  /// (q) scores of the base parameters, besides those of the base model; empty: these alone.
  Eigen::VectorXd scores = {};
};

/// Fits the likeliest effects beside the base model and decides.
/// @param names   Of `candidates`.
/// @param ground  If an effect leads to a better mode of the base model, it is moved there: that
///                mode's gain is not the effect's.
[[nodiscard]] Result<Naming> name_effect(Predictor& predictor, const SiteProblem& site,
                                         const SignatureNames& names,
                                         const std::vector<Candidate>& candidates,
                                         const NamingRules& rules, Ground& ground);

/// The same for an effect that is known to be present: it is the only one fitted, and named.
[[nodiscard]] Result<Naming> take_as_named(Predictor& predictor, const SiteProblem& site,
                                           const EffectStart& start,
                                           const std::vector<Candidate>& candidates,
                                           const NamingRules& rules, Ground& ground);

}  // namespace recald::diagnosis
