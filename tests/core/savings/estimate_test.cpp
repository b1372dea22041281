#include "core/savings/estimate.hpp"

#include <gtest/gtest.h>

namespace recald::savings::estimate_test {
namespace {

TEST(Estimate, IsQuantilesAndTheShareThatSaves) {
  const Eigen::VectorXd draws = Eigen::VectorXd::LinSpaced(101, -20.0, 80.0).reverse();
  const Estimate estimate = estimate_of(draws);
  EXPECT_DOUBLE_EQ(estimate.mean, 30.0);
  EXPECT_DOUBLE_EQ(estimate.q05, -15.0);
  EXPECT_DOUBLE_EQ(estimate.q50, 30.0);
  EXPECT_DOUBLE_EQ(estimate.q95, 75.0);
  EXPECT_DOUBLE_EQ(estimate.probability_of_saving, 80.0 / 101.0);  // zero is no saving
}

TEST(Estimate, OfANormalHasItsQuantiles) {
  const Estimate estimate = normal_estimate(10.0, 4.0);
  EXPECT_NEAR(estimate.q05, 10.0 - 1.644854 * 4.0, 1e-5);
  EXPECT_NEAR(estimate.q95, 10.0 + 1.644854 * 4.0, 1e-5);
  EXPECT_NEAR(estimate.probability_of_saving, 0.993790, 1e-6);  // Phi(2.5)
}

// What saves most pays back soonest, and what may save nothing may never.
TEST(Estimate, PaybackTurnsTheIntervalAround) {
  const Payback payback = simple_payback(1200.0, {300.0, -10.0, 300.0, 600.0, 0.93});
  EXPECT_EQ(payback.q05_years, 2.0);
  EXPECT_EQ(payback.q50_years, 4.0);
  EXPECT_FALSE(payback.q95_years.has_value());
}

}  // namespace
}  // namespace recald::savings::estimate_test
