/// What the signatures of a site say for each possible effect.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/diagnosis/naming/signature_search.hpp"

namespace recald::diagnosis {

/// A signature by which an effect shows: how far measured is from modelled, as
/// `SignatureReader::read` has it.
struct EffectSign {
  SignatureMeter meter;
  std::size_t signature;  ///< Index among `signature_names()`.
  double without;         ///< The base model, as well as it fits …
  double with;            ///< … and the model with the effect.
};

/// An effect in its likeliest shape.
struct EffectEvidence {
  EffectShape shape;
  double factor = 1.0;         ///< On the typical amount.
  std::vector<double> values;  ///< Of all the candidate's parameters, with that amount.
  Eigen::VectorXd scores;      ///< (q) of the base parameters fitted with it; empty if it was not.
  double log_gain = 0.0;       ///< Log Bayes factor against none, over shapes and amounts.
  double misfit = 0.0;         ///< With it; that of the base model if it was not worth a fit.
  double visibility = 0.0;     ///< Squared distance by which its typical amount moves signatures
                               ///< farther than parameters could.
  std::vector<EffectSign> signs;  ///< Of the four that fit best: three at most, clearest first.
  bool is_fitted = false;         ///< Together with the parameters; else log_gain is at most zero.
  bool is_wrong_sign = false;     ///< It would have to take away what it can only add.
};

struct SignatureEvidence {
  std::vector<EffectEvidence> effects;  ///< One for each effect, in order of their ids.
  double misfit = 0.0;                  ///< Of the base model.
  int count = 0;                        ///< Signatures measured.
  Eigen::VectorXd scores;               ///< (q) of the base model alone.
};

/// The base model and the effects that look likeliest are each fitted from the drawings and from
/// the base model's mode, because the model is linear about neither.
/// @param candidates  Must outlive the evidence.
/// @param predictor   Of the same site; what it has accepted counts. If it was stopped, the
///                    evidence means nothing.
/// @param since_day   As of `expect_changes`.
[[nodiscard]] SignatureEvidence evidence_of(const SiteProblem& site,
                                            const std::vector<Candidate>& candidates,
                                            const SignatureNull& null, Predictor& predictor,
                                            std::optional<int> since_day = {});

}  // namespace recald::diagnosis
