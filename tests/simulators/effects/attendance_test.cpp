// Who comes: semester_calendar, vacancy, hybrid_work, missing_holidays.
#include <algorithm>
#include <array>
#include <vector>

#include "tests/simulators/effects/by_hand.hpp"

namespace recald::simulators {

EffectKind semester_calendar();
EffectKind vacancy();
EffectKind hybrid_work();
EffectKind missing_holidays();

}  // namespace recald::simulators

namespace recald::simulators::attendance_test {
namespace {

TEST(SemesterCalendar, PeopleAreAwayBetweenTermsEveryYear) {
  Bench bench(semester_calendar(), strength_of(1.0));
  for (int year = 2019; year <= 2023; ++year) {
    SCOPED_TRACE(year);
    const auto attendance = [&](unsigned month, unsigned day) {
      return bench.plan(day_of(year, month, day)).attendance;
    };
    EXPECT_NEAR(attendance(1, 2), 0.05, 1e-12);
    EXPECT_EQ(attendance(2, 10), 1.0);
    EXPECT_NEAR(attendance(7, 10), 0.15, 1e-12);
    EXPECT_EQ(attendance(9, 20), 1.0);
    EXPECT_EQ(attendance(11, 10), 1.0);
    EXPECT_NEAR(attendance(12, 28), 0.05, 1e-12);
  }
}

TEST(SemesterCalendar, DatesMoveFromYearToYear) {
  Bench bench(semester_calendar(), strength_of(1.0));
  const double first = bench.plan(day_of(2021, 5, 16)).attendance;
  const double second = bench.plan(day_of(2022, 5, 16)).attendance;
  EXPECT_NE(first, second);
}

TEST(SemesterCalendar, OnlyThoseWhoFollowTheTermsLeave) {
  Bench bench(semester_calendar(), strength_of(0.4));
  EXPECT_NEAR(bench.plan(day_of(2021, 7, 10)).attendance, 1.0 - 0.4 * 0.85, 1e-12);
}

TEST(Vacancy, BeginsWithinAWeekAndEndsSoftly) {
  const metering::Day from = day_of(2020, 3, 16);  // a Monday
  EffectSettings settings = strength_from(0.9, from);
  settings.to = std::chrono::sys_days{from} + std::chrono::days{283};
  Bench bench(vacancy(), settings);
  EXPECT_EQ(bench.plan(day_of(2020, 3, 15)).attendance, 1.0);
  // A fifth more of those who can leave is away each day.
  for (int day = 0; day < 5; ++day) {
    const metering::Day date = std::chrono::sys_days{from} + std::chrono::days{day};
    EXPECT_NEAR(bench.plan(date).attendance, 1.0 - 0.9 * 0.2 * (day + 1), 1e-12);
  }
  EXPECT_NEAR(bench.plan(day_of(2020, 5, 1)).attendance, 0.1, 1e-12);
  double before = 0.1;
  int steps = 0;
  for (metering::Day day = day_of(2020, 5, 2); day <= *settings.to; day = next(day)) {
    const double attendance = bench.plan(day).attendance;
    EXPECT_GE(attendance, before - 1e-12);
    if (attendance > before + 1e-9) {
      EXPECT_EQ(std::chrono::weekday{std::chrono::sys_days{day}}, std::chrono::Monday);
      ++steps;
    }
    before = attendance;
  }
  EXPECT_GT(steps, 10);
  EXPECT_NEAR(before, 1.0, 0.1);
  EXPECT_EQ(bench.plan(next(*settings.to)).attendance, 1.0);
  EXPECT_EQ(bench.operate(next(*settings.to), 10.0).rooms.plugs_factor, 1.0);
}

TEST(Vacancy, PlugsArePulledWhilePeopleAreAway) {
  const metering::Day from = day_of(2020, 3, 16);
  Bench bench(vacancy(), strength_from(0.5, from));
  bench.plan(day_of(2020, 3, 13));
  EXPECT_EQ(bench.operate(day_of(2020, 3, 13), 10.0).rooms.plugs_factor, 1.0);
  const metering::Day deep = day_of(2020, 4, 15);
  EXPECT_NEAR(bench.plan(deep).attendance, 0.5, 1e-12);
  EXPECT_NEAR(bench.operate(deep, 10.0).rooms.plugs_factor, 1.0 - 0.12 * 0.5, 1e-12);
}

TEST(Vacancy, EndsByItselfWithinAYear) {
  const metering::Day from = day_of(2020, 3, 16);
  Bench bench(vacancy(), strength_from(1.0, from));
  bench.plan(from);
  EXPECT_EQ(bench.plan(day_of(2021, 4, 1)).attendance, 1.0);
}

TEST(HybridWork, MondaysAndFridaysAreEmptierThanTheMiddleOfTheWeek) {
  Bench bench(hybrid_work(), strength_of(1.0));
  std::array<double, 7> sum{};
  constexpr int kWeeks = 100;
  metering::Day day = kMonday;
  for (int i = 0; i < 7 * kWeeks; ++i, day = next(day)) {
    const double attendance = bench.plan(day).attendance;
    EXPECT_GE(attendance, 0.0);
    EXPECT_LE(attendance, 1.0);
    sum[static_cast<std::size_t>(i % 7)] += attendance / kWeeks;
  }
  EXPECT_NEAR(sum[0], 0.35, 0.04);
  EXPECT_NEAR(sum[2], 0.95, 0.01);
  EXPECT_LT(sum[4], 0.25);
  EXPECT_NEAR(sum[5], 1.0, 1e-12);
  EXPECT_NEAR(sum[6], 1.0, 1e-12);
}

std::vector<metering::Day> quiet_days(Bench& bench, int year) {
  std::vector<metering::Day> days;
  for (metering::Day day = day_of(year, 1, 1); day < day_of(year + 1, 1, 1); day = next(day)) {
    if (bench.plan(day).attendance < 1.0) days.push_back(day);
  }
  return days;
}

TEST(MissingHolidays, ShutsBridgesTheWeekAfterChristmasAndAFewDaysOfTheHouse) {
  Bench bench(missing_holidays(), strength_of(1.0));
  const auto days = quiet_days(bench, 2019);
  const auto shut = [&](metering::Day day) { return std::ranges::count(days, day) == 1; };
  EXPECT_TRUE(shut(day_of(2019, 7, 5)));  // a Friday after a Thursday holiday
  for (unsigned day = 26; day <= 31; ++day) {
    const metering::Day date = day_of(2019, 12, day);
    const std::chrono::weekday weekday{std::chrono::sys_days{date}};
    const bool weekend = weekday == std::chrono::Saturday || weekday == std::chrono::Sunday;
    EXPECT_EQ(shut(date), !weekend) << day;
  }
  // Four working days after Christmas, one bridge, about four days of the house.
  EXPECT_GE(days.size(), 6U);
  EXPECT_LE(days.size(), 16U);
  for (const metering::Day& day : days) {
    EXPECT_EQ(Calendar(Use::laboratory).kind_of(day), DayKind::workday);
  }
}

TEST(MissingHolidays, SameDaysAtAnyStrengthAndPlantHoursNeverGrow) {
  Bench weak(missing_holidays(), strength_of(0.1));
  Bench strong(missing_holidays(), strength_of(1.0));
  EXPECT_EQ(quiet_days(weak, 2020), quiet_days(strong, 2020));
  int early_closings = 0;
  for (unsigned day = 1; day <= 31; ++day) {
    const Timetable timetable = strong.plan(day_of(2021, 12, day));
    if (timetable.kind != DayKind::workday) continue;
    EXPECT_LE(timetable.air.to_h, 19.0);
    early_closings += timetable.air.to_h < 15.0;
  }
  EXPECT_GE(early_closings, 1);
}

TEST(MissingHolidays, AHeavySnowfallAtNightKeepsPeopleHomeOnSomeMornings) {
  Bench bench(missing_holidays(), strength_of(1.0));
  int snow_days = 0;
  int clear_days = 0;
  for (int year = 2000; year < 2030; ++year) {
    for (unsigned day = 5; day <= 14; ++day) {
      const metering::Day date = day_of(year, 2, day);
      bench.outdoors.air.temperature_C = -3.0;
      bench.outdoors.snow_share = 1.0;
      bench.outdoors.precipitation_mm_h = day % 2 == 0 ? 2.0 : 0.0;
      bench.operate_until(date, 23.75);
      const Timetable tomorrow = bench.plan(next(date));
      const bool home = tomorrow.kind == DayKind::workday && tomorrow.attendance < 1.0;
      (day % 2 == 0 ? snow_days : clear_days) += home;
    }
  }
  // Of 107 snowed-in working mornings about half are shut; of the others those of the house.
  EXPECT_GT(snow_days, 30);
  EXPECT_LT(clear_days, 10);
}

}  // namespace
}  // namespace recald::simulators::attendance_test
