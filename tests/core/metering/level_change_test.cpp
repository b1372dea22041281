#include "core/metering/months/level_change.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random/rng.hpp"
#include "month_builder.hpp"

namespace recald::metering::level_change_test {
namespace {

using testing::month;

/// Months from January 2010 on with these daily averages; NaN makes an unusable month.
std::vector<MonthlyFigure> months_of(const std::vector<double>& daily_kWh) {
  std::vector<MonthlyFigure> figures;
  Month at = month(2010, 1);
  for (const double value_kWh : daily_kWh) {
    MonthlyFigure figure{};
    figure.month = at;
    figure.daily_average_kWh = value_kWh;
    figure.usable = !std::isnan(value_kWh);
    figures.push_back(figure);
    at = next_month(at);
  }
  return figures;
}

/// A seasonal meter whose months scatter by `scatter` (log-standard deviation).
std::vector<double> seasonal(int count, double season, double scatter, std::uint64_t seed) {
  Rng rng{seed};
  std::vector<double> daily_kWh;
  for (int i = 0; i < count; ++i) {
    const double shape = 1.0 + season * std::cos(i * 3.14159265358979 / 6.0);
    daily_kWh.push_back(2000.0 * shape * std::exp(scatter * rng.normal()));
  }
  return daily_kWh;
}

std::vector<LevelChange> changes(const std::vector<double>& daily_kWh,
                                 Utility utility = Utility::electricity) {
  return find_level_changes("main", months_of(daily_kWh), level_change_options(utility));
}

TEST(LevelChange, AStepOfAFifthIsFoundInItsMonth) {
  std::vector<double> daily_kWh = seasonal(48, 0.2, 0.02, 1);
  for (std::size_t i = 30; i < 48; ++i) daily_kWh[i] *= 0.8;
  const auto found = changes(daily_kWh);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, LevelChangeKind::level);
  EXPECT_EQ(found[0].since, month(2012, 7));
  EXPECT_FALSE(found[0].back_since.has_value());
  EXPECT_NEAR(found[0].ratio, 0.8, 0.06);
  EXPECT_NE(
      found[0].words.find("main has differed from the same months of earlier years since 2012-07"),
      std::string::npos);
  EXPECT_FALSE(is_different(found, month(2012, 6)));
  EXPECT_TRUE(is_different(found, month(2013, 12)));  // not learned as the new normal
}

TEST(LevelChange, SeasonsAreNoChange) {
  EXPECT_TRUE(changes(seasonal(60, 0.8, 0.05, 2), Utility::gas).empty());
}

TEST(LevelChange, OneOddMonthAfterTheAlarmDoesNotCloseIt) {
  std::vector<double> daily_kWh = seasonal(48, 0.0, 0.02, 3);
  for (std::size_t i = 24; i < 48; ++i) daily_kWh[i] *= i == 25 ? 1.0 : 1.4;
  const auto found = changes(daily_kWh);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].since, month(2012, 1));
  EXPECT_TRUE(is_different(found, month(2012, 2)));
}

TEST(LevelChange, HalfAYearAsBeforeEndsIt) {
  std::vector<double> daily_kWh = seasonal(60, 0.1, 0.01, 4);
  for (std::size_t i = 24; i < 30; ++i) daily_kWh[i] *= 0.6;  // closed for half a year
  const auto found = changes(daily_kWh);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].since, month(2012, 1));
  EXPECT_EQ(found[0].back_since, month(2012, 7));
  EXPECT_FALSE(is_different(found, month(2012, 7)));
}

// −12 % is three scales for this meter: no single month proves it, four in a row do.
TEST(LevelChange, ASmallPersistentChangeIsDatedToItsFirstMonth) {
  std::vector<double> daily_kWh(48, 1000.0);
  for (std::size_t i = 30; i < 48; ++i) daily_kWh[i] = 880.0;
  LevelChangeOptions options;
  options.typical_scatter = 0.045;
  options.typical_scatter_months = 1000.0;
  const auto found = find_level_changes("main", months_of(daily_kWh), options);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].since, month(2012, 7));
  for (std::size_t i = 33; i < 48; ++i) daily_kWh[i] = 1000.0;  // three months only
  EXPECT_TRUE(find_level_changes("main", months_of(daily_kWh), options).empty());
}

TEST(LevelChange, AUnitChangeIsToldWithItsFactor) {
  std::vector<double> daily_kWh = seasonal(48, 0.6, 0.08, 5);
  for (std::size_t i = 36; i < 48; ++i) daily_kWh[i] /= 31.6;
  const auto found = changes(daily_kWh, Utility::gas);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, LevelChangeKind::scale);
  EXPECT_EQ(found[0].since, month(2013, 1));
  EXPECT_NEAR(1.0 / found[0].factor, 31.6, 10.0);
  EXPECT_NE(found[0].words.find("unit or multiplier"), std::string::npos);
}

// The building changed first and the unit later: both are told, and the unit's factor is that of
// its own step, not of the sum.
TEST(LevelChange, AUnitChangeAfterALevelChangeIsToldToo) {
  std::vector<double> daily_kWh = seasonal(60, 0.3, 0.02, 6);
  for (std::size_t i = 28; i < 60; ++i) daily_kWh[i] *= 0.4;
  for (std::size_t i = 40; i < 60; ++i) daily_kWh[i] *= 1000.0;
  const auto found = changes(daily_kWh, Utility::heating);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].kind, LevelChangeKind::level);
  EXPECT_EQ(found[1].kind, LevelChangeKind::scale);
  EXPECT_EQ(found[1].since, month(2013, 5));
  EXPECT_NEAR(found[1].factor, 1000.0, 150.0);
}

