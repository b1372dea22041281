#include "core/weather/daily_inputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace recald::weather::daily_inputs_test {
namespace {

using metering::Day;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;

const Day kFirst{year{2021} / 3 / 1};

metering::LocalCalendar calendar(const char* zone) { return *metering::LocalCalendar::open(zone); }

Day day_after(int count) { return Day{sys_days{kFirst} + days{count}}; }

/// Sixty days in UTC from 1 March 2021; hour i as `make(i)` says.
template <class Make>
WeatherSeries sixty_days(Make make) {
  WeatherSeries series{sys_days{kFirst}, {}};
  for (int i = 0; i < 24 * 60; ++i) series.hours.push_back(make(i));
  return series;
}

WeatherHour mild(double dry_bulb_C) {
  return {
      .dry_bulb_C = dry_bulb_C, .rel_humidity_pct = 50.0, .wind_speed_m_s = 3.0, .ghi_W_m2 = 100.0};
}

TEST(DailyInputs, MeansAreOfTheLocalDay) {
  const WeatherSeries weather = sixty_days([](int i) { return mild(i < 24 * 10 ? 5.0 : 9.0); });
  const DailyInputs utc = daily_inputs(weather, calendar("UTC"), {day_after(9), day_after(10)});
  EXPECT_NEAR(utc.means(0, 0), 5.0, 1e-12);
  EXPECT_NEAR(utc.means(1, 0), 9.0, 1e-12);
  EXPECT_NEAR(utc.means(0, 1), 100.0, 1e-9);
  EXPECT_NEAR(utc.means(0, 2), 1000.0 * 0.00268, 0.03);  // 50 % at 5 °C, from tables
  EXPECT_NEAR(utc.means(0, 3), 3.0, 1e-12);
  // Chicago's day 10 begins six hours into that of UTC.
  const DailyInputs chicago = daily_inputs(weather, calendar("America/Chicago"), {day_after(9)});
  EXPECT_NEAR(chicago.means(0, 0), (18.0 * 5.0 + 6.0 * 9.0) / 24.0, 1e-12);
}

// Days of the same mean differ where a building does: 10 °C all day neither heats nor cools.
TEST(DailyInputs, ADayThatSwingsDiffersFromOneThatDoesNot) {
  const WeatherSeries weather = sixty_days([](int i) {
    const double swing = i / 24 == 20 ? 12.0 : 0.0;
    return mild(16.0 + (i % 24 >= 12 ? swing : -swing));
  });
  const DailyInputs inputs = daily_inputs(weather, calendar("UTC"), {day_after(19), day_after(20)});
  EXPECT_NEAR(inputs.means(0, 0), inputs.means(1, 0), 1e-12);
  const Eigen::RowVectorXd change = inputs.terms.row(1) - inputs.terms.row(0);
  EXPECT_GT(change.cwiseAbs().maxCoeff(), 5.0);
  // Above 22 °C over the whole day: twelve hours at 28 °C.
  EXPECT_TRUE((change.array() - 3.0).abs().minCoeff() < 1e-12) << change;
}

TEST(DailyInputs, TheDaysBeforeAreRemembered) {
  const WeatherSeries weather = sixty_days([](int i) { return mild(i / 24 == 20 ? 25.0 : 5.0); });
  const DailyInputs inputs = daily_inputs(
      weather, calendar("UTC"), {day_after(19), day_after(21), day_after(22), day_after(40)});
  const auto change = [&](int row) {
    return (inputs.terms.row(row) - inputs.terms.row(0)).cwiseAbs().maxCoeff();
  };
  EXPECT_NEAR(change(1), 20.0, 1e-9);  // yesterday
  EXPECT_GT(change(2), 1.0);           // the day before yesterday, fading
  EXPECT_LT(change(2), 10.0);
  EXPECT_LT(change(3), 1e-9);
}

TEST(DailyInputs, ADayWithAHoleIsAbsentAndItsNeighbourIsNot) {
  const WeatherSeries weather =
      sixty_days([](int i) { return mild(i == 24 * 20 + 7 ? kAbsent : 5.0); });
  const DailyInputs inputs =
      daily_inputs(weather, calendar("UTC"), {day_after(20), day_after(21), day_after(90)});
  EXPECT_TRUE(inputs.terms.row(0).array().isNaN().all());
  EXPECT_TRUE(inputs.terms.row(1).allFinite());
  EXPECT_TRUE(inputs.terms.row(2).array().isNaN().all()) << "after the series";
}

TEST(DailyInputs, TheFirstDayIsItsOwnPast) {
  const WeatherSeries weather = sixty_days([](int) { return mild(5.0); });
  const DailyInputs inputs = daily_inputs(weather, calendar("UTC"), {kFirst, day_after(30)});
  ASSERT_TRUE(inputs.terms.allFinite());
  EXPECT_LT((inputs.terms.row(0) - inputs.terms.row(1)).cwiseAbs().maxCoeff(), 1e-12);
}

// On 28 March the clock in Berlin skips an hour: the day has 23.
TEST(DailyInputs, DaysOnWhichTheClockIsSetAreWhole) {
  const WeatherSeries weather = sixty_days([](int) { return mild(5.0); });
  const DailyInputs inputs = daily_inputs(weather, calendar("Europe/Berlin"), {day_after(27)});
  EXPECT_TRUE(inputs.terms.allFinite());
  EXPECT_NEAR(inputs.means(0, 1), 100.0, 1e-9);
}

TEST(DaysOf, AreThoseOfEachMonth) {
  const auto all = days_of({year{2020} / 2, year{2021} / 2});
  ASSERT_EQ(all.size(), 57u);
  EXPECT_EQ(all[28], Day{year{2020} / 2 / 29});
  EXPECT_EQ(all[29], Day{year{2021} / 2 / 1});
}

}  // namespace
}  // namespace recald::weather::daily_inputs_test
