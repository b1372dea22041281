#include "core/diagnosis/check/usual_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/diagnosis/check/ground.hpp"
#include "core/diagnosis/evidence/candidate_shapes.hpp"
#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::usual_errors_test {
namespace {

constexpr std::array kParameters{"outdoor_airflow", "cooling_setpoint"};

std::vector<double> middle_of(const SiteProblem& site) {
  std::vector<double> theta;
  for (const Parameter& p : site.parameters) theta.push_back(p.prior.quantile(0.5));
  return theta;
}

std::vector<MeterScale> linear(const SiteProblem& site) {
  return std::vector<MeterScale>(site.meters.size());
}

// Of an amount's typical footprint as much as was learnt, on every meter at once.
TEST(UsualErrors, AColumnIsALittleOfItsEffect) {
  const SiteProblem site = testing::sample_problem(kParameters, 12);
  Predictor predictor{site};
  const std::vector<double> theta = middle_of(site);
  const UsualErrors errors = UsualErrors::draw(predictor, site, theta);
  const Observations all = observe(site, std::vector<bool>(site.roles.size(), true), linear(site));
  const Eigen::MatrixXd columns = errors.columns(all);
  ASSERT_EQ(columns.cols(), errors.count());

  const auto candidates = list_candidates(site).candidates;
  const auto leak = std::ranges::find_if(candidates, [](const Candidate& c) {
    return c.effect->id == "steam_trap_leak" && !c.begins;
  });
  ASSERT_NE(leak, candidates.end());
  const Eigen::VectorXd base = all.stack(predictor.parts_kW(theta));
  const auto whole = alteration_of(*leak, site.facts(), own_shapes(*leak).front());
  const Eigen::VectorXd footprint = all.stack(predictor.parts_kW(theta, whole.get())) - base;
  const auto at = std::ranges::find(errors.effects(), "steam_trap_leak");
  ASSERT_NE(at, errors.effects().end());
  const Eigen::VectorXd column = columns.col(at - errors.effects().begin());
  EXPECT_LT((column - usual_amount_sd("steam_trap_leak") * footprint).norm(),
            1e-9 * footprint.norm());
  EXPECT_GT(footprint.norm(), 0.0);
}

// Scanned values may all be neutral: such a shape is no effect.
TEST(UsualErrors, NoShapeIsWithoutAnEffect) {
  const SiteProblem site = testing::sample_problem(kParameters, 12);
  Predictor predictor{site};
  const std::vector<double> theta = middle_of(site);
  predictor.parts_kW(theta);
  const Eigen::ArrayXXd base = predictor.hours_kW();
  int shapes = 0;
  for (const Candidate& candidate : list_candidates(site).candidates) {
    if (candidate.effect->id != "early_start" || candidate.begins) continue;
    for (const std::vector<double>& shape : own_shapes(candidate)) {
      predictor.parts_kW(theta, alteration_of(candidate, site.facts(), shape).get());
      EXPECT_GT((predictor.hours_kW() - base).abs().maxCoeff(), 0.0);
      ++shapes;
    }
  }
  EXPECT_EQ(shapes, 8);
}

// A clock is right or wrong, and what has a first day is no habit of models.
TEST(UsualErrors, HoldNoClockAndNothingDated) {
  const SiteProblem site = testing::sample_problem(kParameters, 12);
  Predictor predictor{site};
  const UsualErrors errors = UsualErrors::draw(predictor, site, middle_of(site));
  const auto holds = [&](std::string_view effect) {
    return std::ranges::find(errors.effects(), effect) != errors.effects().end();
  };
  EXPECT_TRUE(holds("damper_stuck_open"));
  EXPECT_TRUE(holds("scale_fault"));
  EXPECT_FALSE(holds("clock_offset"));
  EXPECT_FALSE(holds("stuck_meter"));
  EXPECT_FALSE(holds("equipment_step"));
}

// Where a little of an effect is usual, it takes much of it to stand out.
TEST(UsualErrors, MakeTheirOwnEffectsLessVisible) {
  SiteProblem site = testing::sample_problem(kParameters, 12);
  Rng rng{4};
  for (double& value : site.measured_parts_kW.reshaped()) value *= 1.0 + 0.02 * rng.normal();
  Predictor predictor{site};
  const auto ground = lay_ground(predictor, site, Eigen::VectorXd::Zero(2));
  ASSERT_TRUE(ground.has_value()) << ground.error().message;
  const auto& effects = ground->usual->effects();
  const auto which = std::ranges::find(effects, "ground_coupling") - effects.begin();
  const NoiseNode& node = ground->grid[static_cast<std::size_t>(ground->none.best_node)];
  // d of one usual sd, the first `known` of the base columns being integrated out.
  const auto visibility = [&](Eigen::Index known) {
    Eigen::MatrixXd columns(ground->fit.count(), known + 2);
    columns << ground->none.linear_residual(), ground->none.jacobian.leftCols(known),
        ground->errors.col(which);
    const auto system =
        marginalise(node.gram(ground->fit, columns), Eigen::MatrixXd::Identity(known, known));
    return detectability(*system)[0];
  };
  EXPECT_LT(visibility(ground->none.jacobian.cols()), 1.0);
  EXPECT_GT(visibility(std::ssize(site.parameters)), 1.0);
}

// A meter that errs three times as much by day as by night.
TEST(Spread, FollowsThePartOfTheDay) {
  const SiteProblem site = testing::sample_problem(kParameters, 24);
  const Observations all = observe(site, std::vector<bool>(site.roles.size(), true), linear(site));
  const MeterRows& meter = all.meters[1];
  Rng rng{3};
  Eigen::VectorXd residual(std::ssize(meter.rows));
  for (std::size_t i = 0; i < meter.rows.size(); ++i) {
    const int part = site.day_parts.parts[static_cast<std::size_t>(meter.rows[i])].part;
    residual[static_cast<Eigen::Index>(i)] = (part == 3 ? 6.0 : 2.0) * rng.normal();
  }
  const Eigen::ArrayXd spread = spread_of(site, meter, residual);
  ASSERT_EQ(spread.size(), site.day_parts.count());
  double noon = 0.0;
  double night = 0.0;
  double logs = 0.0;
  for (Eigen::Index i = 0; i < spread.size(); ++i) {
    const int part = site.day_parts.parts[static_cast<std::size_t>(i)].part;
    if (part == 3) noon += spread[i];
    if (part == 0) night += spread[i];
    logs += std::log(spread[i]);
  }
  EXPECT_GT(noon / night, 1.8);  // drawn towards the mean of all
  EXPECT_LT(noon / night, 3.2);
  EXPECT_NEAR(logs / static_cast<double>(spread.size()), 0.0, 1e-9);
}

TEST(Spread, DividesWhatIsStacked) {
  const SiteProblem site = testing::sample_problem(kParameters, 12);
  std::vector<MeterScale> scales = linear(site);
  const std::vector<bool> flags(site.roles.size(), true);
  const Eigen::VectorXd plain = observe(site, flags, scales).measured;
  scales[0].spread = Eigen::ArrayXd::Constant(site.day_parts.count(), 4.0);
  const Observations spread = observe(site, flags, scales);
  const auto n = std::ssize(spread.meters[0].rows);
  EXPECT_LT((4.0 * spread.measured.head(n) - plain.head(n)).norm(), 1e-9 * plain.head(n).norm());
  EXPECT_EQ(spread.measured.tail(plain.size() - n), plain.tail(plain.size() - n));
}

// What is scanned, a humidity, is no amount.
TEST(CandidateShapes, AnAmountIsScaledFromNeutralWithinItsPriorAndAShapeStays) {
  const SiteProblem site = testing::sample_problem(kParameters, 12);
  const auto candidates = list_candidates(site).candidates;
  const auto humidifier = std::ranges::find_if(
      candidates, [](const Candidate& c) { return c.effect->id == "humidifier" && !c.begins; });
  ASSERT_NE(humidifier, candidates.end());
  const std::vector<double> typical = own_shapes(*humidifier).front();
  const auto half = with_amount(*humidifier, typical, 0.5);
  EXPECT_DOUBLE_EQ(half[0], 0.5 * typical[0]);
  EXPECT_EQ(half[1], typical[1]);
  EXPECT_DOUBLE_EQ(with_amount(*humidifier, typical, 100.0)[0], 1.0);  // all of the outdoor air
  EXPECT_DOUBLE_EQ(with_amount(*humidifier, typical, -1.0)[0], 0.0);   // one-sided
}

TEST(CandidateShapes, OfSeveralAmountsEachIsTriedAlone) {
  const SiteProblem site = testing::sample_problem(kParameters, 12);
  const auto candidates = list_candidates(site).candidates;
  const auto weekends = std::ranges::find_if(candidates, [](const Candidate& c) {
    return c.effect->id == "weekend_operation" && !c.begins;
  });
  ASSERT_NE(weekends, candidates.end());
  const auto both = own_shapes(*weekends);
  ASSERT_EQ(both.size(), 1U);
  const double saturday = both.front()[0];
  const double sunday = both.front()[1];
  EXPECT_GT(saturday, 0.0);
  EXPECT_GT(sunday, 0.0);
  const std::vector<std::vector<double>> tried{{saturday, sunday}, {saturday, 0.0}, {0.0, sunday}};
  EXPECT_EQ(shapes_to_try(*weekends), tried);
}

}  // namespace
}  // namespace recald::diagnosis::usual_errors_test
