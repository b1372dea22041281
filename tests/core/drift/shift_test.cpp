#include "core/drift/shift.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/random/rng.hpp"

namespace recald::drift {
namespace {

Eigen::VectorXd normals(Eigen::Index count, double mean, double sd, std::uint64_t seed) {
  Rng rng{seed};
  Eigen::VectorXd draws(count);
  for (double& draw : draws) draw = mean + sd * rng.normal();
  return draws;
}

TEST(Shift, OfNormalsIsTheClosedForm) {
  const Shift shift =
      shift_between(normals(40'000, 0.0, 1.0, 1), normals(40'000, 3.0, 2.0, 2), 25.0);
  EXPECT_NEAR(shift.standardised, 3.0 / std::sqrt(5.0), 0.02);
  const double overlap = std::sqrt(2.0 * 2.0 / 5.0) * std::exp(-0.25 * 9.0 / 5.0);
  EXPECT_NEAR(shift.hellinger, std::sqrt(1.0 - overlap), 0.01);
  EXPECT_NEAR(shift.increased, 0.5 * std::erfc(-3.0 / std::sqrt(5.0) / std::sqrt(2.0)), 0.01);
}

TEST(Shift, WassersteinOfAMovedSampleIsTheMove) {
  const Eigen::VectorXd then = normals(777, 5.0, 1.0, 3);
  EXPECT_NEAR(shift_between(then, then.array() + 2.5, 9.0).wasserstein, 2.5, 1e-12);
  EXPECT_NEAR(shift_between(then.array() + 2.5, then, 9.0).wasserstein, 2.5, 1e-12);
}

TEST(Shift, NumbersOfDrawsMayDiffer) {
  const Shift shift =
      shift_between(Eigen::Vector2d{0.0, 1.0}, Eigen::Vector4d{0.0, 0.0, 1.0, 1.0}, 1.0);
  EXPECT_NEAR(shift.wasserstein, 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(shift.increased, 0.5);
}

TEST(Shift, OfNothingIsNothing) {
  const Eigen::VectorXd draws = normals(500, 1.0, 0.3, 4);
  const Shift shift = shift_between(draws, draws, 4.0);
  EXPECT_EQ(shift.standardised, 0.0);
  EXPECT_EQ(shift.wasserstein, 0.0);
  EXPECT_NEAR(shift.hellinger, 0.0, 1e-7);
  EXPECT_EQ(shift.pvalue, 1.0);
}

// A truth from the prior, two samples of months that say little or much of it, their posteriors.
TEST(Shift, WhereNothingMovesOneInTwentyAtMostIsBelowFivePercent) {
  constexpr int kWorlds = 2'000;
  for (const double error_sd : {0.3, 1.0, 3.0}) {
    Rng rng{5};
    const double variance = 1.0 / (1.0 + 1.0 / (error_sd * error_sd));
    int small = 0;
    int beyond_naive = 0;
    for (int world = 0; world < kWorlds; ++world) {
      const double truth = rng.normal();
      const auto posterior = [&] {
        const double mean = variance / (error_sd * error_sd) * (truth + error_sd * rng.normal());
        return normals(400, mean, std::sqrt(variance), 1'000 + rng.next());
      };
      const Eigen::VectorXd then = posterior();
      const Shift shift = shift_between(then, posterior(), 1.0);
      small += shift.pvalue < 0.05;
      beyond_naive += std::abs(shift.standardised) > 1.96;
    }
    // 100 expected at most, four standard errors of the binomial.
    EXPECT_LE(small, 0.05 * kWorlds + 39) << error_sd;
    EXPECT_GE(small, 20) << error_sd;
    EXPECT_LE(beyond_naive, small) << error_sd;  // what the sds alone would say is modest
  }
}

TEST(Shift, WhatMovedByFourErrorsIsNoChance) {
  const Shift shift = shift_between(normals(400, 0.0, 0.3, 6), normals(400, 1.7, 0.3, 7), 1.0);
  EXPECT_LT(shift.pvalue, 0.001);
}

}  // namespace
}  // namespace recald::drift
