#include "core/population/population.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <ostream>

#include "tests/core/population/sample_fleet.hpp"
#include "tests/support/seed.hpp"

namespace recald::population {
namespace {

using ::testing::HasSubstr;

const Prior kAirflow{0.3, 1.0, 1.2};

// Worked by hand: variance 0.64 and median 0.3 are a likelihood of precision 0.5625 at 0.3 / 0.36.
TEST(PosteriorEvidence, IsThePosteriorWithoutItsPrior) {
  const SitePosterior site{kAirflow.at_score(0.3 - kQ95 * 0.8).value, kAirflow.at_score(0.3).value,
                           kAirflow.at_score(0.3 + kQ95 * 0.8).value, kAirflow};
  const auto evidence = evidence_of(std::vector{site});
  ASSERT_EQ(evidence.size(), 1U);
  EXPECT_NEAR(evidence[0].score, 0.3 / 0.36, 1e-6);
  EXPECT_NEAR(evidence[0].sd, 1.0 / 0.75, 1e-6);
}

TEST(PosteriorEvidence, OfAPosteriorThatIsItsPriorOrWiderIsNone) {
  const SitePosterior prior_itself{kAirflow.quantile(0.05), kAirflow.quantile(0.5),
                                   kAirflow.quantile(0.95), kAirflow};
  const SitePosterior wider{kAirflow.quantile(0.01), kAirflow.quantile(0.7),
                            kAirflow.quantile(0.99), kAirflow};
  const SitePosterior at_an_end{1.2, 1.2, 1.2, kAirflow};
  EXPECT_TRUE(evidence_of(std::vector{prior_itself, wider, at_an_end}).empty());
}

TEST(Population, NeedsFiveSitesAndHalfOfAllToSaySomething) {
  Rng rng(1);
  Fleet fleet = draw_fleet(4, 0.0, 0.3, 0.5, kAirflow, rng);
  const SitePosterior silent{kAirflow.quantile(0.05), kAirflow.quantile(0.5),
                             kAirflow.quantile(0.95), kAirflow};
  for (int i = 0; i < 5; ++i) fleet.sites.push_back(silent);
  const auto none = estimate_population(fleet.sites);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::not_enough_data);
  EXPECT_THAT(none.error().message, HasSubstr("4 of 9 calibrations"));
  fleet.sites.push_back(posterior_of({0.1, 0.5}, kAirflow));
  const auto some = estimate_population(fleet.sites);
  ASSERT_TRUE(some);
  EXPECT_EQ(some->sites, 5);
  fleet.sites.push_back(silent);
  const auto less_than_half = estimate_population(fleet.sites);
  ASSERT_FALSE(less_than_half);
  EXPECT_THAT(less_than_half.error().message, HasSubstr("5 of 11"));
  EXPECT_THAT(less_than_half.error().message, HasSubstr("at least 6 are needed"));
}

TEST(Population, OfManyGoodSitesIsWhatTheyWereDrawnFrom) {
  const testing::Seed seed;
  Rng rng(seed.value());
  const Fleet fleet = draw_fleet(300, 0.8, 0.4, 0.5, kAirflow, rng);
  const auto population = estimate_population(fleet.sites);
  ASSERT_TRUE(population);
  EXPECT_NEAR(population->location, 0.8, 0.15);  // 0.04 of sd
  EXPECT_LT(population->location_sd, 0.08);
  EXPECT_NEAR(population->spread, 0.4, 0.15);
  EXPECT_NEAR(population->quantile(0.5), 0.8, 0.15);
  EXPECT_NEAR(population->quantile(0.95), 0.8 + 0.4 * 2.132, 0.3);  // of t with 4 degrees
}

struct Kind {
  const char* name;
  int sites;
  double sd;  ///< Of the evidence.
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

class Coverage : public ::testing::TestWithParam<Kind> {};

// Populations from the hyper-priors: then the predictive is right by construction, if the grid, the
// t and the removal of priors are.
TEST_P(Coverage, OfFurtherBuildingsIsAsSaid) {
  const testing::Seed seed;
  constexpr int kFleets = 400;
  Rng rng(seed.value());
  int within_90 = 0;
  int within_50 = 0;
  for (int i = 0; i < kFleets; ++i) {
    const double location = std::sqrt(0.5) * rng.normal();
    const double spread = 0.5 * std::fabs(rng.normal());
    const Fleet fleet =
        draw_fleet(GetParam().sites, location, spread, GetParam().sd, kAirflow, rng);
    const auto population = estimate_population(fleet.sites);
    ASSERT_TRUE(population);
    const double further = location + spread * draw_t(rng);
    const auto is_within = [&](double tail) {
      return population->quantile(tail) <= further && further <= population->quantile(1.0 - tail);
    };
    within_90 += static_cast<int>(is_within(0.05));
    within_50 += static_cast<int>(is_within(0.25));
  }
  // Of 400 at the nominal rate all but one in ten thousand draws lie between these.
  const boost::math::binomial_distribution<> of_90(kFleets, 0.9);
  const boost::math::binomial_distribution<> of_50(kFleets, 0.5);
  for (const auto& [within, nominal] : {std::pair{within_90, of_90}, std::pair{within_50, of_50}}) {
    EXPECT_GE(within, boost::math::quantile(nominal, 5e-5));
    EXPECT_LE(within, boost::math::quantile(nominal, 1.0 - 5e-5));
  }
}

INSTANTIATE_TEST_SUITE_P(Fleets, Coverage,
                         ::testing::Values(Kind{"Five", 5, 0.7}, Kind{"SharpSites", 12, 0.3},
                                           Kind{"WeakSites", 24, 1.5}),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Population, IsHardlyMovedByOneStranger) {
  const testing::Seed seed;
  Rng rng(seed.value());
  Fleet fleet = draw_fleet(15, -0.5, 0.2, 0.4, kAirflow, rng);
  const auto without = estimate_population(fleet.sites);
  fleet.sites.push_back(posterior_of({4.0, 0.4}, kAirflow));
  const auto with = estimate_population(fleet.sites);
  ASSERT_TRUE(without && with);
  EXPECT_LT(std::fabs(with->location - without->location), 0.1);  // the mean of 16 would: 0.28
  EXPECT_LT(with->quantile(0.95), 1.5);                           // by moments: 1.9
}

TEST(Population, DoesNotDependOnTheOrderOfSites) {
  const testing::Seed seed;
  Rng rng(seed.value());
  Fleet fleet = draw_fleet(9, 0.3, 0.4, 0.8, kAirflow, rng);
  const auto forth = estimate_population(fleet.sites);
  std::ranges::reverse(fleet.sites);
  const auto back = estimate_population(fleet.sites);
  ASSERT_TRUE(forth && back);
  for (const double p : {0.05, 0.5, 0.95}) EXPECT_NEAR(forth->quantile(p), back->quantile(p), 1e-9);
}

// Five of them know a little together, and a mixture of t's has longer tails and narrower shoulders
// than the normal of its variance.
TEST(Population, OfSitesThatKnowNextToNothingIsAboutThePrior) {
  const std::vector<SitePosterior> sites(5, posterior_of({0.0, 2.9}, kAirflow));
  const auto population = estimate_population(sites);
  ASSERT_TRUE(population);
  EXPECT_NEAR(population->quantile(0.05), -kQ95, 0.3);
  EXPECT_NEAR(population->quantile(0.5), 0.0, 0.02);
  EXPECT_NEAR(population->quantile(0.95), kQ95, 0.3);
}

}  // namespace
}  // namespace recald::population
