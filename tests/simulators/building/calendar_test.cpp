#include "simulators/building/calendar.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace recald::simulators::calendar_test {
namespace {

using namespace std::chrono;

TEST(Calendar, HolidaysOf2021AreThosePublished) {
  const auto days = Calendar(Use::laboratory).holidays_of(2021y);
  const std::vector<metering::Day> expected{
      2021y / January / 1,   2021y / January / 18,  2021y / May / 31,      2021y / July / 5,
      2021y / September / 6, 2021y / November / 25, 2021y / November / 26, 2021y / December / 24,
      2021y / December / 25, 2021y / December / 27};
  EXPECT_EQ(days, expected);
}

TEST(Calendar, HolidaysStayInTheirYearAndOrdered) {
  for (int y = 2015; y < 2036; ++y) {
    const auto days = Calendar(Use::laboratory).holidays_of(std::chrono::year{y});
    EXPECT_TRUE(std::ranges::is_sorted(days));
    for (const auto day : days) EXPECT_EQ(static_cast<int>(day.year()), y);
  }
}

TEST(Calendar, DayKinds) {
  EXPECT_EQ(Calendar(Use::laboratory).kind_of(2024y / February / 29), DayKind::workday);
  EXPECT_EQ(Calendar(Use::laboratory).kind_of(2021y / July / 3), DayKind::saturday);
  EXPECT_EQ(Calendar(Use::laboratory).kind_of(2021y / July / 4), DayKind::sunday);
  EXPECT_EQ(Calendar(Use::laboratory).kind_of(2021y / July / 5), DayKind::sunday);  // observed
}

TEST(Calendar, SchoolsAreClosedInSummerAndOfficesAreNot) {
  const Calendar school(Use::school);
  const Calendar office(Use::office);
  EXPECT_EQ(school.kind_of(2022y / July / 13), DayKind::sunday);
  EXPECT_EQ(office.kind_of(2022y / July / 13), DayKind::workday);
  EXPECT_EQ(school.kind_of(2022y / October / 12), DayKind::workday);
  EXPECT_EQ(office.kind_of(2022y / February / 21), DayKind::sunday);
  for (const Use use : {Use::school, Use::office}) {
    const auto days = Calendar(use).holidays_of(2022y);
    EXPECT_TRUE(std::ranges::is_sorted(days));
    EXPECT_EQ(std::ranges::adjacent_find(days), days.end());
  }
}

TEST(Calendar, TradeRestsOnFewDaysAndRestaurantsOnMondays) {
  EXPECT_TRUE(Calendar(Use::hotel).holidays_of(2022y).empty());
  EXPECT_EQ(Calendar(Use::shop).holidays_of(2022y),
            (std::vector<metering::Day>{2022y / January / 1, 2022y / July / 4,
                                        2022y / November / 24, 2022y / December / 25}));
  const Calendar restaurant(Use::restaurant);
  EXPECT_EQ(restaurant.holidays_of(2022y).size(), 52u + 3u);
  EXPECT_EQ(restaurant.kind_of(2022y / March / 7), DayKind::sunday);  // a Monday
  EXPECT_EQ(restaurant.kind_of(2022y / March / 8), DayKind::workday);
  EXPECT_EQ(restaurant.kind_of(2022y / March / 12), DayKind::saturday);
  EXPECT_EQ(Calendar(Use::warehouse).kind_of(2022y / December / 26), DayKind::sunday);  // observed
  for (const Use use : kUses) {
    for (int y = 2015; y < 2036; ++y) {
      const auto days = Calendar(use).holidays_of(std::chrono::year{y});
      EXPECT_TRUE(std::ranges::is_sorted(days));
      EXPECT_EQ(std::ranges::adjacent_find(days), days.end());
      for (const auto day : days) EXPECT_EQ(static_cast<int>(day.year()), y);
    }
  }
}

TEST(Calendar, OpenDaysGrowFromWorkdaysToAll) {
  using enum DayKind;
  for (const OpenDays days :
       {OpenDays::workdays, OpenDays::workdays_and_saturdays, OpenDays::every_day}) {
    EXPECT_TRUE(is_open(days, workday));
    EXPECT_EQ(is_open(days, saturday), days != OpenDays::workdays);
    EXPECT_EQ(is_open(days, sunday), days == OpenDays::every_day);
  }
}

}  // namespace
}  // namespace recald::simulators::calendar_test
