// What people do besides working: open_windows, cooking, event_evenings.
#include <algorithm>

#include "tests/simulators/effects/by_hand.hpp"

namespace recald::simulators {

EffectKind open_windows();
EffectKind cooking();
EffectKind event_evenings();

}  // namespace recald::simulators

namespace recald::simulators::people_habits_test {
namespace {

/// Open at three in the afternoon of a working day, people in since eight.
double open_m2(double outdoor_C, double wind_m_s, double rain_mm_h = 0.0) {
  Bench bench(open_windows(), strength_of(2.0));
  bench.plan(kMonday);
  bench.operate_until(kMonday, 7.75);
  bench.people_share = 0.7;
  bench.outdoors.air.temperature_C = outdoor_C;
  bench.outdoors.wind_speed_m_s = wind_m_s;
  bench.outdoors.precipitation_mm_h = rain_mm_h;
  double open = 0.0;
  for (double hour = 8.0; hour <= 15.0; hour += 0.25) {
    open = bench.operate(kMonday, hour).envelope.window_opening_m2;
  }
  return open;
}

TEST(OpenWindows, InMildCalmDryWeather) {
  // Three storeys of 210 m x 4.2 m facade, 35 % of it windows, 2 % of these open; moods 0.6 to 1.2.
  constexpr double pleasant_m2 = 0.02 * 3.0 * 210.0 * 4.2 * 0.35;
  const double mild_m2 = open_m2(22.0, 3.0);
  EXPECT_GT(mild_m2, 0.55 * pleasant_m2);
  EXPECT_LT(mild_m2, 1.2 * pleasant_m2);
  EXPECT_LT(open_m2(14.0, 3.0), 0.5 * mild_m2);
  EXPECT_LT(open_m2(5.0, 3.0), 0.01 * mild_m2);
  EXPECT_LT(open_m2(33.0, 3.0), 0.01 * mild_m2);
  EXPECT_LT(open_m2(22.0, 13.0), 0.01 * mild_m2);
  EXPECT_NEAR(open_m2(22.0, 3.0, 2.0), 0.4 * mild_m2, 0.01 * mild_m2);
}

TEST(OpenWindows, FewAreForgottenWhenPeopleLeaveAndNoneOpensByItself) {
  Bench bench(open_windows(), strength_of(2.0));
  bench.plan(kMonday);
  bench.outdoors.air.temperature_C = 22.0;
  EXPECT_EQ(bench.operate_until(kMonday, 7.0).envelope.window_opening_m2, 0.0);
  bench.people_share = 0.7;
  double by_day_m2 = 0.0;
  for (double hour = 8.0; hour < 18.0; hour += 0.25) {
    by_day_m2 = bench.operate(kMonday, hour).envelope.window_opening_m2;
  }
  bench.people_share = 0.0;
  double at_night_m2 = 0.0;
  for (double hour = 18.0; hour < 24.0; hour += 0.25) {
    at_night_m2 = bench.operate(kMonday, hour).envelope.window_opening_m2;
  }
  EXPECT_GT(at_night_m2, 0.0);
  EXPECT_LT(at_night_m2, 0.25 * by_day_m2);
}

Drawings with_heating(HeatingPlant heating) {
  Drawings drawings;
  drawings.heating = heating;
  return drawings;
}

struct KitchenDay {
  double fuel_kWh = 0.0;
  double electricity_kWh = 0.0;
  double busiest_hour = 0.0;
};

KitchenDay cook(HeatingPlant heating, metering::Day day) {
  Bench bench(cooking(), strength_of(0.5), with_heating(heating));
  bench.plan(day);
  KitchenDay kitchen;
  double most_W = 0.0;
  for (double hour = 0.0; hour < 24.0; hour += 0.25) {
    const ServiceLoad load = bench.load(day, hour);
    kitchen.fuel_kWh += load.other_fuel_W * 0.25 / 1000.0;
    kitchen.electricity_kWh += load.other_electricity_W * 0.25 / 1000.0;
    const double sum_W = load.other_fuel_W + load.other_electricity_W;
    if (sum_W > most_W) kitchen.busiest_hour = hour;
    most_W = std::max(most_W, sum_W);
  }
  return kitchen;
}

TEST(Cooking, LunchForHalfTheBuildingOnGas) {
  // 7800 m² x 0.05 people/m² x 0.5 lunches x 2 kWh, 70 % of it flames; appetite is within 15 %.
  const KitchenDay kitchen = cook(HeatingPlant::boiler, kTuesday);
  EXPECT_NEAR(kitchen.fuel_kWh, 0.7 * 390.0, 0.15 * 0.7 * 390.0);
  EXPECT_NEAR(kitchen.electricity_kWh / kitchen.fuel_kWh, 3.0 / 7.0, 0.01);
  EXPECT_GE(kitchen.busiest_hour, 11.0);
  EXPECT_LE(kitchen.busiest_hour, 13.5);
}

TEST(Cooking, FewerGuestsOnFridays) {
  Bench bench(cooking(), strength_of(0.5), with_heating(HeatingPlant::boiler));
  double mondays_W = 0.0;
  double fridays_W = 0.0;
  for (metering::Day day = kMonday; day < day_of(2023, 6, 7); day = next(day)) {
    bench.plan(day);
    const std::chrono::weekday weekday{std::chrono::sys_days{day}};
    const double noon_W = bench.load(day, 12.0).other_fuel_W;
    if (weekday == std::chrono::Monday) mondays_W += noon_W;
    if (weekday == std::chrono::Friday) fridays_W += noon_W;
  }
  // A hundred of each, a few of them holidays; appetites average out.
  EXPECT_NEAR(fridays_W / mondays_W, 0.8, 0.08);
}

TEST(Cooking, OnElectricityWhereThereIsNoGas) {
  const KitchenDay kitchen = cook(HeatingPlant::district_steam, kTuesday);
  EXPECT_EQ(kitchen.fuel_kWh, 0.0);
  EXPECT_NEAR(kitchen.electricity_kWh, 390.0, 0.15 * 390.0);
}

TEST(Cooking, ShutOnWeekendsWithItsHoods) {
  EXPECT_EQ(cook(HeatingPlant::boiler, kSaturday).electricity_kWh, 0.0);
  Bench bench(cooking(), strength_of(0.5));
  bench.plan(kTuesday);
  EXPECT_NEAR(bench.operate(kTuesday, 12.0).envelope.extraction_m3_s, 0.008 * 195.0, 1e-12);
  EXPECT_EQ(bench.operate(kTuesday, 20.0).envelope.extraction_m3_s, 0.0);
  bench.plan(kSaturday);
  EXPECT_EQ(bench.operate(kSaturday, 12.0).envelope.extraction_m3_s, 0.0);
}

TEST(EventEvenings, AboutThirtyAYearLateInTheWeekAndOutsideTheDeadSeasons) {
  Bench bench(event_evenings(), strength_of(0.6));
  constexpr int kYears = 20;
  int events = 0, mondays = 0, fridays = 0, in_august = 0;
  for (metering::Day day = day_of(2000, 1, 1); day < day_of(2000 + kYears, 1, 1); day = next(day)) {
    bench.plan(day);
    double guests = 0.0;
    for (double hour = 17.0; hour < 24.0; hour += 0.5) {
      guests = std::max(guests, bench.operate(day, hour).rooms.extra_people);
    }
    EXPECT_EQ(bench.operate(day, 12.0).rooms.extra_people, 0.0);
    if (guests == 0.0) continue;
    // 0.6 guests for each of 390 people, the crowd varies by 40 %.
    EXPECT_GT(guests, 0.6 * 0.6 * 390.0 * 0.99);
    EXPECT_LT(guests, 1.4 * 0.6 * 390.0 * 1.01);
    const std::chrono::weekday weekday{std::chrono::sys_days{day}};
    ++events;
    mondays += weekday == std::chrono::Monday;
    fridays += weekday == std::chrono::Friday;
    in_august += day.month() == std::chrono::August;
  }
  EXPECT_NEAR(static_cast<double>(events) / kYears, 34.0, 5.0);
  EXPECT_GT(fridays, 3 * mondays);
  EXPECT_LT(in_august, events / 25);
}

TEST(EventEvenings, AirRunsAsLongAsTheGuestsAreThere) {
  Bench bench(event_evenings(), strength_of(0.6));
  int later = 0;
  int opened = 0;
  for (metering::Day day = day_of(2000, 1, 1); day < day_of(2005, 1, 1); day = next(day)) {
    const Timetable timetable = bench.plan(day);
    const RunningHours& air = timetable.air;
    EXPECT_LE(air.to_h, 24.0);
    if (timetable.kind == DayKind::workday) {
      later += air.to_h > 19.0;
      EXPECT_EQ(air.from_h, 7.0);
    } else if (hours(air) > 0.0) {
      ++opened;
      EXPECT_GE(air.from_h, 17.5);
      EXPECT_EQ(bench.operate(day, air.to_h + 0.5).rooms.extra_people, 0.0);
    }
  }
  EXPECT_GT(later, 50);
  EXPECT_GT(opened, 10);
}

TEST(EventEvenings, SmallEventsGetAirForPartOfTheEvening) {
  Bench small(event_evenings(), strength_of(0.05));
  Bench big(event_evenings(), strength_of(0.5));
  for (metering::Day day = day_of(2000, 1, 1); day < day_of(2003, 1, 1); day = next(day)) {
    const Timetable little = small.plan(day, kNever);
    const Timetable all = big.plan(day, kNever);
    EXPECT_NEAR(hours(little.air), 0.1 * hours(all.air), 1e-9);
    EXPECT_NEAR(little.warm_up_h, hours(all.air) > 0.0 ? 0.1 : 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace recald::simulators::people_habits_test
