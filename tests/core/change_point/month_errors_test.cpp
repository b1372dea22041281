#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/change_point/regression.hpp"
#include "tests/core/change_point/simulated_meter.hpp"

namespace recald::change_point::month_errors_test {
namespace {

// A month's error of half a day's sd: the sd seen of a day holds both, so its square is 0.25 / 1.25
// of that sd's.
TEST(MonthErrors, TheVarianceOfMonthsIsFound) {
  constexpr int kSeeds = 60;
  SimulatedMeter meter = meter_with(curve_3p_heating());
  double with = 0.0;
  double without = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Rng rng{seed, 0};
    meter.month_sd_kWh = 0.5 * meter.day_sd_kWh;
    const auto moving = fit_regression(simulate(meter, 1096, rng));
    meter.month_sd_kWh = 0.0;
    const auto still = fit_regression(simulate(meter, 1096, rng));
    ASSERT_TRUE(moving.has_value() && still.has_value());
    with += moving->month_variance / kSeeds;
    without += still->month_variance / kSeeds;
  }
  EXPECT_NEAR(with, 0.20, 0.03);
  EXPECT_LT(without, 0.03);
}

TEST(MonthErrors, TheCovarianceOfTheParametersIsOne) {
  Rng rng{5, 0};
  SimulatedMeter meter = meter_with(curve_5p());
  meter.month_sd_kWh = 20.0;
  const auto fit = fit_regression(simulate(meter, 731, rng));
  ASSERT_TRUE(fit.has_value());
  const Eigen::MatrixXd& covariance = fit->parameter_covariance;
  ASSERT_EQ(covariance.rows(), 7);  // three base loads, two slopes, two balance temperatures
  EXPECT_EQ(covariance, covariance.transpose());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).eigenvalues()(0), 0.0);
}

// The 95 % quantiles of Student's t with 23 degrees of freedom and of the normal: 1.7139, 1.6449.
TEST(MonthErrors, BandsAreWiderWhereFewMonthsShowTheScale) {
  Rng rng{6, 0};
  const auto fit = fit_regression(simulate(meter_with(curve_5p()), 730, rng));
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->widening, std::pow(1.7139 / 1.6449, 2), 1e-3);
}

}  // namespace
}  // namespace recald::change_point::month_errors_test
