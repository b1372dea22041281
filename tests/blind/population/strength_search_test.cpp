#include "tests/blind/population/strength_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::blind {
namespace {

TEST(StrengthSearch, FindsProportionalEffectsInTwoLooks) {
  const StrengthFound found = strength_for(0.04, 2.0, [](double s) { return 0.1 * s; });
  EXPECT_TRUE(found.attained);
  EXPECT_NEAR(found.strength, 0.4, 1e-12);
  EXPECT_EQ(found.evaluations, 2);
}

TEST(StrengthSearch, FindsEffectsThatSaturateGrowOrSetInLate) {
  const auto saturating = [](double s) { return 0.3 * (1.0 - std::exp(-20.0 * s)); };
  const auto growing = [](double s) { return 0.5 * s * s * s; };
  const auto late = [](double s) { return s < 0.6 ? 0.0 : s - 0.6; };
  for (const Visibility& visibility :
       {Visibility(saturating), Visibility(growing), Visibility(late)}) {
    const StrengthFound found = strength_for(0.05, 1.0, visibility);
    EXPECT_TRUE(found.attained);
    EXPECT_NEAR(found.reached, 0.05, 0.05 * 0.05);
    EXPECT_NEAR(visibility(found.strength), found.reached, 0.0);
  }
}

// Nothing for most of the way, then all at once: the secant alone would creep up from below.
TEST(StrengthSearch, BisectsWhereTheSecantCreeps) {
  const StrengthFound found = strength_for(0.02, 1.0, [](double s) { return std::pow(s, 12.0); });
  EXPECT_TRUE(found.attained);
  EXPECT_NEAR(found.strength, std::pow(0.02, 1.0 / 12.0), 0.01);
}

// As wind through cracks on a scale of square roots: three decades below the limit.
TEST(StrengthSearch, FindsRootsFarBelowTheLimit) {
  const StrengthFound found =
      strength_for(4.0, 3.0, [](double s) { return 120.0 * std::pow(s / 3.0, 0.4); });
  EXPECT_TRUE(found.attained);
  EXPECT_LE(found.evaluations, 7);
}

TEST(StrengthSearch, FollowsTheSignOfItsLimit) {
  const StrengthFound found = strength_for(0.02, -1.0, [](double s) { return std::abs(0.1 * s); });
  EXPECT_NEAR(found.strength, -0.2, 1e-12);
}

TEST(StrengthSearch, SaysWhenEvenTheLimitShowsTooLittle) {
  const StrengthFound found = strength_for(0.5, 1.0, [](double s) { return 0.1 * s; });
  EXPECT_FALSE(found.attained);
  EXPECT_EQ(found.strength, 1.0);
  EXPECT_EQ(found.evaluations, 1);
}

TEST(StrengthSearch, SaysWhenItJumpsOverTheTarget) {
  const StrengthFound found =
      strength_for(0.05, 1.0, [](double s) { return s < 0.5 ? 0.01 : 0.2; });
  EXPECT_FALSE(found.attained);
  EXPECT_LE(found.evaluations, 12);
}

}  // namespace
}  // namespace recald::blind
