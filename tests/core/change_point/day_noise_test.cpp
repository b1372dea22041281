#include "core/change_point/day_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::change_point::day_noise_test {
namespace {

TEST(AutoregressiveProducts, MeetTheDenseForm) {
  Rng rng{1, 0};
  const std::vector<int> days{3, 4, 5, 9, 10, 40, 41, 43};
  Eigen::MatrixXd parts(3, std::ssize(days));
  for (double& one : parts.reshaped()) one = rng.normal();
  Eigen::MatrixXd correlation(parts.cols(), parts.cols());
  for (Eigen::Index i = 0; i < parts.cols(); ++i) {
    for (Eigen::Index j = 0; j < parts.cols(); ++j) {
      correlation(i, j) = std::pow(
          0.6, std::abs(days[static_cast<std::size_t>(i)] - days[static_cast<std::size_t>(j)]));
    }
  }
  const Eigen::MatrixXd expected = parts * correlation * parts.transpose();
  EXPECT_TRUE(autoregressive_products(parts, days, 0.6).isApprox(expected, 1e-12));
  EXPECT_TRUE(autoregressive_products(parts, days, 0.0).isApprox(parts * parts.transpose(), 1e-12));
}

// About its own mean a month of 30 days shows (1 + rho) / 30 too little, 0.05 at 0.5.
TEST(LagOneCorrelation, IsNotBiasedByTheMonthsMeans) {
  constexpr int kSeries = 200;
  constexpr int kDays = 720;
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeries; ++seed) {
    Rng rng{seed, 0};
    std::vector<double> noise(kDays);
    std::vector<int> days(kDays);
    std::vector<int> blocks(kDays);
    double last = rng.normal();
    double of_month = 0.0;
    for (int i = 0; i < kDays; ++i) {
      const auto at = static_cast<std::size_t>(i);
      last = 0.5 * last + std::sqrt(0.75) * rng.normal();
      if (i % 30 == 0) of_month = rng.normal();
      days[at] = i;
      blocks[at] = i / 30;
      noise[at] = 0.5 * (last + of_month);
    }
    mean += lag_one_correlation(noise, days, blocks) / kSeries;
  }
  EXPECT_NEAR(mean, 0.5, 0.015);
}

TEST(LagOneCorrelation, PairsAreOfSuccessiveDays) {
  // Signs alternate from day to day, but every other day is missing: what is left all agrees, and
  // has no successive day.
  std::vector<double> noise;
  std::vector<int> days;
  for (int i = 0; i < 60; ++i) {
    noise.push_back(i < 30 ? 1.0 : -1.0);
    days.push_back(2 * i);
  }
  const std::vector<int> blocks(noise.size(), 0);
  EXPECT_EQ(lag_one_correlation(noise, days, blocks), 0.0);
}

TEST(ScatterByLevel, FollowsTheLevel) {
  Rng rng{2, 0};
  std::vector<double> levels;
  std::vector<double> residuals;
  for (int i = 0; i < 4000; ++i) {
    levels.push_back(rng.uniform(0.0, 100.0));
    residuals.push_back((1.0 + 0.2 * levels.back()) * rng.normal());
  }
  const ScatterByLevel scatter{levels, residuals, 1e-9};
  double ratio = 0.0;
  for (int level = 5; level < 100; level += 5)
    ratio += scatter.at(level) / (1.0 + 0.2 * level) / 19;
  EXPECT_NEAR(ratio, 1.0, 0.05);
  EXPECT_NEAR(scatter.at(90.0) / scatter.at(10.0), 19.0 / 3.0, 2.0);
  EXPECT_EQ(scatter.at(-50.0), scatter.at(-1.0));
  EXPECT_EQ(scatter.at(500.0), scatter.at(101.0));
}

TEST(ScatterByLevel, OutliersMoveItLittle) {
  Rng rng{3, 0};
  std::vector<double> levels(40, 10.0);
  std::vector<double> residuals;
  for (int i = 0; i < 40; ++i) residuals.push_back(rng.normal());
  const double clean = ScatterByLevel{levels, residuals, 1e-9}.at(10.0);
  for (int i = 0; i < 4; ++i) residuals[static_cast<std::size_t>(i)] = 1000.0;
  EXPECT_LT((ScatterByLevel{levels, residuals, 1e-9}.at(10.0)), 1.6 * clean);
}

TEST(ScatterByLevel, DaysOfOneLevelAreOneGroupAndFewJoinTheNext) {
  std::vector<double> levels(100, 1.0);
  levels.resize(130, 2.0);
  std::vector<double> residuals;
  for (int i = 0; i < 130; ++i) residuals.push_back(i % 2 == 0 ? 1.0 + i : -1.0 - i);
  const ScatterByLevel scatter{levels, residuals, 1e-9};
  EXPECT_EQ(scatter.at(1.0), scatter.at(2.0));
}

TEST(ScatterByLevel, IsNeverBelowTheLeast) {
  const std::vector<double> zeros(50, 0.0);
  EXPECT_EQ((ScatterByLevel{zeros, zeros, 0.25}.at(0.0)), 0.25);
}

TEST(OutlierWeight, IsFullTo3AndNothingFrom6) {
  EXPECT_EQ(outlier_weight(0.0), 1.0);
  EXPECT_EQ(outlier_weight(-3.0), 1.0);
  EXPECT_NEAR(outlier_weight(4.5), 0.5625, 1e-15);  // (1 - 0.25)^2
  EXPECT_EQ(outlier_weight(-4.5), outlier_weight(4.5));
  EXPECT_LE(outlier_weight(6.0), 1e-6);
  EXPECT_GT(outlier_weight(1e9), 0.0);
}

}  // namespace
}  // namespace recald::change_point::day_noise_test
