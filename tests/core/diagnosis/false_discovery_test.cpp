#include "core/diagnosis/evidence/false_discovery.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace recald::diagnosis::false_discovery_test {
namespace {

// By hand: m = 4, c = 1 + 1/2 + 1/3 + 1/4 = 25/12, m c = 25/3. Sorted 0.001, 0.01, 0.02, 0.5 give
// 0.008333, 0.041667, 0.055556, 1.041667; all already rise. R: p.adjust(p, "BY").
TEST(BenjaminiYekutieli, HandCase) {
  const std::vector<double> p{0.02, 0.001, 0.5, 0.01};
  const std::vector<double> adjusted = benjamini_yekutieli(p);
  EXPECT_NEAR(adjusted[0], 0.02 * 25.0 / 9.0, 1e-15);
  EXPECT_NEAR(adjusted[1], 0.001 * 25.0 / 3.0, 1e-15);
  EXPECT_NEAR(adjusted[2], 1.0, 1e-15);
  EXPECT_NEAR(adjusted[3], 0.01 * 25.0 / 6.0, 1e-15);
}

// A step-up test: the larger of two near p-values can carry the smaller one.
TEST(BenjaminiYekutieli, TakesTheLeastOfAllLargerOnes) {
  const std::vector<double> adjusted = benjamini_yekutieli(std::vector<double>{0.03, 0.031});
  EXPECT_NEAR(adjusted[0], 0.031 * 1.5, 1e-15);
  EXPECT_NEAR(adjusted[1], 0.031 * 1.5, 1e-15);
  EXPECT_TRUE(benjamini_yekutieli({}).empty());
}

// R: p.adjust(c(0.02, 0.001, 0.5, 0.01), "holm") = 0.04 0.004 0.5 0.03
TEST(Holm, HandCase) {
  const std::vector<double> adjusted = holm(std::vector<double>{0.02, 0.001, 0.5, 0.01});
  const std::vector<double> expected{0.04, 0.004, 0.5, 0.03};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-15);
  // Never falls again, never above 1.
  const std::vector<double> flat = holm(std::vector<double>{0.4, 0.45, 0.9});
  EXPECT_EQ(flat, (std::vector<double>{1.0, 1.0, 1.0}));
}

TEST(Findings, AFamilyStaysShutWithoutItsOmnibusTest) {
  const std::vector<double> bins{1e-6, 0.4, 0.001};
  const std::vector<TestFamily> families{{0.03, bins}, {0.001, bins}, {0.9, {}}};
  const auto found = findings(families);
  EXPECT_EQ(found[0], (std::vector<bool>{false, false, false}));  // Holm: 2 x 0.03
  EXPECT_EQ(found[1], (std::vector<bool>{true, false, true}));
  EXPECT_TRUE(found[2].empty());
}

}  // namespace
}  // namespace recald::diagnosis::false_discovery_test
