#include "core/assessment/interval_score.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>

namespace recald::assessment {
namespace {

// By hand: a width of 4, and 2 / 0.1 = 20 for each unit that a value lies outside.
TEST(IntervalScore, IsTheWidthAndWhatMissesCost) {
  const Interval band{8.0, 12.0};
  EXPECT_NEAR(interval_score(band, 0.9, 10.0), 4.0, 1e-12);
  EXPECT_NEAR(interval_score(band, 0.9, 8.0), 4.0, 1e-12);
  EXPECT_NEAR(interval_score(band, 0.9, 12.0), 4.0, 1e-12);
  EXPECT_NEAR(interval_score(band, 0.9, 7.5), 14.0, 1e-12);
  EXPECT_NEAR(interval_score(band, 0.9, 13.0), 24.0, 1e-12);
  EXPECT_NEAR(interval_score(band, 0.5, 13.0), 8.0, 1e-12);
}

// Proper: on average over what may come, no other band does better than the right quantiles.
TEST(IntervalScore, IsLeastForTheRightQuantiles) {
  const boost::math::normal truth{100.0, 5.0};
  const auto mean_score = [&](const Interval& band) {
    constexpr int kValues = 2000;
    double sum = 0.0;
    for (int i = 0; i < kValues; ++i) {
      sum += interval_score(band, 0.9, boost::math::quantile(truth, (i + 0.5) / kValues));
    }
    return sum / kValues;
  };
  const Interval right{boost::math::quantile(truth, 0.05), boost::math::quantile(truth, 0.95)};
  const double best = mean_score(right);
  for (const double shift : {-2.0, -0.5, 0.5, 2.0}) {
    EXPECT_GT(mean_score({right.low + shift, right.high}), best) << shift;
    EXPECT_GT(mean_score({right.low, right.high + shift}), best) << shift;
  }
}

}  // namespace
}  // namespace recald::assessment
