#include "core/savings/year_weights.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace recald::savings::year_weights_test {
namespace {

using metering::Month;

std::vector<Month> months_from(Month first, int count) {
  std::vector<Month> months;
  for (int i = 0; i < count; ++i) months.push_back(first + std::chrono::months{i});
  return months;
}

constexpr Month kStart{std::chrono::year{2021}, std::chrono::January};

TEST(YearWeights, MonthsThatAreThereTwiceCountHalf) {
  const YearWeights weights = year_weights(months_from(kStart, 18));
  EXPECT_TRUE(weights.is_year);
  EXPECT_DOUBLE_EQ(weights.days.sum(), 365.0);
  EXPECT_DOUBLE_EQ(weights.days(0), 15.5);   // January, again in 2022
  EXPECT_DOUBLE_EQ(weights.days(11), 31.0);  // December, once
}

TEST(YearWeights, LessThanAYearIsTheSumOfItsMonths) {
  const YearWeights weights = year_weights(months_from(kStart, 11));
  EXPECT_FALSE(weights.is_year);
  EXPECT_DOUBLE_EQ(weights.days.sum(), 334.0);
}

}  // namespace
}  // namespace recald::savings::year_weights_test