// A simulated office: after a winter at two thirds of the usual a March at nearly twice it.
TEST(LevelChange, AColdMarchAfterAMildWinterIsNoUnit) {
  const std::vector<double> daily_kWh{
      1395, 586, 310, 161, 136, 137, 135,  139, 132,  221, 386,  1146, 1629, 773, 698,
      208,  135, 136, 136, 138, 133, 196,  623, 1168, 833, 1076, 707,  269,  136, 133,
      136,  133, 134, 200, 292, 749, 1155, 721, 330,  148, 139,  136,  134,  134, 137,
      144,  267, 530, 802, 949, 911, 218,  132, 140,  132, 138,  138,  177,  244, 701,
      802,  849, 557, 217, 133, 136, 131,  142, 136,  154, 600,  1029};
  for (const LevelChange& change : changes(daily_kWh, Utility::heating)) {
    EXPECT_NE(change.kind, LevelChangeKind::scale) << change.words;
  }
}

TEST(LevelChange, TheFirstYearHasNothingToBeComparedWith) {
  std::vector<double> daily_kWh = seasonal(12, 0.0, 0.0, 7);
  daily_kWh[6] *= 5.0;
  EXPECT_TRUE(changes(daily_kWh).empty());
}

TEST(LevelChange, UnusableMonthsAreSkippedAndOlderYearsStandIn) {
  std::vector<double> daily_kWh = seasonal(48, 0.0, 0.01, 8);
  for (std::size_t i = 12; i < 24; ++i) daily_kWh[i] = std::nan("");
  EXPECT_TRUE(changes(daily_kWh).empty());
  daily_kWh[24] *= 0.5;
  ASSERT_FALSE(changes(daily_kWh).empty());
  EXPECT_EQ(changes(daily_kWh)[0].since, month(2012, 1));
}

// A boiler's July is hot water only: a tenth or ten times last year's, and no finding.
TEST(LevelChange, SmallMonthsAreNotCompared) {
  std::vector<double> daily_kWh(60, 1000.0);
  for (std::size_t i = 6; i < 60; i += 12) daily_kWh[i] = i == 30 ? 80.0 : 8.0;
  EXPECT_TRUE(changes(daily_kWh, Utility::gas).empty());
}

/// Share of stable five-year meters on which something is found.
double false_alarms(double scatter, Utility utility) {
  constexpr int meters = 1500;
  int alarms = 0;
  for (int seed = 0; seed < meters; ++seed) {
    const auto daily_kWh = seasonal(60, 0.3, scatter, 1000 + static_cast<std::uint64_t>(seed));
    if (!changes(daily_kWh, utility).empty()) ++alarms;
  }
  return alarms / static_cast<double>(meters);
}

// The header's table; bounds are its figures plus three standard errors of 1500 meters.
TEST(LevelChange, StableMetersRarelyAlarm) {
  const double electricity = false_alarms(0.03, Utility::electricity);
  const double electricity_rough = false_alarms(0.04, Utility::electricity);
  const double thermal = false_alarms(0.12, Utility::steam);
  RecordProperty("electricity_0_03", std::to_string(electricity));
  RecordProperty("electricity_0_04", std::to_string(electricity_rough));
  RecordProperty("thermal_0_12", std::to_string(thermal));
  EXPECT_EQ(false_alarms(0.02, Utility::electricity), 0.0);
  EXPECT_LE(electricity, 0.016);
  EXPECT_LE(electricity_rough, 0.036);
  EXPECT_LE(thermal, 0.037);
}

// In a mild climate one month of heating says nothing: thirteen times last year's, then as before.
TEST(LevelChange, OneColdMonthOfAMildClimateIsNoUnit) {
  std::vector<double> daily_kWh(48, 100.0);
  for (std::size_t january = 0; january < 48; january += 12) daily_kWh[january] = 1000.0;
  daily_kWh[26] = 1250.0;
  const auto odd = changes(daily_kWh, Utility::heating);
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_EQ(odd[0].kind, LevelChangeKind::level) << odd[0].words;
  EXPECT_EQ(odd[0].since, month(2012, 3));
  // Nor is one twice as much as ever the weather.
  daily_kWh[26] = 2500.0;
  const auto found = changes(daily_kWh, Utility::heating);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].kind, LevelChangeKind::scale);
  EXPECT_EQ(found[0].since, month(2012, 3));
}

// As long as no other month confirms it, a unit is not told from a month unlike others.
TEST(LevelChange, TheNewestMonthIsTold) {
  std::vector<double> daily_kWh(31, 1000.0);
  daily_kWh[30] = 40.0;
  const auto found = changes(daily_kWh, Utility::gas);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, LevelChangeKind::level);
  EXPECT_EQ(found[0].since, month(2012, 7));
}

TEST(LevelChange, ASecondMonthDatesTheUnitToTheFirst) {
  std::vector<double> daily_kWh(48, 1000.0);
  for (std::size_t i = 30; i < 48; ++i) daily_kWh[i] = 40.0;
  // Months this small beside the largest are compared, because last year's were not small.
  const auto found = changes(daily_kWh, Utility::gas);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].kind, LevelChangeKind::scale);
  EXPECT_EQ(found[0].since, month(2012, 7));
  EXPECT_EQ(found[0].seen, month(2012, 8));
  EXPECT_NEAR(1.0 / found[0].factor, 25.0, 0.1);
}

}  // namespace
}  // namespace recald::metering::level_change_test
