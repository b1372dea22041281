#include "core/model/drivers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/sample_building.hpp"

namespace recald::model {
namespace {

using ::testing::HasSubstr;
using testing::sample_building;
using testing::sample_drivers;

TEST(Drivers, HoursFollowTheLocalMonth) {
  const Drivers drivers = sample_drivers(sample_building(), 12);
  std::array<int, 12> hours{};
  for (const DriverHour& hour : drivers.hours) hours[static_cast<std::size_t>(hour.month)] += 1;
  EXPECT_EQ(hours[0], 744);
  EXPECT_EQ(hours[2], 743);   // March 2021 loses an hour
  EXPECT_EQ(hours[10], 721);  // November gains one
}

TEST(Drivers, SchedulesStandInLocalTime) {
  const Drivers drivers = sample_drivers(sample_building(), 1);
  // 1 January 2021 begins at 05:00 UTC; it is a Friday and no holiday in this test.
  const DriverHour& midnight = drivers.hours.front();
  EXPECT_EQ(midnight.local_hour, 0);
  EXPECT_EQ(midnight.day, DayType::workday);
  EXPECT_FALSE(midnight.occupied);
  EXPECT_TRUE(drivers.hours[7].occupied);
  EXPECT_DOUBLE_EQ(drivers.hours[7].lights_W, 35e3);
  EXPECT_EQ(drivers.hours[24].day, DayType::saturday);
  EXPECT_FALSE(drivers.hours[24 + 10].occupied);
}

TEST(Drivers, SunStandsInTheSouthAtNoonAndNowhereAtNight) {
  const Drivers drivers = sample_drivers(sample_building(), 1);
  ASSERT_EQ(drivers.orientations.size(), 5u);  // four walls and the roof
  const auto noon = drivers.irradiance_W_m2.col(12);
  EXPECT_GT(noon[2], 1.5 * noon[0]);  // south against north in January
  EXPECT_EQ(drivers.irradiance_W_m2.col(0).sum(), 0.0);
}

TEST(Drivers, MissingWeatherNamesTheHourAndTheVariable) {
  const auto calendar = *metering::LocalCalendar::open("America/New_York");
  const auto begin = std::chrono::sys_days{std::chrono::year{2020} / 12 / 31};
  auto weather = testing::sample_weather(begin, 24 * 40);
  weather.hours[24 * 3].rel_humidity_pct = std::numeric_limits<double>::quiet_NaN();
  const auto make = [&] {
    return make_drivers(testing::months_of_2021_22(1), calendar, {}, sample_building(),
                        testing::sample_loads(), testing::sample_location(), weather);
  };
  const auto incomplete = make();
  ASSERT_FALSE(incomplete.has_value());
  EXPECT_EQ(incomplete.error().code, ErrorCode::not_enough_data);
  EXPECT_THAT(incomplete.error().message, HasSubstr("rel_humidity_pct at 2021-01-03T00:00:00Z"));
  weather.hours.resize(24 * 10);
  EXPECT_THAT(make().error().message, HasSubstr("2021-01"));
}

TEST(Drivers, ASeasonHasItsOwnPeopleAndMayBeClosed) {
  Building building = sample_building();
  Season summer{.first = std::chrono::July / 5,
                .last = std::chrono::August / 20,
                .occupied_fraction = HourlySchedule{},
                .closed = true};
  summer.occupied_fraction->at(DayType::workday, 10) = 0.1;
  building.seasons = {summer};
  const Drivers with = sample_drivers(building, 12);
  const Drivers without = sample_drivers(sample_building(), 12);
  const metering::Day first = std::chrono::year{2021} / 7 / 5;
  const metering::Day last = std::chrono::year{2021} / 8 / 20;
  for (std::size_t i = 0; i < with.hours.size(); ++i) {
    const DriverHour& hour = with.hours[i];
    if (hour.date < first || hour.date > last) {
      EXPECT_EQ(hour.occupied, without.hours[i].occupied);
      EXPECT_EQ(hour.occupied_fraction, without.hours[i].occupied_fraction);
      continue;
    }
    EXPECT_FALSE(hour.occupied);
    const bool is_ten_of_workday = hour.day == DayType::workday && hour.local_hour == 10;
    EXPECT_EQ(hour.occupied_fraction, is_ten_of_workday ? 0.1 : 0.0);
  }
}

TEST(Drivers, PlantThatIsOffLeavesPeopleAlone) {
  Building building = sample_building();
  building.seasons = {{.first = std::chrono::May / 1,
                       .last = std::chrono::September / 30,
                       .occupied_fraction = {},
                       .heating = false},
                      {.first = std::chrono::July / 5,
                       .last = std::chrono::August / 20,
                       .occupied_fraction = {},
                       .closed = true,
                       .cooling = false}};
  const Drivers with = sample_drivers(building, 12);
  const Drivers without = sample_drivers(sample_building(), 12);
  const auto is_between = [](const DriverHour& hour, std::chrono::month_day from,
                             std::chrono::month_day to) {
    const std::chrono::month_day date{hour.date.month(), hour.date.day()};
    return from <= date && date <= to;
  };
  for (std::size_t i = 0; i < with.hours.size(); ++i) {
    const DriverHour& hour = with.hours[i];
    const bool is_closed = is_between(hour, std::chrono::July / 5, std::chrono::August / 20);
    EXPECT_EQ(hour.heating, !is_between(hour, std::chrono::May / 1, std::chrono::September / 30));
    EXPECT_EQ(hour.cooling, !is_closed);
    EXPECT_EQ(hour.occupied, !is_closed && without.hours[i].occupied);
    EXPECT_EQ(hour.occupied_fraction, without.hours[i].occupied_fraction);
  }
}

TEST(Drivers, ASeasonMayGoOverNewYear) {
  const Season winter{.first = std::chrono::December / 20,
                      .last = std::chrono::January / 6,
                      .occupied_fraction = {},
                      .closed = true};
  EXPECT_TRUE(winter.contains(std::chrono::year{2021} / 12 / 20));
  EXPECT_TRUE(winter.contains(std::chrono::year{2022} / 1 / 6));
  EXPECT_FALSE(winter.contains(std::chrono::year{2022} / 1 / 7));
  EXPECT_FALSE(winter.contains(std::chrono::year{2021} / 12 / 19));
}

TEST(Drivers, HolidaysRunLikeSundays) {
  const metering::Day friday = std::chrono::year{2021} / 1 / 1;
  EXPECT_EQ(day_type(friday, {}), DayType::workday);
  EXPECT_EQ(day_type(friday, {friday}), DayType::sunday_or_holiday);
}

TEST(Drivers, WeekendsAreOccupiedWhereTheSiteSaysSo) {
  SetPoints set_points;
  for (const DayType day : {DayType::saturday, DayType::sunday_or_holiday}) {
    EXPECT_FALSE(is_occupied(set_points, day, 12));
  }
  set_points.saturday_occupied = true;
  EXPECT_TRUE(is_occupied(set_points, DayType::saturday, 12));
  EXPECT_FALSE(is_occupied(set_points, DayType::sunday_or_holiday, 12));
  set_points.sunday_occupied = true;
  EXPECT_TRUE(is_occupied(set_points, DayType::sunday_or_holiday, 12));
  EXPECT_FALSE(is_occupied(set_points, DayType::sunday_or_holiday, 5));
}

}  // namespace
}  // namespace recald::model
