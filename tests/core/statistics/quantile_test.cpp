#include "core/statistics/quantile.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace recald {
namespace {

// As R's quantile(1:4, p), whose default is type 7.
TEST(QuantileOfSorted, InterpolatesBetweenOrderStatistics) {
  const std::vector<double> sorted = {1.0, 2.0, 3.0, 4.0};
  EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, 0.9), 3.7);
  EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, 1.0), 4.0);
}

TEST(QuantileOfSorted, OfOneValueIsThatValue) {
  EXPECT_DOUBLE_EQ(quantile_of_sorted(std::vector{7.0}, 0.3), 7.0);
}

TEST(QuantileOfSorted, TakesVectorsOfEigen) {
  EXPECT_DOUBLE_EQ(quantile_of_sorted(Eigen::Vector4d{1.0, 2.0, 3.0, 4.0}, 0.25), 1.75);
}

TEST(Median, IsTheMeanOfTheTwoInTheMiddle) {
  EXPECT_DOUBLE_EQ(median({5.0, 1.0, 2.0, 4.0}), 3.0);
  EXPECT_DOUBLE_EQ(median({5.0, 1.0, 2.0}), 2.0);
  EXPECT_DOUBLE_EQ(median({7.0}), 7.0);
}

}  // namespace
}  // namespace recald
