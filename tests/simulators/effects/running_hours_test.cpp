// When the plant runs: weekend_operation, after_hours, early_start, round_the_clock_zone.
#include <algorithm>

#include "tests/simulators/effects/by_hand.hpp"

namespace recald::simulators {

EffectKind weekend_operation();
EffectKind after_hours();
EffectKind early_start();
EffectKind round_the_clock_zone();

}  // namespace recald::simulators

namespace recald::simulators::running_hours_test {
namespace {

TEST(WeekendOperation, CopiesTheWorkdayToSaturdayFirstThenToSunday) {
  struct Case {
    double strength, saturday_h, sunday_h;
  };
  for (const Case& expected :
       {Case{0.5, 6.0, 0.0}, Case{1.0, 12.0, 0.0}, Case{1.25, 12.0, 3.0}, Case{2.0, 12.0, 12.0}}) {
    SCOPED_TRACE(expected.strength);
    Bench bench(weekend_operation(), strength_of(expected.strength));
    bench.plan(kFriday);
    const RunningHours saturday = bench.plan(kSaturday).air;
    const RunningHours sunday = bench.plan(kSunday).air;
    EXPECT_DOUBLE_EQ(hours(saturday), expected.saturday_h);
    EXPECT_DOUBLE_EQ(saturday.from_h, 7.0);
    EXPECT_DOUBLE_EQ(hours(sunday), expected.sunday_h);
  }
}

TEST(WeekendOperation, WidensASaturdayThatHasHoursOfItsOwn) {
  Bench bench(weekend_operation(), strength_of(0.5));
  bench.plan(kFriday);
  const RunningHours saturday = bench.plan(kSaturday, {8.0, 14.0}).air;
  EXPECT_DOUBLE_EQ(saturday.from_h, 7.5);
  EXPECT_DOUBLE_EQ(saturday.to_h, 16.5);
}

TEST(WeekendOperation, LeavesWorkingDaysAndHolidaysInTheWeekAlone) {
  Bench bench(weekend_operation(), strength_of(2.0));
  EXPECT_DOUBLE_EQ(hours(bench.plan(kFriday).air), 12.0);
  EXPECT_DOUBLE_EQ(hours(bench.plan(day_of(2021, 5, 31)).air), 0.0);  // Memorial Day, a Monday
}

TEST(WeekendOperation, WarmUpShrinksWithTheHours) {
  Bench bench(weekend_operation(), strength_of(0.01));
  bench.plan(kFriday);
  EXPECT_DOUBLE_EQ(bench.plan(kSaturday).warm_up_h, 0.01);
}

TEST(AfterHours, StopsLaterOnWorkingDaysByTheGivenHoursOnAverage) {
  Bench bench(after_hours(), strength_of(1.0));
  double extra_h = 0.0;
  int working_days = 0;
  for (metering::Day day = day_of(2020, 1, 1); day < day_of(2030, 1, 1); day = next(day)) {
    const Timetable timetable = bench.plan(day);
    if (timetable.kind != DayKind::workday) {
      EXPECT_EQ(hours(timetable.air), 0.0);
      continue;
    }
    EXPECT_DOUBLE_EQ(timetable.air.from_h, 7.0);
    extra_h += timetable.air.to_h - 19.0;
    ++working_days;
  }
  // 2500 days with a deviation of 0.4 h: the mean is known within 0.02 h at 99 %.
  EXPECT_NEAR(extra_h / working_days, 1.0, 0.02);
}

TEST(AfterHours, FridaysAreShorterAndMidnightIsTheEnd) {
  Bench bench(after_hours(), strength_of(1.0));
  double thursdays_h = 0.0;
  double fridays_h = 0.0;
  for (metering::Day day = day_of(2020, 1, 1); day < day_of(2026, 1, 1); day = next(day)) {
    const double to_h = bench.plan(day).air.to_h;
    const std::chrono::weekday weekday{std::chrono::sys_days{day}};
    if (weekday == std::chrono::Thursday) thursdays_h += std::max(0.0, to_h - 19.0);
    if (weekday == std::chrono::Friday) fridays_h += std::max(0.0, to_h - 19.0);
  }
  EXPECT_LT(fridays_h, 0.8 * thursdays_h);
  Bench long_evenings(after_hours(), strength_of(6.0));
  for (metering::Day day = kMonday; day < kFriday; day = next(day)) {
    EXPECT_LE(long_evenings.plan(day, {7.0, 23.0}).air.to_h, 24.0);
  }
}

/// Hours before 7 h on a Tuesday, after a Monday that was as cold as this.
double start_ahead_h(double strength, double evening_C, RunningHours monday = {7.0, 19.0}) {
  Bench bench(early_start(), strength_of(strength));
  bench.outdoors.air.temperature_C = evening_C;
  bench.plan(kMonday, monday);
  bench.operate_until(kMonday, 23.75);
  const RunningHours tuesday = bench.plan(kTuesday).air;
  EXPECT_DOUBLE_EQ(tuesday.to_h, 19.0);
  return 7.0 - tuesday.from_h;
}

TEST(EarlyStart, TheColderTheEveningTheEarlier) {
  // 1 at 5 degC, half of it from 15 degC up, half as much again at -5 degC; moods are within 15 %.
  EXPECT_NEAR(start_ahead_h(2.0, 5.0), 2.0, 0.3);
  EXPECT_NEAR(start_ahead_h(2.0, 25.0) / start_ahead_h(2.0, 5.0), 0.5, 1e-9);
  EXPECT_NEAR(start_ahead_h(2.0, -20.0) / start_ahead_h(2.0, 5.0), 1.5, 1e-9);
}

TEST(EarlyStart, EarlierStillAfterADayOffAndNeverBeforeMidnight) {
  EXPECT_NEAR(start_ahead_h(2.0, 5.0, kNever) / start_ahead_h(2.0, 5.0), 1.3, 1e-9);
  EXPECT_DOUBLE_EQ(start_ahead_h(5.0, -10.0), 7.0);
  EXPECT_EQ(start_ahead_h(0.0, -10.0), 0.0);
}

TEST(EarlyStart, DaysWithoutHoursStayWithoutHours) {
  Bench bench(early_start(), strength_of(3.0));
  const RunningHours sunday = bench.plan(kSunday).air;
  EXPECT_EQ(sunday.from_h, kNever.from_h);
  EXPECT_EQ(sunday.to_h, kNever.to_h);
}

TEST(RoundTheClockZone, WorksOnWhenTheOthersHaveLeft) {
  const Drawings drawings;
  Bench bench(round_the_clock_zone(), strength_of(0.2), drawings);
  bench.plan(kTuesday);
  const Operation night = bench.operate(kTuesday, 2.0);
  const double zone_m2 = 0.2 * drawings.floor_area_m2();
  EXPECT_NEAR(night.rooms.extra_lights_W, 0.85 * 9.5 * zone_m2, 1e-6);
  // 7 of 10 desks are taken at night, give or take the roster.
  EXPECT_NEAR(night.rooms.extra_people, 0.7 * 0.05 * zone_m2, 0.07 * 0.05 * zone_m2);
  EXPECT_GT(night.rooms.extra_plugs_W, 0.0);
  EXPECT_DOUBLE_EQ(night.air.night_run_share, 0.2);
  EXPECT_DOUBLE_EQ(night.rooms.night_heating_C, 17.0 + 0.2 * 4.0);
  EXPECT_DOUBLE_EQ(night.rooms.night_cooling_C, 29.0 - 0.2 * 5.0);

  bench.people_share = 0.7;
  const Operation noon = bench.operate(kTuesday, 12.0);
  EXPECT_EQ(noon.rooms.extra_lights_W, 0.0);
  EXPECT_EQ(noon.rooms.extra_people, 0.0);
}

}  // namespace
}  // namespace recald::simulators::running_hours_test
