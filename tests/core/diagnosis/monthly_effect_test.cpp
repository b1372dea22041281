#include "core/diagnosis/evidence/monthly_effect.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::monthly_effect_test {
namespace {

using metering::Utility;
using model::hourly::Alteration;

SiteProblem sample_site(int months) {
  constexpr std::array kParameters{"outdoor_airflow", "cooling_setpoint"};
  return testing::sample_problem(kParameters, months);
}

/// (meters * months) kWh/day of the hourly model; of the effect, what the profile does not have.
std::vector<double> hourly_sum(const SiteProblem& site, const Alteration* effect,
                               const std::vector<double>& theta = {}) {
  Predictor predictor{site};
  predictor.parts_kW(theta);
  Eigen::ArrayXXd hours_kW = predictor.hours_kW();
  predictor.parts_kW(theta, effect);
  Eigen::ArrayXXd change_kW = predictor.hours_kW() - hours_kW;
  ProfileReading{site}.take_usual_day_from(change_kW);
  hours_kW += change_kW;
  const std::size_t months = site.drivers->months.size();
  std::vector<double> sums(3 * months, 0.0);
  for (std::size_t g = 0; g < 3; ++g) {
    for (std::size_t i = 0; i < site.drivers->hours.size(); ++i) {
      const auto month = static_cast<std::size_t>(site.drivers->hours[i].month);
      sums[g * months + month] +=
          hours_kW(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(g)) /
          metering::days_in(site.drivers->months[month]);
    }
  }
  return sums;
}

/// As wide as a posterior that named the effect; days within a month.
std::vector<ParameterRange> narrow_ranges(const Candidate& candidate) {
  std::vector<ParameterRange> ranges;
  for (const EffectParameter& p : candidate.parameters) {
    const bool counts_days = p.unit == "day" || p.unit == "d";
    const double middle = p.prior.quantile(0.5);
    ranges.push_back(counts_days ? ParameterRange{middle - 8.0, middle + 8.0}
                                 : ParameterRange{p.prior.quantile(0.4), p.prior.quantile(0.6)});
  }
  return ranges;
}

std::vector<double> inside(const std::vector<ParameterRange>& ranges, double share) {
  std::vector<double> values;
  for (const ParameterRange& range : ranges) {
    values.push_back(range.low + share * (range.high - range.low));
  }
  return values;
}

/// Furthest a month of a meter stands from the hourly sum, as share of the meter's mean month.
double worst_error(const SiteProblem& site, const Candidate& candidate) {
  const auto ranges = narrow_ranges(candidate);
  const MonthlyEffect effect = tabulate_effect(site, {}, candidate, ranges);
  const auto eta = inside(ranges, 0.43);
  std::vector<double> tabulated = hourly_sum(site, nullptr);
  effect.apply({}, eta, tabulated);
  const auto exact = hourly_sum(site, alteration_of(candidate, site.facts(), eta).get());
  const std::size_t months = site.drivers->months.size();
  double worst = 0.0;
  for (std::size_t g = 0; g < 3; ++g) {
    const auto first = exact.begin() + static_cast<std::ptrdiff_t>(g * months);
    const double mean = std::accumulate(first, first + static_cast<std::ptrdiff_t>(months), 0.0) /
                        static_cast<double>(months);
    for (std::size_t k = g * months; k < (g + 1) * months; ++k) {
      const double error = std::abs(tabulated[k] - exact[k]) / mean;
      if (!(error <= worst)) worst = error;  // a NaN is the worst
    }
  }
  return worst;
}

// The monthly model has the same effect at the same values within 1 %.
TEST(MonthlyEffect, IsTheHourlySumForEveryEffectOfTheCatalogue) {
  const SiteProblem site = sample_site(6);
  for (const Candidate& candidate : list_candidates(site).candidates) {
    if (candidate.meter > 0) continue;  // one meter stands for all
    EXPECT_LT(worst_error(site, candidate), 0.01) << candidate.key(site);
  }
}

// The profile of a monthly model is read off the meter: what always runs is in it already. What
// begins is in it in part, so the months before are lower, and those after higher.
TEST(MonthlyEffect, CountsNothingTwiceThatTheProfileHas) {
  const SiteProblem site = sample_site(12);
  const auto electricity = [&](bool begins) {
    const auto candidates = list_candidates(site).candidates;
    const auto room = std::ranges::find_if(candidates, [&](const Candidate& c) {
      return c.effect->id == "server_room" && c.begins == begins;
    });
    EXPECT_NE(room, candidates.end());
    std::vector<double> eta{20.0, 0.0, 0.0};
    if (begins) eta.push_back(180.0);
    std::vector<ParameterRange> ranges;
    for (const double value : eta) ranges.push_back({value, value});
    std::vector<double> change(3 * site.drivers->months.size(), 1e6);
    tabulate_effect(site, {}, *room, ranges).apply({}, eta, change);
    for (double& value : change) value -= 1e6;
    return std::vector<double>(change.begin(), change.begin() + 12);
  };
  // Its heat makes the fans run more in summer and less in winter.
  for (const double kWh_day : electricity(false)) EXPECT_NEAR(kWh_day, 0.0, 0.05 * 480.0);
  const std::vector<double> begun = electricity(true);
  EXPECT_LT(begun[1], -100.0);
  EXPECT_GT(begun[9], 100.0);
  EXPECT_NEAR(begun[9] - begun[1], 480.0, 25.0) << "20 kW, day and night";
}

TEST(MonthlyEffect, IsExactAtItsNodes) {
  const SiteProblem site = sample_site(3);
  const CandidateList list = list_candidates(site);
  const auto leak = std::ranges::find_if(
      list.candidates, [&](const Candidate& c) { return c.key(site) == "steam_trap_leak"; });
  ASSERT_NE(leak, list.candidates.end());
  const std::vector<ParameterRange> range{{1.0, 5.0}};
  std::vector<double> tabulated = hourly_sum(site, nullptr);
  tabulate_effect(site, {}, *leak, range).apply({}, std::vector{3.0}, tabulated);
  const auto exact = hourly_sum(site, alteration_of(*leak, site.facts(), std::vector{3.0}).get());
  for (std::size_t k = 0; k < exact.size(); ++k) EXPECT_NEAR(tabulated[k], exact[k], 1e-9);
}

/// Rows: two meters of two months; grid: two values of each of two parameters.
MonthlyEffect small_effect() {
  Eigen::ArrayXXd table(4, 4);
  table << 0, 1, 10, 11,  //
      0, 2, 20, 22,       //
      0, 0, 0, 0,         //
      -9, -9, -9, -9;
  return {{{0.0, 1.0}, {0.0, 1.0}}, -1, table, 2};
}

TEST(MonthlyEffect, IsLinearBetweenItsNodesAndLevelBeyond) {
  const MonthlyEffect effect = small_effect();
  std::vector<double> meters(4, 100.0);
  effect.apply({}, std::vector{0.5, 0.25}, meters);
  EXPECT_EQ(meters, (std::vector{103.0, 106.0, 100.0, 91.0}));
  std::vector<double> beyond(4, 100.0);
  effect.apply({}, std::vector{-3.0, 7.0}, beyond);
  EXPECT_EQ(beyond, (std::vector{110.0, 120.0, 100.0, 91.0}));
}

TEST(MonthlyEffect, TakesNoMeterBelowZero) {
  std::vector<double> meters(4, 5.0);
  small_effect().apply({}, std::vector{0.0, 0.0}, meters);
  EXPECT_EQ(meters, (std::vector{5.0, 5.0, 5.0, 0.0}));
}

TEST(MonthlyEffect, OfSomeMonthsIsThatOfTheWholeThere) {
  const MonthlyEffect second = small_effect().in_months(std::vector{1});
  std::vector<double> meters(2, 100.0);
  second.apply({}, std::vector{1.0, 1.0}, meters);
  EXPECT_EQ(meters, (std::vector{122.0, 91.0}));
}

TEST(MonthlyEffect, OfARecordIsARatioOfItsMeterAlone) {
  Eigen::ArrayXXd ratios(2, 1);
  ratios << 2.0, 0.5;
  const MonthlyEffect effect{{{1.0}}, 1, ratios, 2};
  std::vector<double> meters{10.0, 10.0, 10.0, 10.0};
  effect.apply({}, std::vector{1.0}, meters);
  EXPECT_EQ(meters, (std::vector{10.0, 10.0, 20.0, 5.0}));
}

// What a damper that is stuck open costs depends on the outdoor air it is meant to let in: one sd
// of it moves the effect by more than half, and to first order the table knows.
TEST(MonthlyEffect, FollowsTheModelsParameters) {
  const SiteProblem site = sample_site(12);
  const CandidateList list = list_candidates(site);
  const auto candidate = std::ranges::find_if(
      list.candidates, [&](const Candidate& c) { return c.key(site) == "damper_stuck_open"; });
  ASSERT_NE(candidate, list.candidates.end());
  const auto ranges = narrow_ranges(*candidate);
  const auto spreads = spreads_of(site.parameters);
  const std::vector<double> eta = inside(ranges, 0.5);
  const std::vector<double> theta{spreads[0].low, spreads[1].middle};
  const auto change_at = [&](const MonthlyEffect& effect) {
    auto meters = hourly_sum(site, nullptr, theta);
    const auto without = meters;
    effect.apply(theta, eta, meters);
    for (std::size_t k = 0; k < meters.size(); ++k) meters[k] -= without[k];
    return meters;
  };
  const auto with = hourly_sum(site, alteration_of(*candidate, site.facts(), eta).get(), theta);
  const auto without = hourly_sum(site, nullptr, theta);
  const auto follows = change_at(tabulate_effect(site, {}, *candidate, ranges, spreads));
  const auto stays = change_at(tabulate_effect(site, {}, *candidate, ranges));
  double size = 0.0;
  double following_error = 0.0;
  double staying_error = 0.0;
  for (std::size_t k = 0; k < with.size(); ++k) {
    const double exact = with[k] - without[k];
    size += exact * exact;
    following_error += (follows[k] - exact) * (follows[k] - exact);
    staying_error += (stays[k] - exact) * (stays[k] - exact);
  }
  EXPECT_GT(std::sqrt(staying_error / size), 0.5);
  EXPECT_LT(std::sqrt(following_error / size), 0.1);
}

/// Always says 100 kWh/day, times its only parameter.
class HundredModel final : public MonthlyModel {
 public:
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<HundredModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 1; }
  [[nodiscard]] int output_count() const override { return 2; }
  [[nodiscard]] int month_count() const override { return 2; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    std::ranges::fill(outputs, 100.0 * theta[0]);
  }
};

TEST(AlteredMonthlyModel, AddsEffectsAndAltersRecordsLast) {
  Eigen::ArrayXXd ratios(2, 2);
  ratios << 1.0, 2.0, 1.0, 2.0;
  AlteredMonthlyModel model{std::make_unique<HundredModel>(),
                            {MonthlyEffect{{{1.0, 2.0}}, 0, ratios, 2}, small_effect()}};
  ASSERT_EQ(model.parameter_count(), 4);
  const std::vector<double> theta_and_eta{1.0, 2.0, 1.0, 1.0};
  std::vector<double> outputs(4);
  model.clone()->evaluate(theta_and_eta, outputs);
  EXPECT_EQ(outputs, (std::vector{2 * 111.0, 2 * 122.0, 100.0, 91.0}));
}

}  // namespace
}  // namespace recald::diagnosis::monthly_effect_test
