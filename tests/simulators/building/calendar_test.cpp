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

}  // namespace
}  // namespace recald::simulators::calendar_test
