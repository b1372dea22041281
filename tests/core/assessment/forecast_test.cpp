#include "core/assessment/forecast.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/random/rng.hpp"

namespace recald::assessment::forecast_test {
namespace {

Forecast normal(double mean, double sd) {
  return {Eigen::VectorXd::Constant(1, mean), Eigen::VectorXd::Constant(1, sd),
          Eigen::VectorXd::Ones(1)};
}

/// Two hills of unequal weight.
Forecast hills() {
  Forecast forecast;
  forecast.means = Eigen::Vector2d{10.0, 20.0};
  forecast.sds = Eigen::Vector2d{1.0, 3.0};
  forecast.weights = Eigen::Vector2d{0.25, 0.75};
  return forecast;
}

TEST(Forecast, ANormalIsANormal) {
  const Forecast forecast = normal(50.0, 4.0);
  EXPECT_DOUBLE_EQ(forecast.mean(), 50.0);
  EXPECT_DOUBLE_EQ(forecast.sd(), 4.0);
  EXPECT_NEAR(forecast.quantile(0.975), 50.0 + 4.0 * 1.959963984540054, 1e-7);
  const Surprise surprise = surprise_of(forecast, 58.0);
  EXPECT_NEAR(surprise.standardised, 2.0, 1e-9);
  EXPECT_NEAR(surprise.pit, 0.9772498680518208, 1e-12);
  EXPECT_NEAR(surprise.log_score, -2.0 - std::log(4.0) - 0.5 * std::log(2.0 * std::numbers::pi),
              1e-12);
}

// sd (z (2 Phi(z) - 1) + 2 phi(z) - 1 / sqrt(pi)), Gneiting and Raftery (2007), eq. (5) after (20).
TEST(Forecast, CrpsOfANormalIsTheClosedForm) {
  for (const double z : {0.0, 0.7, -2.0, 12.0}) {
    const double phi = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    const double cdf = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    const double expected =
        3.0 * (z * (2.0 * cdf - 1.0) + 2.0 * phi - 1.0 / std::sqrt(std::numbers::pi));
    EXPECT_NEAR(surprise_of(normal(5.0, 3.0), 5.0 + 3.0 * z).crps, expected, 1e-3) << z;
  }
}

TEST(Forecast, AMixtureHasItsMoments) {
  EXPECT_DOUBLE_EQ(hills().mean(), 17.5);
  // Within: 0.25 + 0.75 * 9; between: 0.25 * 0.75 * 10^2.
  EXPECT_NEAR(hills().sd(), std::sqrt(7.0 + 18.75), 1e-12);
  EXPECT_NEAR(hills().cdf(hills().quantile(0.3)), 0.3, 1e-8);
}

TEST(Forecast, PitsOfItsOwnDrawsAreUniform) {
  Rng rng{3};
  constexpr int kDraws = 4000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const bool is_first = rng.uniform() < 0.25;
    const double y = is_first ? 10.0 + rng.normal() : 20.0 + 3.0 * rng.normal();
    const double u = surprise_of(hills(), y).standardised;
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
}

TEST(Forecast, AnImpossibleMonthIsSurprisingAndFinite) {
  const Surprise surprise = surprise_of(normal(5.0, 0.1), 5000.0);
  EXPECT_GT(surprise.standardised, 7.0);
  EXPECT_TRUE(std::isfinite(surprise.standardised));
  EXPECT_TRUE(std::isfinite(surprise.log_score));
  EXPECT_NEAR(surprise.crps, 4995.0, 20.0);
  EXPECT_LT(surprise_of(normal(5.0, 0.1), -5000.0).standardised, -7.0);
}

}  // namespace
}  // namespace recald::assessment::forecast_test
