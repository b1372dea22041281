#include "core/assessment/interval_coverage.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace recald::assessment::interval_coverage_test {
namespace {

const double kMissing = std::numeric_limits<double>::quiet_NaN();

TEST(IntervalCoverage, CountsMeasuredPointsWithinClosedIntervals) {
  const auto coverage =
      interval_coverage(std::vector<double>{1, 2, 3, kMissing, 5},
                        std::vector<double>{0, 2, 4, 0, 1}, std::vector<double>{2, 3, 5, 0, 5});
  ASSERT_TRUE(coverage.has_value());
  EXPECT_EQ(coverage->inside, 3);
  EXPECT_EQ(coverage->n, 4);
  EXPECT_DOUBLE_EQ(coverage->share(), 0.75);
}

TEST(IntervalCoverage, NeedsAMeasuredPoint) {
  const std::vector<double> none{kMissing};
  const auto coverage = interval_coverage(none, std::vector<double>{0}, std::vector<double>{1});
  ASSERT_FALSE(coverage.has_value());
  EXPECT_EQ(coverage.error().code, ErrorCode::not_enough_data);
}

TEST(IntervalCoverage, RefusesBrokenBounds) {
  const std::vector<double> measured{1.0};
  const auto nan = interval_coverage(measured, std::vector<double>{kMissing}, measured);
  ASSERT_FALSE(nan.has_value());
  EXPECT_EQ(nan.error().code, ErrorCode::not_finite);
  const auto crossed = interval_coverage(measured, std::vector<double>{2}, std::vector<double>{0});
  ASSERT_FALSE(crossed.has_value());
  EXPECT_EQ(crossed.error().code, ErrorCode::invalid_value);
}

}  // namespace
}  // namespace recald::assessment::interval_coverage_test
