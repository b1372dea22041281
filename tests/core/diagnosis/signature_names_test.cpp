#include "core/diagnosis/naming/signature_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/naming/learnt_names.hpp"

namespace recald::diagnosis::signature_names_test {
namespace {

/// Three effects, of which the second explains much.
SignatureEvidence sample_evidence() {
  return {.effects = {{.factor = 5.0, .log_gain = -2.0, .misfit = 400.0, .visibility = 9.0},
                      {.factor = 1.0, .log_gain = 36.0, .misfit = 100.0, .visibility = 4.0},
                      {.factor = 0.1,
                       .log_gain = 0.0,
                       .misfit = 400.0,
                       .visibility = 0.0,
                       .is_wrong_sign = true}},
          .misfit = 400.0,
          .count = 200};
}

TEST(SignatureNames, FeaturesAreWhatTheyAreCalled) {
  const Eigen::MatrixXd features = effect_features(sample_evidence());
  ASSERT_EQ(features.rows(), 3);
  ASSERT_EQ(features.cols(), kEffectFeatures);
  Eigen::MatrixXd expected(3, kEffectFeatures);
  expected << -0.1, 0.0, 0.0, 0.0, 0.0, std::log(2.0), 0.0, 0.5 * std::log1p(std::sqrt(4.5)),
      -2.0,                                                                                   //
      1.8, 2.0, std::sqrt(0.75), 0.75, 0.0, 0.0, 0.0, 0.5 * std::log1p(std::sqrt(2.0)), 0.0,  //
      0.0, 0.0, 0.0, 0.0, 1.0, 0.0, std::log(3.0), 0.0, -2.0;
  EXPECT_TRUE(features.isApprox(expected, 1e-12)) << features;
  const Eigen::Vector3d site(1.0, std::log(2.0), 0.5 * std::log(75.0) - 1.0);
  EXPECT_TRUE(site_features(sample_evidence()).isApprox(site, 1e-12));
}

TEST(SignatureNames, AnswersShareWhatIsCertain) {
  NameWeights weights{};
  weights.effect[0] = 2.0;
  weights.none << 1.0, 0.0, 0.0;
  weights.unknown << -1.0, 0.0, 0.0;
  const SignatureNames names = names_by(sample_evidence(), weights);
  const double sum = std::exp(-0.2) + std::exp(3.6) + 1.0 + std::exp(1.0) + std::exp(-1.0);
  EXPECT_NEAR(names.probabilities[1], std::exp(3.6) / sum, 1e-12);
  EXPECT_NEAR(names.none, std::exp(1.0) / sum, 1e-12);
  EXPECT_NEAR(names.probabilities.sum() + names.none + names.unknown, 1.0, 1e-12);
}

TEST(SignatureNames, APriorOfNoneIsItsOdds) {
  NameWeights weights{};
  weights.effect[0] = 2.0;
  const SignatureNames even = names_by(sample_evidence(), weights);
  const SignatureNames rare = names_by(sample_evidence(), weights, 0.9);
  EXPECT_NEAR(rare.none / rare.unknown, 9.0 * even.none / even.unknown, 1e-12);
  EXPECT_NEAR(rare.probabilities[1] / rare.unknown, even.probabilities[1] / even.unknown, 1e-12);
  EXPECT_NEAR(rare.probabilities.sum() + rare.none + rare.unknown, 1.0, 1e-12);
  EXPECT_EQ(rare.prior_none, 0.9);
}

TEST(SignatureNames, WithoutSignaturesNothingIsSaid) {
  const SignatureNames names = names_by({}, learnt_weights(), 0.9);
  EXPECT_EQ(names.prior_none, 0.9);
  EXPECT_EQ(names.none, 1.0);
  EXPECT_EQ(names.probabilities.size(), 0);
}

TEST(SignatureNames, APerfectModelIsNoReasonForNoNumber) {
  SignatureEvidence evidence = sample_evidence();
  evidence.misfit = 0.0;
  for (EffectEvidence& e : evidence.effects) e.misfit = 0.0;
  EXPECT_TRUE(names_by(evidence, learnt_weights()).probabilities.allFinite());
}

TEST(LearntNames, KnowHowFarModelsAreOff) {
  const SignatureNull& null = learnt_null();
  const auto entries = static_cast<Eigen::Index>(signature_names().size() * kSignatureMeters);
  ASSERT_EQ(null.spread.size(), entries);
  ASSERT_EQ(null.patterns.rows(), entries);
  EXPECT_GT(null.spread.minCoeff(), 0.0);
  EXPECT_GT(null.own.minCoeff(), 0.0);
  // In units of the spread, most of a building's squares are the patterns' and its own.
  const Eigen::VectorXd variance = null.patterns.rowwise().squaredNorm() + null.own;
  EXPECT_GT(variance.mean(), 0.3);
  EXPECT_LT(variance.mean(), 3.0);
  EXPECT_TRUE(null.reach.contains("base_heat"));
}

TEST(LearntNames, MoreEvidenceIsMoreProbable) {
  SignatureEvidence evidence = sample_evidence();
  const double strong = names_by(evidence, learnt_weights()).probabilities[1];
  evidence.effects[1].log_gain = 4.0;
  evidence.effects[1].misfit = 390.0;
  const SignatureNames weak = names_by(evidence, learnt_weights());
  EXPECT_GT(strong, 0.5);
  EXPECT_LT(weak.probabilities[1], 0.5 * strong);
  EXPECT_GT(weak.none, weak.probabilities[1]);
}

}  // namespace
}  // namespace recald::diagnosis::signature_names_test
