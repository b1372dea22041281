/// How probable each possible effect is by the signatures of the meters.
///
/// A conditional logit: effects, none and unknown compete, each with a score that is linear in a
/// few features. Weights are shared by all effects and learnt from simulated buildings of two
/// worlds.
/// @see McFadden (1974), Conditional logit analysis of qualitative choice behavior.
#pragma once

#include <Eigen/Core>

#include "core/diagnosis/naming/signature_evidence.hpp"

namespace recald::diagnosis {

inline constexpr Eigen::Index kEffectFeatures = 9;
inline constexpr Eigen::Index kSiteFeatures = 3;

/// (effects x kEffectFeatures) log gain and its root, share of the misfit explained and its root,
/// wrong sign, too much, too little, visibility, how far the gain is behind the best one.
[[nodiscard]] Eigen::MatrixXd effect_features(const SignatureEvidence& evidence);
/// One, misfit of the base model, strongest effect.
[[nodiscard]] Eigen::VectorXd site_features(const SignatureEvidence& evidence);

struct NameWeights {
  Eigen::Vector<double, kEffectFeatures> effect = Eigen::Vector<double, kEffectFeatures>::Zero();
  Eigen::Vector<double, kSiteFeatures> none = Eigen::Vector<double, kSiteFeatures>::Zero();
  Eigen::Vector<double, kSiteFeatures> unknown = Eigen::Vector<double, kSiteFeatures>::Zero();
};

/// Weights are learnt where nothing is hidden in half of the buildings.
inline constexpr double kEvenPrior = 0.5;

struct SignatureNames {
  SignatureEvidence evidence;
  Eigen::VectorXd probabilities;  ///< Of `evidence.effects`, in their order.
  double none = 1.0;
  double unknown = 0.0;
  double prior_none = kEvenPrior;
};

/// @param prior_none  Probability before any reading that nothing is missing from the model;
///                    above 0 and below 1.
/// @return none for sure where the site has no signatures.
[[nodiscard]] SignatureNames names_by(SignatureEvidence evidence, const NameWeights& weights,
                                      double prior_none = kEvenPrior);

}  // namespace recald::diagnosis
