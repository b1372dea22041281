#include "core/statistics/rectified_mean.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random/rng.hpp"

namespace recald {
namespace {

TEST(RectifiedMean, IsTheMeanOfWhatIsNotNegative) {
  Rng rng{1};
  constexpr int kDraws = 400'000;
  for (const double z : {-2.0, 0.5, 3.0}) {
    double sum = 0.0;
    for (int i = 0; i < kDraws; ++i) sum += std::max(0.0, z + 1.5 * rng.normal());
    EXPECT_NEAR(rectified_mean(z, 1.5), sum / kDraws, 0.01) << z;
  }
}

TEST(RectifiedMean, ItsSlopeIsTheDifferenceOfTwo) {
  for (const double z : {-4.0, -1.0, 0.0, 2.5}) {
    const double difference =
        (rectified_mean(z + 1e-5, 2.0) - rectified_mean(z - 1e-5, 2.0)) / 2e-5;
    EXPECT_NEAR(rectified_slope(z, 2.0), difference, 1e-8) << z;
  }
}

TEST(RectifiedMean, IsInvertedAboveNextToNothing) {
  for (const double z : {-7.0, -1.0, 0.0, 3.0, 500.0}) {
    EXPECT_NEAR(rectified_inverse(rectified_mean(z, 2.0), 2.0), z, 1e-6) << z;
  }
  EXPECT_EQ(rectified_inverse(0.0, 2.0), -8.0);
}

}  // namespace
}  // namespace recald
