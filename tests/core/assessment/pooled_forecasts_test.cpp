#include "core/assessment/pooled_forecasts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/absent.hpp"

namespace recald::assessment::pooled_forecasts_test {
namespace {

Forecast normal(double mean, double sd) {
  return {Eigen::VectorXd::Constant(1, mean), Eigen::VectorXd::Constant(1, sd),
          Eigen::VectorXd::Ones(1)};
}

OutputForecasts always(double mean, double sd, int months) {
  OutputForecasts all;
  for (int i = 0; i < months; ++i) {
    all.months.emplace_back(normal(mean, sd));
    all.blocks.emplace_back(normal(mean, sd));
  }
  all.unseen_mean = normal(mean, sd);
  return all;
}

TEST(StackingWeight, IsAHalfOfTwoThatAreAlike) {
  const std::vector<double> same{-1.0, -3.0, -0.5};
  EXPECT_NEAR(stacking_weight(same, same), 0.5, 1e-12);
  EXPECT_NEAR(stacking_weight({}, {}), 0.5, 1e-12);
}

TEST(StackingWeight, GoesToTheBetterOne) {
  const std::vector<double> good(10, 0.0);
  const std::vector<double> bad(10, -50.0);
  EXPECT_NEAR(stacking_weight(good, bad), 1.0, 1e-6);
  EXPECT_NEAR(stacking_weight(bad, good), 0.0, 1e-6);
}

// Each alone excludes some of the months: neither does without the other.
TEST(StackingWeight, ShareWhatEachDoesBest) {
  const std::vector<double> a{0.0, 0.0, 0.0, -30.0};
  const std::vector<double> b{-30.0, -30.0, -30.0, 0.0};
  EXPECT_NEAR(stacking_weight(a, b), 0.75, 1e-9);
}

TEST(Pool, IsAMixtureByTheMonthsLeftOut) {
  const std::vector<double> measured{10.0, 10.0, 10.0, 10.0, kAbsent};
  double weight = 0.0;
  const OutputForecasts both = pool(always(10.0, 1.0, 5), always(14.0, 1.0, 5), measured, weight);
  EXPECT_GT(weight, 0.8);
  EXPECT_NEAR(both.months[4]->mean(), weight * 10.0 + (1.0 - weight) * 14.0, 1e-12);
  EXPECT_NEAR(both.unseen_mean->mean(), both.months[4]->mean(), 1e-12);
  EXPECT_NEAR(both.months[4]->weights.sum(), 1.0, 1e-12);
}

TEST(Pool, WhatOneAloneForecastsStaysItsOwn) {
  OutputForecasts days = always(14.0, 1.0, 2);
  days.months[1].reset();
  days.unseen_mean.reset();
  double weight = 0.0;
  const OutputForecasts both =
      pool(always(10.0, 1.0, 2), days, std::vector<double>{10.0, kAbsent}, weight);
  EXPECT_NEAR(both.months[1]->mean(), 10.0, 1e-12);
  EXPECT_NEAR(both.unseen_mean->mean(), 10.0, 1e-12);
}

}  // namespace
}  // namespace recald::assessment::pooled_forecasts_test
