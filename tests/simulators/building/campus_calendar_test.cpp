#include "simulators/building/campus_calendar.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace recald::simulators {
namespace {

using namespace std::chrono;

TEST(CampusCalendar, HolidaysOf2021AreThosePublished) {
  const auto days = holidays_of(2021y);
  const std::vector<metering::Day> expected{
      2021y / January / 1,   2021y / January / 18,  2021y / May / 31,      2021y / July / 5,
      2021y / September / 6, 2021y / November / 25, 2021y / November / 26, 2021y / December / 24,
      2021y / December / 25, 2021y / December / 27};
  EXPECT_EQ(days, expected);
}

TEST(CampusCalendar, HolidaysStayInTheirYearAndOrdered) {
  for (int y = 2015; y < 2036; ++y) {
    const auto days = holidays_of(std::chrono::year{y});
    EXPECT_TRUE(std::ranges::is_sorted(days));
    for (const auto day : days) EXPECT_EQ(static_cast<int>(day.year()), y);
  }
}

TEST(CampusCalendar, DayKinds) {
  EXPECT_EQ(day_kind(2024y / February / 29), DayKind::workday);
  EXPECT_EQ(day_kind(2021y / July / 3), DayKind::saturday);
  EXPECT_EQ(day_kind(2021y / July / 4), DayKind::sunday);
  EXPECT_EQ(day_kind(2021y / July / 5), DayKind::sunday);  // observed
}

}  // namespace
}  // namespace recald::simulators
