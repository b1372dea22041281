#include "core/calibration/covariance/hyper_prior.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace recald::calibration::hyper_prior_test {
namespace {

using ::testing::HasSubstr;

TEST(GammaPrior, DensityMomentsAndQuantiles) {
  const GammaPrior gamma{2.0, 0.5};
  // b^2 x exp(-b x) at x = 3: 0.25 * 3 * exp(-1.5).
  EXPECT_NEAR(gamma.log_density(3.0), std::log(0.75) - 1.5, 1e-14);
  EXPECT_EQ(gamma.mean(), 4.0);
  EXPECT_EQ(gamma.variance(), 8.0);
  // Median of Gamma(2, 1) is 1.678346990016661 (solution of (1 + x) exp(-x) = 1/2).
  EXPECT_NEAR(gamma.quantile(0.5), 2.0 * 1.678346990016661, 1e-12);
  EXPECT_EQ(gamma.log_density(0.0), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(gamma.log_density(-1.0), -std::numeric_limits<double>::infinity());
}

// The reading of "20 % discrepancy, 5 % error" as standard deviations on the [0, 1] scale:
// profile `seed` has sd of delta 0.16-0.27 and of epsilon 0.040-0.068 between its 5 % and 95 %.
TEST(HyperPrior, TheSeedsProfileMeansTwentyAndFivePerCent) {
  const HyperPrior prior = make_hyper_prior(HyperPriorProfile::seed, 1.0);
  const auto sd = [](double precision) { return 1.0 / std::sqrt(precision); };
  EXPECT_NEAR(sd(prior.discrepancy_precision.quantile(0.95)), 0.16, 0.005);
  EXPECT_NEAR(sd(prior.discrepancy_precision.quantile(0.05)), 0.27, 0.005);
  EXPECT_NEAR(sd(prior.error_precision.quantile(0.95)), 0.040, 0.0005);
  EXPECT_NEAR(sd(prior.error_precision.quantile(0.05)), 0.068, 0.0005);
}

TEST(HyperPrior, ScaledIsThePublishedOneOnUnitVariance) {
  const HyperPrior scaled = make_hyper_prior(HyperPriorProfile::scaled, 0.028);
  EXPECT_NEAR(scaled.discrepancy_precision.rate, 0.0084, 1e-15);
  EXPECT_NEAR(scaled.error_precision.rate, 0.00084, 1e-15);
  const HyperPrior published = make_hyper_prior(HyperPriorProfile::stan2018, 0.028);
  EXPECT_EQ(published.discrepancy_precision, (GammaPrior{10.0, 0.3}));
  EXPECT_EQ(published.error_precision, (GammaPrior{10.0, 0.03}));
}

TEST(BetaPrior, LogDensityAgreesWithTheDefinitionWhereADoubleCanHoldRho) {
  const BetaPrior prior{1.0, 0.3};
  for (const double rho : {0.001, 0.25, 0.6, 0.99, 1.0 - 1e-9}) {
    const double z = std::log(rho) - std::log1p(-rho);
    EXPECT_NEAR(prior.log_density_at_logit(z), std::log(0.3) - 0.7 * std::log1p(-rho), 1e-7);
  }
  // rho rounds to 1 here; the density goes on growing by 0.7 a unit of z.
  EXPECT_NEAR(prior.log_density_at_logit(101.0) - prior.log_density_at_logit(100.0), 0.7, 1e-12);
}

TEST(BetaPrior, QuantilesAreThoseOfTheClosedForm) {
  const BetaPrior prior{1.0, 0.3};  // F(rho) = 1 - (1 - rho)^0.3
  EXPECT_NEAR(prior.quantile(0.5), 1.0 - std::pow(0.5, 1.0 / 0.3), 1e-12);
  for (const double u : {0.01, 0.5, 0.99, 0.99999, 1.0 - 1e-12}) {
    const double log_rest = std::log1p(-u) / 0.3;  // log(1 - rho)
    const double z = std::log1p(-std::exp(log_rest)) - log_rest;
    EXPECT_NEAR(prior.logit_quantile(u), z, 1e-3 + 1e-9 * z) << u;
  }
  EXPECT_TRUE(std::isfinite(prior.logit_quantile(1.0 - 0x1.0p-53)));
}

// beta = -4 ln rho = -4 ln(1 - v^(1/0.3)) for uniform v; midpoint rule.
TEST(BetaPrior, MomentsOfBetaMatchQuadrature) {
  const BetaPrior prior{1.0, 0.3};
  constexpr int n = 2'000'000;
  double mean = 0.0;
  double square = 0.0;
  for (int i = 0; i < n; ++i) {
    const double beta = -4.0 * std::log1p(-std::pow((i + 0.5) / n, 1.0 / 0.3));
    mean += beta / n;
    square += beta * beta / n;
  }
  EXPECT_NEAR(prior.beta_mean(), mean, 1e-4);
  EXPECT_NEAR(prior.beta_variance(), square - mean * mean, 5e-3);
}

TEST(BetaPrior, BetaAndLogitInvertEachOther) {
  for (const double z : {-30.0, -1.0, 0.0, 2.0, 30.0, 300.0}) {
    EXPECT_NEAR(logit_from_beta(beta_from_logit(z)), z, 1e-12 * std::max(1.0, std::abs(z)));
  }
  EXPECT_TRUE(std::isinf(logit_from_beta(0.0)));
}

TEST(HyperPrior, ProfilesByName) {
  EXPECT_EQ(parse_hyper_prior_profile("scaled").value(), HyperPriorProfile::scaled);
  EXPECT_EQ(parse_hyper_prior_profile("seed").value(), HyperPriorProfile::seed);
  EXPECT_EQ(parse_hyper_prior_profile("tight").value(), HyperPriorProfile::tight);
  EXPECT_EQ(parse_hyper_prior_profile("stan2018").value(), HyperPriorProfile::stan2018);
  EXPECT_EQ(parse_hyper_prior_profile("wide").value(), HyperPriorProfile::stan2018);
  const auto unknown = parse_hyper_prior_profile("flat");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().code, ErrorCode::invalid_value);
  EXPECT_THAT(unknown.error().message, HasSubstr("'flat'"));
}

TEST(HyperPrior, ValuesOfOnesOwnHaveToBePositive) {
  EXPECT_TRUE(make_custom_hyper_prior({10, 0.3}, {10, 0.03}, {1, 0.3}).has_value());
  const auto rate = make_custom_hyper_prior({10, 0.0}, {10, 0.03}, {1, 0.3});
  ASSERT_FALSE(rate.has_value());
  EXPECT_THAT(rate.error().message, HasSubstr("[discrepancy]"));
  EXPECT_FALSE(make_custom_hyper_prior({10, 0.3}, {-1, 0.03}, {1, 0.3}).has_value());
  EXPECT_FALSE(make_custom_hyper_prior({10, 0.3}, {10, 0.03}, {1, std::nan("")}).has_value());
}

}  // namespace
}  // namespace recald::calibration::hyper_prior_test
