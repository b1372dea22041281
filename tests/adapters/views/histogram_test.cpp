#include "adapters/views/frame/histogram.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace recald::views {
namespace {

using ::testing::ElementsAre;

TEST(Histogram, CountsByHand) {
  const std::vector<double> values{0.0, 0.4, 1.0, 1.9, 2.0, 4.0};

  const Histogram histogram = make_histogram(values, 4);

  EXPECT_DOUBLE_EQ(histogram.start, 0.0);
  EXPECT_DOUBLE_EQ(histogram.width, 1.0);
  EXPECT_THAT(histogram.counts, ElementsAre(2, 2, 1, 1));  // The last bin includes its end.
}

TEST(Histogram, DensityIntegratesToOne) {
  const std::vector<double> values{3.0, 3.5, 4.0, 7.0, 9.5};
  const Histogram histogram = make_histogram(values, 7);
  const std::vector<double> density = histogram.density();
  EXPECT_NEAR(std::accumulate(density.begin(), density.end(), 0.0) * histogram.width, 1.0, 1e-12);
}

TEST(Histogram, LeavesOutWhatIsNotFinite) {
  const std::vector<double> values{NAN, 1.0, INFINITY, 2.0};
  EXPECT_THAT(make_histogram(values, 2).counts, ElementsAre(1, 1));
}

TEST(Histogram, OfNothingIsEmpty) {
  EXPECT_TRUE(make_histogram({}, 30).counts.empty());
  EXPECT_TRUE(make_histogram(std::vector<double>{NAN}, 30).density().empty());
}

TEST(Histogram, OfEqualValuesHasAWidth) {
  for (const double value : {0.0, 5.0, -1e6}) {
    const Histogram histogram = make_histogram(std::vector<double>(3, value), 30);
    EXPECT_GT(histogram.width, 0.0) << value;
    EXPECT_EQ(histogram.counts.front(), 3) << value;
  }
}

}  // namespace
}  // namespace recald::views
