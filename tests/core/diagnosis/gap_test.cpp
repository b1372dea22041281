#include "core/diagnosis/check/gap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/absent.hpp"
#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::gap_test {
namespace {

constexpr std::array kParameters{"outdoor_airflow", "cooling_setpoint"};

/// The sample building's own meters with white noise of 3 % of their means.
SiteProblem noisy_site() {
  SiteProblem site = testing::sample_problem(kParameters, 24);
  Rng rng{11};
  for (Eigen::Index g = 0; g < site.measured_parts_kW.cols(); ++g) {
    const double mean = site.measured_parts_kW.col(g).mean();
    for (double& value : site.measured_parts_kW.col(g)) value += 0.03 * mean * rng.normal();
  }
  return site;
}

Ground ground_of(const SiteProblem& site) {
  Predictor predictor{site};
  auto ground = lay_ground(predictor, site, Eigen::VectorXd::Zero(2));
  EXPECT_TRUE(ground.has_value()) << ground.error().message;
  return std::move(*ground);
}

TEST(ScoreGain, AddsMonthsAndKnowsTheirSpread) {
  const MonthScores without{{{3, -10.0}, {7, -12.0}}, {{3, -1.0}, {7, -1.0}}};
  const MonthScores with{{{3, -8.0}, {7, -11.0}}, {{3, -1.5}, {7, -1.0}}};
  const auto meters = gain_by_meter(difference(with, without));
  EXPECT_DOUBLE_EQ(meters[0].sum, 3.0);
  EXPECT_DOUBLE_EQ(meters[0].se, 1.0);  // differences 2 and 1: sd 1/sqrt(2), of a sum of two
  EXPECT_DOUBLE_EQ(meters[1].sum, -0.5);
  const ScoreGain all = gain_over(difference(with, without));
  EXPECT_DOUBLE_EQ(all.sum, 2.5);
  EXPECT_DOUBLE_EQ(all.se, 0.5);  // 1.5 and 1
}

TEST(ScoreGain, OneMonthHasNoSpread) {
  const ScoreGain gain = gain_over(difference({{{0, 2.0}}}, {{{0, 1.5}}}));
  EXPECT_DOUBLE_EQ(gain.sum, 0.5);
  EXPECT_EQ(gain.se, 0.0);
}

// What is wrong every working day alike is no news in a held month; what begins there is.
TEST(HeldJudge, ForgivesWhatTheFittedMonthsHaveTaught) {
  SiteProblem site = noisy_site();
  const Ground ground = ground_of(site);
  const HeldJudge judge = judge_of(site, ground, ground.show);
  const auto scores_of = [&](const Eigen::ArrayXXd& parts_kW) {
    JointFit told = ground.none;
    told.parts_kW = parts_kW;
    return judge.scores(told, *ground.usual);
  };
  const MonthScores plain = scores_of(ground.none.parts_kW);

  const double step_kW = 0.05 * ground.fit.meters[1].mean_kW;
  Eigen::ArrayXXd always_kW = ground.none.parts_kW;
  Eigen::ArrayXXd late_kW = ground.none.parts_kW;
  for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
    const auto part = static_cast<std::size_t>(i);
    if (site.day_parts.parts[part].part != 3) continue;
    always_kW(i, 1) += step_kW;
    if (site.roles[part] == Role::show) late_kW(i, 1) += step_kW;
  }
  const double always = gain_over(difference(scores_of(always_kW), plain)).sum;
  const double late = gain_over(difference(scores_of(late_kW), plain)).sum;
  EXPECT_LT(late, -20.0);
  EXPECT_GT(always, 0.3 * late);
}

TEST(Gap, IsUnknownWhereAMeterHasNoHeldReading) {
  SiteProblem site = noisy_site();
  for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
    if (site.roles[static_cast<std::size_t>(i)] == Role::show) {
      site.measured_parts_kW(i, 2) = std::nan("");
    }
  }
  const Ground ground = ground_of(site);
  const auto gaps = gaps_of(site, ground, judge_of(site, ground, ground.show));
  EXPECT_LT(gaps[0].cvrmse_daily, 0.05);
  EXPECT_TRUE(std::isnan(gaps[2].nmbe_sim_minus_meas));
  EXPECT_TRUE(std::isnan(gaps[2].cvrmse_daily));
  EXPECT_TRUE(std::isnan(gaps[2].log_score));
}

