#include "core/population/learned_prior.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "tests/core/population/sample_fleet.hpp"
#include "tests/support/seed.hpp"

namespace recald::population {
namespace {

/// A predictive that is normal in scores.
Population normal_population(double location, double spread) {
  Population population{.sites = 10,
                        .location = location,
                        .location_sd = 0.0,
                        .spread = spread,
                        .scores = {},
                        .cumulative = {}};
  const boost::math::normal_distribution<> normal(location, spread);
  for (int i = -600; i <= 600; ++i) {
    population.scores.push_back(0.01 * i);
    population.cumulative.push_back(boost::math::cdf(normal, 0.01 * i));
  }
  return population;
}

TEST(LearnedPrior, OfAPopulationLikeThePriorIsThePrior) {
  for (const Prior& own : {Prior{0.3, 1.0, 1.2}, Prior{20.0, 24.0, 27.8}, Prior{0.0, 0.1, 1.0}}) {
    const Prior learned = learned_prior(normal_population(0.0, 1.0), own);
    const double range = own.max() - own.min();
    EXPECT_NEAR(learned.min(), own.min(), 0.01 * range);
    EXPECT_NEAR(learned.mode(), own.mode(), 0.02 * range);
    EXPECT_NEAR(learned.max(), own.max(), 0.01 * range);
  }
}

TEST(LearnedPrior, OfANarrowFleetHasItsQuantiles) {
  const Prior own{0.0, 1.0, 2.0};
  const Population population = normal_population(0.5, 0.3);
  const Prior learned = learned_prior(population, own);
  EXPECT_EQ(learned.name(), "triangular");
  EXPECT_NEAR(learned.quantile(0.5), own.at_score(0.5).value, 0.01);
  EXPECT_LE(learned.quantile(0.05), own.at_score(0.5 - kQ95 * 0.3).value + 1e-3);
  EXPECT_GE(learned.quantile(0.95), own.at_score(0.5 + kQ95 * 0.3).value - 1e-3);
  EXPECT_LT(learned.variance(), 0.2 * own.variance());
}

TEST(LearnedPrior, ScalesWithTheBuilding) {
  const Population population = normal_population(-0.6, 0.4);
  const Prior small = learned_prior(population, Prior{0.3, 1.0, 1.2});
  const Prior large = learned_prior(population, Prior{3.0, 10.0, 12.0});
  EXPECT_NEAR(large.min(), 10.0 * small.min(), 1e-6);
  EXPECT_NEAR(large.mode(), 10.0 * small.mode(), 1e-6);
  EXPECT_NEAR(large.max(), 10.0 * small.max(), 1e-6);
}

TEST(LearnedPrior, OfAFleetSpreadOverBothEndsIsThePrior) {
  const Prior own{0.3, 1.0, 1.2};
  EXPECT_EQ(learned_prior(normal_population(0.0, 3.0), own), own);
}

TEST(LearnedPrior, IsWithinThePriorAndNeverNarrowerThanThePopulation) {
  const testing::Seed seed;
  Rng rng(seed.value());
  for (int i = 0; i < 200; ++i) {
    const double min = rng.uniform(-1.0, 1.0);
    const double max = min + rng.uniform(0.1, 3.0);
    const Prior own{min, rng.uniform(min, max), max};
    const Fleet fleet = draw_fleet(5 + static_cast<int>(rng.below(20)), rng.normal(),
                                   rng.uniform(0.0, 0.8), rng.uniform(0.2, 2.0), own, rng);
    const auto population = estimate_population(fleet.sites);
    ASSERT_TRUE(population);
    const Prior learned = learned_prior(*population, own);
    EXPECT_GE(learned.min(), own.min());
    EXPECT_LE(learned.max(), own.max());
    if (learned == own) continue;
    double sum = 0.0;
    double squares = 0.0;
    constexpr int kValues = 400;
    for (int k = 0; k < kValues; ++k) {
      const double value = own.at_score(population->quantile((k + 0.5) / kValues)).value;
      sum += value;
      squares += value * value;
    }
    const double variance = squares / kValues - sum * sum / (1.0 * kValues * kValues);
    EXPECT_GE(learned.variance(), 0.999 * variance);
  }
}

}  // namespace
}  // namespace recald::population
