#include "core/metering/months/lost_readings.hpp"

#include <gmock/gmock.h>

#include "core/metering/reading.hpp"

namespace recald::metering::lost_readings_test {
namespace {

using std::chrono::months;

constexpr Month kFirst = std::chrono::year{2020} / 1;

std::vector<MonthlyFigure> figures_of(const std::vector<double>& coverage) {
  std::vector<MonthlyFigure> figures;
  for (const double share : coverage) {
    MonthlyFigure figure{};
    figure.month = kFirst + months{std::ssize(figures)};
    figure.coverage = share;
    figures.push_back(figure);
  }
  return figures;
}

TEST(LostReadings, AMeterThatHangsIsSeenAfterTwoMonths) {
  auto figures = figures_of({0.99, 0.97, 0.98, 0.98, 0.7, 0.6, 0.8});
  figures[5].reasons = Reason::stuck | Reason::spike;
  const auto lost = find_lost_readings(figures, 3);
  ASSERT_TRUE(lost.has_value());
  EXPECT_EQ(lost->since, kFirst + months{4});
  EXPECT_EQ(lost->seen, kFirst + months{5});
  EXPECT_NEAR(lost->share_before, 0.98, 1e-12);
  EXPECT_NEAR(lost->share_since, 0.7, 1e-12);
  EXPECT_TRUE(lost->stands_still);
  figures[5].reasons = Reason::timeout;
  EXPECT_FALSE(find_lost_readings(figures, 3)->stands_still);
}

TEST(LostReadings, OneBadMonthIsNoChange) {
  EXPECT_EQ(find_lost_readings(figures_of({0.99, 0.99, 0.2, 0.99, 0.2, 0.99}), 2), std::nullopt);
}

TEST(LostReadings, WhatAlwaysLostMuchIsMeasuredByItself) {
  EXPECT_EQ(find_lost_readings(figures_of({0.9, 0.9, 0.75, 0.75}), 2), std::nullopt);
  EXPECT_NE(find_lost_readings(figures_of({0.9, 0.9, 0.65, 0.65}), 2), std::nullopt);
}

TEST(LostReadings, NothingIsSaidOfTooFewMonths) {
  EXPECT_EQ(find_lost_readings(figures_of({0.9, 0.1}), 1), std::nullopt);
  EXPECT_EQ(find_lost_readings(figures_of({0.9, 0.1, 0.1}), 0), std::nullopt);
  EXPECT_EQ(find_lost_readings({}, 3), std::nullopt);
}

}  // namespace
}  // namespace recald::metering::lost_readings_test
