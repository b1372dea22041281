#include "core/diagnosis/naming/signature_names.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace recald::diagnosis {
namespace {

/// The misfit of a signature; a very good fit is no reason to trust small differences.
double inflation(const SignatureEvidence& evidence) {
  constexpr double kLeast = 0.2;
  return std::max(evidence.misfit / std::max(evidence.count, 1), kLeast);
}

double odds_of(double probability) { return probability / (1.0 - probability); }

}  // namespace

Eigen::MatrixXd effect_features(const SignatureEvidence& evidence) {
  constexpr double kMuch = 2.5;  // Of the typical amount.
  constexpr double kLittle = 0.3;
  constexpr double kFarBehind = 10.0;
  const double inflated = inflation(evidence);
  double best = -kFarBehind;
  for (const EffectEvidence& e : evidence.effects) best = std::max(best, e.log_gain);
  Eigen::MatrixXd features(std::ssize(evidence.effects), kEffectFeatures);
  for (std::size_t i = 0; i < evidence.effects.size(); ++i) {
    const EffectEvidence& e = evidence.effects[i];
    const double factor = std::max(e.factor, 1e-3);
    const double explained = std::max(1.0 - e.misfit / std::max(evidence.misfit, 1e-9), 0.0);
    features.row(static_cast<Eigen::Index>(i)) << std::clamp(e.log_gain, -10.0, 150.0) / 20.0,
        std::sqrt(std::max(e.log_gain, 0.0)) / 3.0, std::sqrt(explained), explained,
        e.is_wrong_sign ? 1.0 : 0.0, std::max(std::log(factor / kMuch), 0.0),
        std::max(std::log(kLittle / factor), 0.0),
        0.5 * std::log1p(std::sqrt(e.visibility / inflated)),
        std::max(e.log_gain - best, -kFarBehind) / 5.0;
  }
  return features;
}

Eigen::VectorXd site_features(const SignatureEvidence& evidence) {
  const double inflated = inflation(evidence);
  double strongest = 0.1;
  for (const EffectEvidence& e : evidence.effects) {
    strongest = std::max(strongest, 0.5 * (evidence.misfit - e.misfit) / inflated);
  }
  return Eigen::Vector3d(1.0, std::log(inflated), 0.5 * std::log(strongest) - 1.0);
}

SignatureNames names_by(SignatureEvidence evidence, const NameWeights& weights, double prior_none) {
  if (evidence.count == 0) {
    return {.evidence = std::move(evidence), .probabilities = {}, .prior_none = prior_none};
  }
  const Eigen::Index effects = std::ssize(evidence.effects);
  const Eigen::VectorXd site = site_features(evidence);
  Eigen::VectorXd scores(effects + 2);
  scores.head(effects) = effect_features(evidence) * weights.effect;
  scores.tail(2) << weights.none.dot(site) + std::log(odds_of(prior_none) / odds_of(kEvenPrior)),
      weights.unknown.dot(site);
  const Eigen::VectorXd odds = (scores.array() - scores.maxCoeff()).exp();
  const Eigen::VectorXd shares = odds / odds.sum();
  return {.evidence = std::move(evidence),
          .probabilities = shares.head(effects),
          .none = shares[effects],
          .unknown = shares[effects + 1],
          .prior_none = prior_none};
}

}  // namespace recald::diagnosis
