#include "core/assessment/box_plot.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace recald::assessment::box_plot_test {
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

}  // namespace
}  // namespace recald::assessment::box_plot_test
