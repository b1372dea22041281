#include "core/diagnosis/evidence/joint_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/diagnosis/check/ground.hpp"
#include "core/diagnosis/diagnose.hpp"
#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::joint_fit_test {
namespace {

constexpr std::array kParameters{"outdoor_airflow", "cooling_setpoint"};

Candidate candidate_of(const SiteProblem& site, std::string_view effect) {
  const auto candidates = list_candidates(site).candidates;
  const auto found = std::ranges::find_if(
      candidates, [&](const Candidate& c) { return c.effect->id == effect && !c.begins; });
  EXPECT_NE(found, candidates.end());
  return *found;
}

struct Fitted {
  double none_evidence;
  JointFit fit;
};

/// As if a model had no errors besides its parameters and noise.
Ground ground_without_errors(Predictor& predictor, const SiteProblem& site) {
  const Eigen::VectorXd middle = Eigen::VectorXd::Zero(std::ssize(site.parameters));
  auto ground = lay_ground(predictor, site, middle);
  EXPECT_TRUE(ground.has_value());
  ground->errors.resize(ground->fit.count(), 0);
  auto none = fit_jointly(predictor, ground->context(site), Candidate{}, middle,
                          {.iterations_max = 30, .small_gain = 1e-3});
  EXPECT_TRUE(none.has_value());
  ground->none = std::move(*none);
  return std::move(*ground);
}

/// The sample building shut on holidays that its site file lacks, fitted with one calendar chosen.
Fitted fit_holidays(double chosen) {
  SiteProblem site = testing::sample_problem(kParameters, 14);
  const Candidate holidays = candidate_of(site, "missing_holidays");
  Predictor predictor{site};
  std::vector<double> theta;
  for (const Parameter& p : site.parameters) theta.push_back(p.prior.quantile(0.45));
  const auto shut = holidays.effect->bind(site.facts(), std::vector{0.8, 0.8, 1.0}, -1);
  site.measured_parts_kW = predictor.parts_kW(theta, shut.get());
  Rng rng{5};
  for (double& value : site.measured_parts_kW.reshaped()) value *= 1.0 + 0.01 * rng.normal();

  const Ground ground = ground_without_errors(predictor, site);
  const auto q = ground.none.scores.size();
  Eigen::VectorXd start(q + 3);
  start.head(q) = ground.none.scores;
  for (int j = 0; j < 3; ++j) {
    const Prior& prior = holidays.parameters[static_cast<std::size_t>(j)].prior;
    start[q + j] = score_of(prior, j < 2 ? 0.5 : chosen);
  }
  auto fit = fit_jointly(predictor, ground.context(site), holidays, start);
  EXPECT_TRUE(fit.has_value());
  return {ground.none.log_evidence, std::move(*fit)};
}

// Half way between two calendars there is none: the one chosen is kept to the digit, and known.
TEST(FitJointly, AChoiceIsNeverFitted) {
  const Fitted right = fit_holidays(1.0);
  EXPECT_NEAR(right.fit.eta[2], 1.0, 1e-9);
  EXPECT_NEAR(right.fit.eta[0], 0.8, 0.1);
  EXPECT_LT(right.fit.posterior.covariance.bottomRightCorner(1, 1)(0, 0), 1e-9);
  const Fitted wrong = fit_holidays(3.0);
  EXPECT_NEAR(wrong.fit.eta[2], 3.0, 1e-9);
  EXPECT_GT(right.fit.log_evidence, wrong.fit.log_evidence + 20.0);
  EXPECT_GT(right.fit.log_evidence, right.none_evidence + 20.0);
}

/// The sample building at other parameters, 3 % of noise, and a ground for it without usual errors.
struct NoisyFit {
  SiteProblem site = testing::sample_problem(kParameters, 14);
  std::unique_ptr<Predictor> predictor;
  Ground ground;