TEST(Gap, AModelIsNotConfirmedAgainstItself) {
  const SiteProblem site = noisy_site();
  const Ground ground = ground_of(site);
  const HeldJudge judge = judge_of(site, ground, ground.show);
  const MonthScores scores = judge.scores(ground.none, *ground.usual);
  const HeldChange change{difference(scores, scores),
                          error_cuts(site, ground.none.parts_kW, ground.none.parts_kW)};
  EXPECT_FALSE(is_confirmed(change.error_cuts, {}, Eigen::ArrayXd::Zero(3)));
  const auto gaps = gaps_of(site, ground, judge);
  const GapChange gap = change_of(gaps, gaps, std::span{&change, 1});
  for (const ScoreGain& meter : gap.log_score_change) EXPECT_EQ(meter.sum, 0.0);
  for (const ScoreGain& meter : gap.error_cut) EXPECT_EQ(meter.sum, 0.0);
  EXPECT_EQ(gap.after[0].log_score, gap.before[0].log_score);
}

// Two effects, one month each way: the second one's month counts against the sum.
TEST(Gap, ScoresOfSeveralAdditionsAddUpMonthByMonth) {
  const std::vector<MeterGap> gaps(1, MeterGap{.log_score = -10.0});
  const std::vector<HeldChange> changes{{{{{3, 8.0}, {7, 6.0}}}, {{{3, 0.5}, {7, 0.2}}}},
                                        {{{{3, 1.0}, {7, -2.0}}}, {{{3, 0.1}, {7, -0.2}}}}};
  const GapChange gap = change_of(gaps, gaps, changes);
  EXPECT_DOUBLE_EQ(gap.log_score_change[0].sum, 13.0);
  EXPECT_DOUBLE_EQ(gap.log_score_change[0].se, 5.0);  // 9 and 4
  EXPECT_DOUBLE_EQ(gap.after[0].log_score, -3.5);
  EXPECT_DOUBLE_EQ(gap.error_cut[0].sum, 0.6);
  EXPECT_NEAR(gap.error_cut[0].se, 0.6, 1e-9);  // 0.6 and 0
}

TEST(Gap, IsConfirmedByWhatAllMonthsSayAndByNoMetersHarm) {
  const MonthScores better{{{3, 0.8}, {7, 0.6}}, {{3, 0.0}, {7, -0.1}}};
  const Eigen::ArrayXd shrunk = Eigen::Array2d(-10.0, 0.0);
  EXPECT_TRUE(is_confirmed(better, {}, shrunk));                            // 1.3, give or take 0.3
  EXPECT_FALSE(is_confirmed({{{3, 2.0}, {7, -0.6}}}, {}, shrunk.head(1)));  // 1.4, give or take 2.6
  EXPECT_FALSE(is_confirmed({{{3, 2.0}}}, {}, shrunk.head(1)));             // a single month
  // The second meter's errors surely grow: it counts by how much.
  const MonthScores harmful{{{3, 0.8}, {7, 0.6}}, {{3, -0.2}, {7, -0.2}}};
  EXPECT_FALSE(is_confirmed(harmful, {}, Eigen::Array2d(-10.0, 3.0)));
  EXPECT_TRUE(is_confirmed(harmful, {}, Eigen::Array2d(-10.0, 2.0)));
  EXPECT_TRUE(is_confirmed(better, {}, Eigen::Array2d(-10.0, 3.0)));  // not surely
  EXPECT_FALSE(is_confirmed(harmful, {}, Eigen::Array2d(kAbsent, 3.0)));
}

