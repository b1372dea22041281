#include "core/statistics/expected_maximum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random/rng.hpp"
#include "tests/support/allocations.hpp"

namespace recald {
namespace {

TEST(ExpectedMaximum, WithoutNoiseIsTheMaximum) {
  EXPECT_EQ(expected_maximum(std::vector{3.0, 7.0, 5.0}, 0.0), 7.0);
}

TEST(ExpectedMaximum, OfOneValueIsTheValue) {
  EXPECT_NEAR(expected_maximum(std::vector{40.0}, 2.0), 40.0, 1e-5);
}

// Closed form of two, tables of thirty (Harter 1961).
TEST(ExpectedMaximum, OfEqualValuesIsKnown) {
  EXPECT_NEAR(expected_maximum(std::vector{4.0, 4.0}, 2.0), 4.0 + 2.0 / std::sqrt(std::numbers::pi),
              1e-5);
  EXPECT_NEAR(expected_maximum(std::vector<double>(30, 0.0), 1.0), 2.04276, 1e-4);
}

TEST(ExpectedMaximum, OneFarAboveTheOthersStands) {
  EXPECT_NEAR(expected_maximum(std::vector{100.0, 4.0}, 2.0), 100.0, 1e-5);
}

TEST(ExpectedMaximum, AgreesWithDrawsOfAMonth) {
  std::vector<double> month;
  for (int i = 0; i < 2880; ++i) {
    month.push_back(100.0 + 60.0 * std::sin(0.0654 * i) + 10.0 * std::sin(0.0021 * i));
  }
  Rng rng{11};
  double sum = 0.0;
  constexpr int kDraws = 400;
  for (int draw = 0; draw < kDraws; ++draw) {
    double largest = 0.0;
    for (const double value : month) largest = std::max(largest, value + 3.4 * rng.normal());
    sum += largest;
  }
  const double expected = expected_maximum(month, 3.4);
  EXPECT_NEAR(expected, sum / kDraws, 0.3);
  EXPECT_GT(expected, 1.03 * *std::ranges::max_element(month));
}

TEST(ExpectedMaximum, AllocatesNothing) {
  const std::vector<double> month(2880, 5.0);
  const long before = recald::testing::allocation_count();
  const double expected = expected_maximum(month, 0.3);
  EXPECT_EQ(recald::testing::allocation_count(), before);
  EXPECT_GT(expected, 6.0);
}

}  // namespace
}  // namespace recald
