#include "core/assessment/predictive.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/statistics/quantile.hpp"

namespace recald::assessment::predictive_test {
namespace {

// Quartiles 2 and 4, so the whiskers may reach from -1 to 7: 100 is an outlier, 1 is not.
TEST(BoxPlot, WhiskersStopAtTheLastDrawWithinReach) {
  const BoxPlot box = box_plot(std::vector{100.0, 3.0, 1.0, 4.0, 2.0});
  EXPECT_DOUBLE_EQ(box.low_whisker, 1.0);
  EXPECT_DOUBLE_EQ(box.q25, 2.0);
  EXPECT_DOUBLE_EQ(box.q50, 3.0);
  EXPECT_DOUBLE_EQ(box.q75, 4.0);
  EXPECT_DOUBLE_EQ(box.high_whisker, 4.0);
  EXPECT_DOUBLE_EQ(box.mean, 22.0);
}

// Quartiles 6 and 8: a draw exactly 1.5 interquartile ranges away still belongs to the whisker.
TEST(BoxPlot, ReachIncludesItsEnd) {
  const BoxPlot box = box_plot(std::vector{3.0, 6.0, 7.0, 8.0, 11.0});
  EXPECT_DOUBLE_EQ(box.low_whisker, 3.0);
  EXPECT_DOUBLE_EQ(box.high_whisker, 11.0);
}

TEST(BoxPlot, OfOneDrawIsThatDraw) {
  const BoxPlot box = box_plot(std::vector{5.0});
  for (const double value :
       {box.low_whisker, box.q25, box.q50, box.q75, box.high_whisker, box.mean}) {
    EXPECT_DOUBLE_EQ(value, 5.0);
  }
}

TEST(Crps, OfOneDrawIsTheAbsoluteError) {
  EXPECT_DOUBLE_EQ(crps(std::vector{3.0}, 5.0), 2.0);
  EXPECT_DOUBLE_EQ(crps(std::vector{3.0}, 3.0), 0.0);
}

// E|X − y| − E|X − X'| / 2, by hand:
//   {0, 2} against 1:    1 − (0 + 2 + 2 + 0) / 4 / 2 = 0.5
//   {0, 1, 5} against 2: (2 + 1 + 3) / 3 − 2 (1 + 5 + 4) / 9 / 2 = 2 − 10/9
TEST(Crps, MeetsItsDefinition) {
  EXPECT_NEAR(crps(std::vector{0.0, 2.0}, 1.0), 0.5, 1e-12);
  EXPECT_NEAR(crps(std::vector{0.0, 1.0, 5.0}, 2.0), 2.0 - 10.0 / 9.0, 1e-12);
}

// Gneiting, Raftery (2007), eq. (20) for a standard normal forecast.
TEST(Crps, OfManyNormalDrawsMeetsTheClosedForm) {
  const boost::math::normal normal;
  std::vector<double> sorted;
  for (int i = 0; i < 4000; ++i) sorted.push_back(quantile(normal, (i + 0.5) / 4000.0));
  for (const double measured : {-1.5, 0.0, 0.7}) {
    const double closed_form = measured * (2.0 * cdf(normal, measured) - 1.0) +
                               2.0 * pdf(normal, measured) - std::numbers::inv_sqrtpi;
    EXPECT_NEAR(crps(sorted, measured), closed_form, 5e-4) << measured;
  }
}

TEST(Crps, MovesAndScalesWithTheUnit) {
  const double base = crps(std::vector{1.0, 2.0, 4.0}, 3.0);
  EXPECT_NEAR(crps(std::vector{101.0, 102.0, 104.0}, 103.0), base, 1e-10);
  EXPECT_NEAR(crps(std::vector{10.0, 20.0, 40.0}, 30.0), 10.0 * base, 1e-12);
}

}  // namespace
}  // namespace recald::assessment::predictive_test