// An effect that begins late cannot cut errors before: those months are no scatter of the others.
TEST(Gap, MonthsBeforeAnEffectAreTakenApart) {
  const MonthScores late{{{1, 0.0}, {2, 0.01}, {3, -0.01}, {4, 0.0}, {5, 0.6}, {6, 0.3}, {7, 0.9}}};
  const Eigen::ArrayXd shrunk = Eigen::ArrayXd::Constant(1, -10.0);
  EXPECT_FALSE(is_confirmed(late, {}, shrunk));
  EXPECT_TRUE(is_confirmed(late, {5, 6, 7}, shrunk));
  EXPECT_FALSE(is_confirmed({{{1, 0.0}, {2, 0.01}, {5, 0.6}}}, {5}, shrunk));  // one month alone
  EXPECT_FALSE(is_confirmed({{{1, 0.0}, {2, 0.0}, {3, 0.0}, {5, 0.6}, {6, 0.6}}}, {5, 6}, shrunk));
  EXPECT_TRUE(is_confirmed({{{1, 0.0}, {5, 0.6}, {6, 0.7}, {7, 0.8}}}, {5, 6, 7}, shrunk));
  // What gets worse before counts against it.
  EXPECT_FALSE(
      is_confirmed({{{1, -0.5}, {2, -0.4}, {5, 0.4}, {6, 0.3}, {7, 0.2}}}, {5, 6, 7}, shrunk));
}

TEST(Gap, MonthsMovedAreThoseInWhichTheEffectDoesSomething) {
  const SiteProblem site = noisy_site();
  const Eigen::ArrayXXd without = site.measured_parts_kW;
  Eigen::ArrayXXd with = without;
  for (Eigen::Index i = 0; i < with.rows(); ++i) {
    const int month = site.day_parts.parts[static_cast<std::size_t>(i)].month;
    with(i, 1) += month >= 20 ? 5.0 : month >= 18 ? 0.04 : 0.0;
  }
  EXPECT_EQ(months_moved(site, with, without), (std::set<int>{20, 21, 22, 23}));
}

TEST(Gap, ErrorsAreCutByTheLogOfTheirRatioInHeldMonthsAlone) {
  SiteProblem site = noisy_site();
  Eigen::ArrayXXd without = site.measured_parts_kW;
  site.measured_parts_kW.col(2).setConstant(kAbsent);
  Eigen::ArrayXXd with = without;
  for (Eigen::Index i = 0; i < with.rows(); ++i) {
    const bool is_held = site.roles[static_cast<std::size_t>(i)] == Role::show;
    without(i, 0) += is_held ? 4.0 : 0.0;
    with(i, 0) += is_held ? -2.0 : 50.0;
  }
  const MonthScores cuts = error_cuts(site, with, without);
  EXPECT_GE(cuts[0].size(), 2u);
  // The floor is a tenth of the smaller mean square.
  for (const auto& [month, cut] : cuts[0]) EXPECT_NEAR(cut, 0.5 * std::log(16.4 / 4.4), 1e-9);
  for (const auto& [month, cut] : cuts[1]) EXPECT_EQ(cut, 0.0);  // both are right
  EXPECT_TRUE(cuts[2].empty());                                  // no readings
}

TEST(Gap, HeldErrorsAreThoseOfHeldMonthsAlone) {
  SiteProblem site = noisy_site();
  Eigen::ArrayXXd modelled = site.measured_parts_kW;
  site.measured_parts_kW.col(2).setConstant(kAbsent);
  for (Eigen::Index i = 0; i < modelled.rows(); ++i) {
    const bool is_held = site.roles[static_cast<std::size_t>(i)] == Role::show;
    modelled(i, 0) += is_held ? -3.0 : 50.0;
  }
  const Eigen::ArrayXd errors_kW = held_errors_kW(site, modelled);
  EXPECT_NEAR(errors_kW[0], 3.0, 1e-9);
  EXPECT_EQ(errors_kW[1], 0.0);
  EXPECT_TRUE(std::isnan(errors_kW[2]));
}

TEST(Ground, NamesTheMeterThatHasTooFewReadings) {
  SiteProblem site = noisy_site();
  site.measured_parts_kW.col(1).bottomRows(site.day_parts.count() - 60) = std::nan("");
  Predictor predictor{site};
  const auto refused = lay_ground(predictor, site, Eigen::VectorXd::Zero(2));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_enough_data);
  EXPECT_NE(refused.error().message.find("'chilled_water' has 60"), std::string::npos)
      << refused.error().message;
}

}  // namespace
}  // namespace recald::diagnosis::gap_test
