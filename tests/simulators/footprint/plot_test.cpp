#include "simulators/footprint/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/random/rng.hpp"

namespace recald::simulators::plot_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> labels(double low, double high, int intervals) {
  const Ticks ticks = nice_ticks(low, high, intervals);
  std::vector<std::string> all;
  for (int i = 0; i < ticks.count; ++i) all.push_back(ticks.label(i));
  return all;
}

TEST(Plot, TicksAreRoundNumbers) {
  EXPECT_THAT(labels(0.0, 9.3, 6), ElementsAre("0", "2", "4", "6", "8"));
  EXPECT_THAT(labels(0.0, 1200.0, 6), ElementsAre("0", "200", "400", "600", "800", "1000", "1200"));
  EXPECT_THAT(labels(-83.0, 91.0, 6), ElementsAre("\u221250", "0", "50"));
  EXPECT_THAT(labels(-0.3, 0.3, 6),
              ElementsAre("\u22120.3", "\u22120.2", "\u22120.1", "0.0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(labels(0.011, 0.044, 4), ElementsAre("0.02", "0.03", "0.04"));
  EXPECT_THAT(labels(-16.0, 6.0, 4), ElementsAre("\u221215", "\u221210", "\u22125", "0", "5"));
}

TEST(Plot, TicksLieInsideAndAreFew) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const double low = std::pow(10.0, rng.uniform(-4.0, 5.0)) * rng.uniform(-1.0, 1.0);
    const double high = low + std::pow(10.0, rng.uniform(-4.0, 5.0));
    const int intervals = 4 + static_cast<int>(rng.below(5));
    const Ticks ticks = nice_ticks(low, high, intervals);
    const double rounding = 1e-6 * ticks.step;
    EXPECT_GE(ticks.count, 2);
    EXPECT_LE(ticks.count, intervals + 1);
    EXPECT_GE(ticks.first, low - rounding);
    EXPECT_LE(ticks.last(), high + rounding);
    EXPECT_LT(ticks.first - ticks.step, low);
    EXPECT_GT(ticks.last() + ticks.step, high);
  }
}

TEST(Plot, ScaleHoldsZeroAndHasAirOnlyBeyondValues) {
  ValueRange positive;
  positive.include(std::array{3.0, 25.0});
  EXPECT_DOUBLE_EQ(positive.scale(6).low, 0.0);
  EXPECT_DOUBLE_EQ(positive.scale(6).high, 26.0);

  ValueRange both;
  both.include(std::array{-10.0, 40.0});
  EXPECT_DOUBLE_EQ(both.scale(6).low, -12.0);
  EXPECT_DOUBLE_EQ(both.scale(6).high, 42.0);
}

TEST(Plot, NothingIsDrawnAsNothing) {
  ValueRange nothing;
  nothing.include(std::array{0.0, 0.0});
  EXPECT_DOUBLE_EQ(nothing.scale(6).high, 1.0);

  ValueRange little;
  little.include(std::array{-0.01, 0.02});
  little.widen_to(1.0);
  EXPECT_NEAR(little.scale(6).low, -0.54, 1e-12);
  EXPECT_NEAR(little.scale(6).high, 0.54, 1e-12);

  ValueRange enough;
  enough.include(std::array{0.0, 1.0});
  enough.widen_to(1.0);
  EXPECT_DOUBLE_EQ(enough.scale(6).low, 0.0);
}

// 80 px wide, two values: their middles lie 20 px and 60 px from the left, at 10 px.
TEST(Plot, CurvesPassTheMiddlesOfTheirParts) {
  Svg svg(100, 100, "plot");
  Plot plot(svg, {10, 20, 80, 50}, 2.0, {0.0, 4.0, nice_ticks(0.0, 4.0, 4)});
  plot.curve(std::array{0.0, 4.0}, {});

  EXPECT_THAT(svg.finished(), HasSubstr("M300 700l400-500\""));
}

// Each of three parts is 30 px wide, 24 of them for bars, 12 for each of two places; 10 px a unit.
TEST(Plot, BarsHangFromZero) {
  Svg svg(100, 100, "plot");
  Plot plot(svg, {0, 0, 90, 80}, 3.0, {-4.0, 4.0, nice_ticks(-4.0, 4.0, 4)});
  plot.bars(std::array{4.0, 0.0, -2.0}, "#123456", 1, 2);

  EXPECT_THAT(svg.finished(), HasSubstr("\"M15 0h12v40h-12zM75 40h12v20h-12z\" fill=\"#123456\""));
}

TEST(Plot, MarksStandWhereTheyBelong) {
  Svg svg(200, 100, "plot");
  Plot plot(svg, {10, 20, 120, 50}, 24.0, {0.0, 1.0, nice_ticks(0.0, 1.0, 4)});
  plot.x_marks(std::array<Mark, 1>{{{6.0, "six"}}});
  plot.x_rules(2);

  EXPECT_THAT(svg.finished(), HasSubstr("<text x=\"40\" y=\"86\""));
  EXPECT_THAT(svg.finished(), HasSubstr("M10 20L10 70M70 20L70 70M130 20L130 70"));
  EXPECT_THAT(svg.finished(), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace recald::simulators::plot_test
