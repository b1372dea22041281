#include "core/model/prior_from_draws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace recald {
namespace {

std::vector<double> draws_of(const Prior& distribution) {
  std::vector<double> draws;
  for (int i = 0; i < 200; ++i) draws.push_back(distribution.quantile((i + 0.5) / 200.0));
  return draws;
}

TEST(PriorFromDraws, HasTheirMeanAndSpreadInTheOriginalSupport) {
  const Prior share = UniformPrior{0.0, 1.0};
  for (const auto& [location, sd] : {std::pair{0.5, 0.05}, {0.97, 0.05}, {0.02, 0.1}}) {
    const Prior posterior = TruncatedNormalPrior{location, sd, 0.0, 1.0};
    const Prior fitted = prior_from_draws(share, draws_of(posterior));
    EXPECT_NEAR(fitted.mean(), posterior.mean(), 0.01 * sd) << location;
    EXPECT_NEAR(std::sqrt(fitted.variance()), std::sqrt(posterior.variance()), 0.02 * sd);
    EXPECT_EQ(fitted.min(), 0.0);
    EXPECT_EQ(fitted.max(), 1.0);
  }
}

TEST(PriorFromDraws, KeepsALogNormalOne) {
  const Prior original = LogNormalPrior{2.0, 0.5};
  const Prior posterior = LogNormalPrior{3.0, 0.1};
  const Prior fitted = prior_from_draws(original, draws_of(posterior));
  EXPECT_EQ(fitted.name(), "log_normal");
  EXPECT_NEAR(fitted.mean(), posterior.mean(), 0.01);
  EXPECT_NEAR(fitted.variance(), posterior.variance(), 0.01);
}

TEST(PriorFromDraws, IsOneEvenWhereAllDrawsAreTheSame) {
  const Prior fitted = prior_from_draws(UniformPrior{0.0, 1.0}, std::vector{1.0, 1.0, 1.0});
  EXPECT_GT(fitted.mean(), 0.99);
  EXPECT_GT(fitted.variance(), 0.0);
}

// Draws that fill their support evenly have no normal with their moments; the widest is near.
TEST(PriorFromDraws, ComesNearAUniformPosterior) {
  const Prior even = UniformPrior{0.0, 1.0};
  const Prior fitted = prior_from_draws(even, draws_of(even));
  EXPECT_NEAR(fitted.mean(), 0.5, 0.01);
  EXPECT_NEAR(std::sqrt(fitted.variance()), std::sqrt(1.0 / 12.0), 0.02);
}

}  // namespace
}  // namespace recald