  NoisyFit() {
    predictor = std::make_unique<Predictor>(site);
    std::vector<double> theta;
    for (const Parameter& p : site.parameters) theta.push_back(p.prior.quantile(0.3));
    site.measured_parts_kW = predictor->parts_kW(theta);
    Rng rng{7};
    for (double& value : site.measured_parts_kW.reshaped()) value *= 1.0 + 0.03 * rng.normal();
    ground = ground_without_errors(*predictor, site);
  }
};

// At the mode of the parameters the slope of the density in b, E' Sigma^-1 (r - E b) - b, is zero.
TEST(FitJointly, UsualErrorsAreTheLikeliestAtTheMode) {
  NoisyFit noisy;
  const Eigen::Index n = noisy.ground.fit.count();
  noisy.ground.errors.resize(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    noisy.ground.errors(i, 0) = noisy.ground.fit.measured[i] * 0.05;
    noisy.ground.errors(i, 1) = i % 7 == 0 ? noisy.ground.fit.measured[i] * 0.02 : 0.0;
  }
  const FitContext context = noisy.ground.context(noisy.site);
  auto fit = fit_jointly(*noisy.predictor, context, Candidate{}, Eigen::VectorXd::Zero(4),
                         {.iterations_max = 30, .small_gain = 1e-6});
  ASSERT_TRUE(fit.has_value());
  EXPECT_TRUE(fit->converged);
  const NoiseNode& node = context.grid[context.reference_node];
  const Eigen::VectorXd slope =
      context.errors.transpose() * node.solve(context.observations, fit->residual) - fit->usual;
  EXPECT_LT(slope.cwiseAbs().maxCoeff(), 1e-6 * std::max(1.0, fit->usual.cwiseAbs().maxCoeff()));
}

// Slopes that are learnt from steps lead to the same mode from wherever it starts.
TEST(FitJointly, FindsTheModeFromAFarStart) {
  NoisyFit noisy;
  const JointFit& none = noisy.ground.none;
  ASSERT_TRUE(none.converged);
  for (const double far : {-4.0, 7.0}) {
    auto fit = fit_jointly(*noisy.predictor, noisy.ground.context(noisy.site), Candidate{},
                           Eigen::VectorXd::Constant(2, far), {.iterations_max = 30});
    ASSERT_TRUE(fit.has_value());
    EXPECT_TRUE(fit->converged) << far;
    EXPECT_NEAR(fit->log_density, none.log_density, 1.5) << far;
    EXPECT_LT((fit->scores - none.scores).norm(), 0.1) << far;
  }
}

// The base model and its rivals have the usual errors of one node, that of the ground.
TEST(Ground, HasTheUsualErrorsOfItsReferenceNode) {
  NoisyFit noisy;
  Predictor predictor{noisy.site};
  auto ground = lay_ground(predictor, noisy.site, Eigen::VectorXd::Zero(2));
  ASSERT_TRUE(ground.has_value());
  ASSERT_GT(ground->usual->count(), 0);
  ASSERT_GT(ground->grid.size(), 1u);
  const Eigen::VectorXd gap = ground->none.residual + ground->errors * ground->none.usual;
  const auto slope_of = [&](const JointFit& fit) {
    const NoiseNode& node = ground->grid[ground->reference_node];
    return (ground->errors.transpose() * node.solve(ground->fit, fit.residual) - fit.usual).norm();
  };
  EXPECT_LT(slope_of(ground->none), 1e-6);
  JointFit moved = ground->none;
  ground->reference_node = ground->reference_node == 0 ? 1 : 0;
  EXPECT_GT(slope_of(moved), 1e-3);
  ASSERT_TRUE(take_usual_errors(ground->context(noisy.site), moved).has_value());
  EXPECT_LT(slope_of(moved), 1e-6);
  EXPECT_LT((moved.residual + ground->errors * moved.usual - gap).norm(), 1e-9 * gap.norm());
  EXPECT_LT((moved.scores.tail(moved.usual.size()) - moved.usual).norm(), 1e-12);
}

// An error that looks like a parameter must not stand in for it: footprints are drawn where the
// parameters are.
TEST(FitJointly, ParametersExplainWhatUsualErrorsCould) {
  NoisyFit noisy;
  const JointFit& none = noisy.ground.none;
  Eigen::VectorXd moved = none.scores;
  moved[0] += 1.0;
  const Eigen::VectorXd mimic = noisy.ground.fit.stack(noisy.predictor->parts_kW(
                                    values_at(priors_of(noisy.site), moved.head(2)))) -
                                noisy.ground.fit.stack(none.parts_kW);
  noisy.ground.errors = 3.0 * mimic;
  auto fit = fit_jointly(*noisy.predictor, noisy.ground.context(noisy.site), Candidate{},
                         Eigen::VectorXd::Zero(3), {.iterations_max = 30});
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->scores[0], none.scores[0], 0.05);
  EXPECT_LT(std::abs(fit->usual[0]), 0.05);
}

// What is known to be there is added, and nothing else is asked.
TEST(Diagnose, AddsWhatIsAssumed) {
  const SiteProblem site = testing::sample_problem(kParameters, 14);
  DiagnoseOptions options;
  options.assumed = {"steam_trap_leak"};
  const auto diagnosis = diagnose(site, options);
  ASSERT_TRUE(diagnosis.has_value()) << diagnosis.error().message;
  ASSERT_EQ(diagnosis->added.size(), 1u);
  EXPECT_EQ(diagnosis->added[0].candidate.effect->id, "steam_trap_leak");
  EXPECT_EQ(diagnosis->outcome, Outcome::named);
  EXPECT_FALSE(diagnosis->not_confirmed);
  EXPECT_TRUE(diagnosis->gap.has_value());
  EXPECT_EQ(diagnosis->passes.size(), 2u);
}

TEST(Diagnose, AnAssumedEffectThatIsNoneIsExplained) {
  const SiteProblem site = testing::sample_problem(kParameters, 14);
  DiagnoseOptions options;
  options.assumed = {"poltergeist"};
  const auto refused = diagnose(site, options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_found);
  EXPECT_NE(refused.error().message.find("'poltergeist'"), std::string::npos);
}

}  // namespace
}  // namespace recald::diagnosis::joint_fit_test
