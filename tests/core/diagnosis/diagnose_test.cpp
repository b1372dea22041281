#include "core/diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/support/in_threads.hpp"
#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::diagnose_test {
namespace {

/// The sample building as its own meters, with what `hidden` adds and noise. The calibrated model
/// generated its own data: these tests prove the machinery, never that it names real effects.
SiteProblem site_with(const Effect* hidden, const std::vector<double>& values, int months = 24) {
  constexpr std::array kParameters{"outdoor_airflow", "cooling_setpoint", "leakage_area"};
  SiteProblem site = testing::sample_problem(kParameters, months);
  Predictor predictor{site};
  std::vector<double> theta;
  for (const Parameter& p : site.parameters) theta.push_back(p.prior.quantile(0.4));
  const auto alteration = hidden == nullptr ? nullptr : hidden->bind(site.facts(), values, -1);
  predictor.parts_kW(theta, alteration.get());
  site.measured_kW = predictor.hours_kW();
  site.day_parts.average_into(site.measured_kW, site.measured_parts_kW);
  Rng rng{7};
  for (Eigen::Index g = 0; g < 3; ++g) {
    const double mean = site.measured_parts_kW.col(g).mean();
    double slow = 0.0;
    for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
      slow = 0.95 * slow + 0.01 * mean * rng.normal();
      site.measured_parts_kW(i, g) += slow + 0.02 * mean * rng.normal();
    }
  }
  return site;
}

/// A year and a half of the sample building, which runs at weekends; looked into once for all
/// tests.
const SiteProblem& running_at_weekends() {
  static const SiteProblem site = site_with(find_effect("weekend_operation"), {0.8, 0.8}, 18);
  return site;
}
const Result<Diagnosis>& what_runs_at_weekends() {
  static const Result<Diagnosis> diagnosis = diagnose(running_at_weekends(), {});
  return diagnosis;
}

// Between two questions lies one run of the model, whatever the search is at.
TEST(Diagnose, EndsAtTheRunAtWhichItIsToldTo) {
  const SiteProblem site = site_with(nullptr, {}, 12);
  int all = 0;
  ASSERT_TRUE(diagnose(site, {}, [&](const char*, double) { return ++all > 0; }).has_value());
  for (const int runs : {1, 2, 30, all / 2, all - 10, all}) {
    int asked = 0;
    const auto stopped = diagnose(site, {}, [&](const char*, double) { return ++asked < runs; });
    ASSERT_FALSE(stopped.has_value());
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled) << stopped.error().message;
    EXPECT_EQ(asked, runs);
  }
}

TEST(Diagnose, NamesNothingWhereNothingIsHidden) {
  const SiteProblem site = site_with(nullptr, {});
  const auto diagnosis = diagnose(site, {});
  ASSERT_TRUE(diagnosis.has_value()) << diagnosis.error().message;
  EXPECT_EQ(diagnosis->outcome, Outcome::none);
  EXPECT_TRUE(diagnosis->added.empty());
  EXPECT_GT(diagnosis->candidates.size(), 30u);
}

TEST(Diagnose, NamesAHiddenEffectAndShowsThatTheGapShrank) {
  const auto& diagnosis = what_runs_at_weekends();
  ASSERT_TRUE(diagnosis.has_value()) << diagnosis.error().message;
  const Naming& naming = diagnosis->passes.front().naming;
  ASSERT_EQ(diagnosis->outcome, Outcome::named)
      << naming.why << "; first " << naming.probabilities.front().effect << ", gains "
      << naming.explanations.front().evidence_gain << " and "
      << naming.explanations.front().selected.sum << " +- "
      << naming.explanations.front().selected.se;
  ASSERT_EQ(diagnosis->added.size(), 1u);
  EXPECT_EQ(diagnosis->added[0].candidate.effect->id, "weekend_operation");
  EXPECT_NEAR(diagnosis->added[0].eta[0], 0.8, 3.0 * diagnosis->added[0].eta_sd[0]);
  ASSERT_TRUE(diagnosis->gap.has_value());
  EXPECT_TRUE(diagnosis->gap->confirmed);
  EXPECT_LT(diagnosis->gap->after[2].cvrmse_daily, diagnosis->gap->before[2].cvrmse_daily);
}

TEST(Diagnose, ProbabilitiesAreThoseOfTheSignatures) {
  const auto& diagnosis = what_runs_at_weekends();
  ASSERT_TRUE(diagnosis.has_value()) << diagnosis.error().message;
  const Naming& naming = diagnosis->passes.front().naming;
  double sum = 0.0;
  std::vector<std::size_t> fitted;
  for (const NameProbability& p : naming.probabilities) {
    sum += p.probability;
    if (p.explanation) fitted.push_back(*p.explanation);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_GT(naming.probabilities.size(), 20u);
  EXPECT_EQ(fitted, std::vector<std::size_t>{0});  // the only one that is likely
  const auto& first = diagnosis->candidates[naming.explanations[0].candidate];
  EXPECT_EQ(first.effect->id, "weekend_operation");
  // What is not asked of the model is told.
  EXPECT_TRUE(std::ranges::any_of(diagnosis->not_identifiable, [](const NotIdentifiable& n) {
    return n.effect == "stuck_meter";
  }));
}

TEST(Diagnose, SameInputsGiveTheSameResultOnAnyThreads) {
  const auto& first = what_runs_at_weekends();
  int asked = 0;
  const auto second = diagnose(running_at_weekends(), {.executor = recald::testing::in_threads},
                               [&](const char*, double) { return ++asked > 0; });
  ASSERT_TRUE(first.has_value());
  ASSERT_TRUE(second.has_value());
  ASSERT_GE(first->added.size(), 1u) << first->why;
  ASSERT_EQ(first->added.size(), second->added.size());
  EXPECT_EQ(first->added[0].draws, second->added[0].draws);
  EXPECT_EQ(first->passes.front().naming.probabilities.front().probability,
            second->passes.front().naming.probabilities.front().probability);
  EXPECT_EQ(first->model_runs, second->model_runs);
  EXPECT_GE(asked, second->model_runs);
}

TEST(Diagnose, StopsWhenAsked) {
  const auto stopped =
      diagnose(site_with(nullptr, {}), {}, [](const char*, double share) { return share < 0.1; });
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  // In the middle of runs side by side, too: it looks for effects then.
  const auto in_search =
      diagnose(running_at_weekends(), {.executor = recald::testing::in_threads},
               [asked = 0](const char*, double) mutable { return ++asked < 300; });
  ASSERT_FALSE(in_search.has_value());
  EXPECT_EQ(in_search.error().code, ErrorCode::cancelled);
}

TEST(Diagnose, AMeterWithHardlyAnyReadingsIsExplained) {
  SiteProblem site = site_with(nullptr, {});
  site.measured_parts_kW.col(1).bottomRows(site.day_parts.count() - 50) = std::nan("");
  const auto refused = diagnose(site, {});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_enough_data);
}

}  // namespace
}  // namespace recald::diagnosis::diagnose_test
