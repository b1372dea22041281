#include "core/calibration/posterior/summary.hpp"
#include "core/statistics/quantile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior_findings.hpp"

namespace recald::calibration::summary_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Quantile, InterpolatesLikeR) {
  const Eigen::VectorXd sorted = Eigen::Vector4d(1.0, 2.0, 4.0, 8.0);
  EXPECT_EQ(quantile_of_sorted(sorted, 0.0), 1.0);
  EXPECT_EQ(quantile_of_sorted(sorted, 1.0), 8.0);
  EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, 0.5), 3.0);
  EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, 0.05), 1.15);  // R: quantile(c(1,2,4,8), 0.05)
}

TEST(Summary, OfKnownDraws) {
  Eigen::MatrixXd draws(50, 2);
  for (Eigen::Index i = 0; i < 100; ++i) draws.data()[i] = static_cast<double>((37 * i) % 100);
  const Summary s = summarise("x", "kW", draws, 60.0, 60.0);
  EXPECT_DOUBLE_EQ(s.mean, 49.5);
  EXPECT_NEAR(s.sd, std::sqrt(100.0 * 101.0 / 12.0), 1e-12);
  EXPECT_DOUBLE_EQ(s.q05, 4.95);
  EXPECT_DOUBLE_EQ(s.q50, 49.5);
  EXPECT_DOUBLE_EQ(s.q95, 94.05);
  EXPECT_NEAR(s.contraction, 1.0 - 100.0 * 101.0 / 12.0 / 3600.0, 1e-12);
}

TEST(ConvergenceGate, SaysWhatFailed) {
  Summary good{};
  good.name = "a";
  good.sd = 1.0;
  good.rhat = 1.005;
  good.ess_bulk = 900;
  good.ess_tail = 500;
  good.mcse = 0.03;
  EXPECT_TRUE(gate_findings({good}).empty());

  Summary bad = good;
  bad.name = "b";
  bad.rhat = 1.02;
  bad.ess_tail = 120;
  const Findings findings = gate_findings({good, bad});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, FindingKind::not_converged);
  EXPECT_EQ(findings[0].subject, "b");
  EXPECT_EQ(findings[0].sentence, "The chains have not converged for the b; run more iterations.");
  EXPECT_THAT(findings[0].details, HasSubstr("R-hat 1.02 above 1.01, tail ESS 120 below 400"));

  for (double Summary::*field :
       {&Summary::rhat, &Summary::ess_bulk, &Summary::ess_tail, &Summary::mcse}) {
    Summary unknown = good;
    unknown.*field = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(gate_findings({unknown}).size(), 1u) << "NaN must not pass";
  }
}

TEST(EquallySpaced, MiddlesOfEqualStretches) {
  EXPECT_THAT(equally_spaced(12, 3), ElementsAre(2, 6, 10));
  EXPECT_THAT(equally_spaced(3, 5), ElementsAre(0, 1, 2));
  const auto many = equally_spaced(108'000, 270);
  EXPECT_EQ(many.size(), 270u);
  EXPECT_EQ(many.front(), 200);
  EXPECT_EQ(many.back(), 107'800);
}

ChainDraws chain_of(const Eigen::VectorXd& theta) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(theta.size());
  return {theta, ones, ones, ones, ones, 0.25};
}

TEST(Thinning, RunsThroughAllChains) {
  const std::vector<ChainDraws> chains{chain_of(Eigen::VectorXd::LinSpaced(10, 0, 9)),
                                       chain_of(Eigen::VectorXd::LinSpaced(10, 100, 109))};
  const ThinnedDraws thinned = thin(chains, 4);
  EXPECT_THAT(thinned.chain, ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(thinned.iteration, ElementsAre(2, 7, 2, 7));
  EXPECT_EQ(thinned.theta(3, 0), 107.0);
}

TEST(PriorEdge, FlagsMassPiledAtAnEnd) {
  const std::vector<Parameter> parameters{{"flow", "m3/s", {0.0, 5.0, 10.0}}};
  Eigen::VectorXd theta = Eigen::VectorXd::Constant(100, 5.0);
  theta.head(20).setConstant(0.4);
  EXPECT_TRUE(edge_findings(parameters, {chain_of(theta)}).empty()) << "exactly 20 % is allowed";
  theta(20) = 0.4;
  const Findings findings = edge_findings(parameters, {chain_of(theta)});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, FindingKind::prior_edge);
  EXPECT_EQ(findings[0].sentence,
            "Flow: 21.0 % of the posterior lies at the lower end of its prior.");

  theta.setConstant(9.8);
  EXPECT_THAT(edge_findings(parameters, {chain_of(theta)}).at(0).sentence,
              HasSubstr("the upper end"));
}

TEST(HyperpriorConflict, FlagsAMeanOutsideThePrior) {
  const GammaPrior prior{10.0, 0.0084};  // mean 1190
  Summary s{};
  s.name = "lambda_delta";
  s.mean = 1000.0;
  EXPECT_TRUE(conflict_findings(s, prior).empty());
  s.mean = 200.0;
  const Findings findings = conflict_findings(s, prior);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, FindingKind::hyperprior_conflict);
  EXPECT_EQ(findings[0].sentence,
            "The data contradict the prior of the precision of the model's discrepancy.");
  EXPECT_THAT(findings[0].details, HasSubstr("standard deviation of 0.071"));
}

TEST(Jitter, IsMentionedOnlyWhenUsed) {
  EXPECT_TRUE(jitter_findings(0).empty());
  EXPECT_THAT(jitter_findings(7).at(0).details, HasSubstr("7 times"));
}

TEST(Findings, HaveMachineNames) {
  EXPECT_EQ(to_string(FindingKind::extrapolation), "extrapolation");
  EXPECT_EQ(to_string(FindingKind::range_fail), "range_fail");
  EXPECT_EQ(to_string(FindingKind::prior_edge), "prior_edge");
  EXPECT_EQ(to_string(FindingKind::hyperprior_conflict), "hyperprior_conflict");
  EXPECT_EQ(to_string(FindingKind::not_converged), "not_converged");
  EXPECT_EQ(to_string(FindingKind::prior_driven), "prior_driven");
  EXPECT_EQ(to_string(FindingKind::jitter_used), "jitter_used");
}

}  // namespace
}  // namespace recald::calibration::summary_test
