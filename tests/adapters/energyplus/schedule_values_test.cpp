#include "adapters/energyplus/model/schedule_values.hpp"

#include <gtest/gtest.h>

namespace recald::energyplus {
namespace {

Json compact(const std::string& lines) {
  return Json::parse(R"({"Schedule:Compact": {"Fans": {"schedule_type_limits_name": "On/Off",
                         "data": [)" +
                     lines + "]}}}");
}

DayValues all_day(double value) { return {{kMinutesADay, value}}; }

TEST(ScheduleValues, TheFirstRuleThatSpeaksOfADayCounts) {
  const auto read = read_schedule(compact(R"(
      {"field": "Through: 6/30"},
      {"field": "For: Weekdays SummerDesignDay"},
      {"field": "Until: 6:00"}, {"field": 0.0}, {"field": "Until: 18:30"}, {"field": 1.0},
      {"field": "Until: 24:00"}, {"field": 0.0},
      {"field": "For: Saturday, Holidays"}, {"field": "Until: 24:00"}, {"field": 0.25},
      {"field": "For: AllOtherDays"}, {"field": "Until: 24:00"}, {"field": 0.0},
      {"field": "Through: 12/31"}, {"field": "For: AllDays"}, {"field": "Interpolate: No"},
      {"field": "Until: 24:00"}, {"field": "1"})"),
                                  "FANS");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->type_limits, "On/Off");
  ASSERT_EQ(read->spans.size(), 2U);
  const auto& spring = read->spans[0];
  EXPECT_EQ(spring.month, 6);
  EXPECT_EQ(spring.day, 30);
  const DayValues working{{360, 0.0}, {1110, 1.0}, {1440, 0.0}};
  EXPECT_EQ(spring.days[kTuesday], working);
  EXPECT_EQ(spring.days[kSummerDesignDay], working);
  EXPECT_EQ(spring.days[kSaturday], all_day(0.25));
  EXPECT_EQ(spring.days[kHoliday], all_day(0.25));
  EXPECT_EQ(spring.days[kSunday], all_day(0.0));
  EXPECT_EQ(read->spans[1].days[kFriday], all_day(1.0));
}

TEST(ScheduleValues, WhatIsWrittenReadsBack) {
  ScheduleValues schedule{"Temperature", {{3, 31, {}}, {12, 31, {}}}};
  for (ScheduleSpan& span : schedule.spans) span.days.fill(all_day(18.5));
  schedule.spans[0].days[kMonday] = {{425, 16.0}, {1440, 21.0}};
  Json objects;
  objects["Schedule:Compact"]["Heating"] = compact_schedule(schedule);
  const auto read = read_schedule(objects, "heating");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->type_limits, "Temperature");
  ASSERT_EQ(read->spans.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(read->spans[i].days, schedule.spans[i].days);
}

TEST(ScheduleValues, AConstantAndAYearOfWeeksAreReadAlike) {
  const Json objects = Json::parse(R"({
    "Schedule:Constant": {"Always": {"hourly_value": 2.0}},
    "Schedule:Day:Interval": {
      "Open": {"data": [{"time": "08:00", "value_until_time": 0}, {"time": "24:00", "value_until_time": 1}]},
      "Closed": {"data": [{"time": "24:00", "value_until_time": 0}]}},
    "Schedule:Week:Daily": {"Week": {"sunday_schedule_day_name": "closed",
      "monday_schedule_day_name": "Open", "tuesday_schedule_day_name": "Open",
      "wednesday_schedule_day_name": "Open", "thursday_schedule_day_name": "Open",
      "friday_schedule_day_name": "Open", "saturday_schedule_day_name": "Closed",
      "holiday_schedule_day_name": "Closed", "summerdesignday_schedule_day_name": "Open",
      "winterdesignday_schedule_day_name": "Closed", "customday1_schedule_day_name": "Closed",
      "customday2_schedule_day_name": "Closed"}},
    "Schedule:Year": {"Plant": {"schedule_weeks": [{"schedule_week_name": "Week", "start_month": 1,
      "start_day": 1, "end_month": 12, "end_day": 31}]}}})");
  EXPECT_EQ(read_schedule(objects, "always")->spans[0].days[kSunday], all_day(2.0));
  const auto year = read_schedule(objects, "Plant");
  ASSERT_TRUE(year);
  EXPECT_EQ(year->spans[0].days[kSaturday], all_day(0.0));
  EXPECT_EQ(year->spans[0].days[kFriday], (DayValues{{480, 0.0}, {1440, 1.0}}));
}

TEST(ScheduleValues, WhatIsNotUnderstoodIsNoSchedule) {
  EXPECT_FALSE(read_schedule(compact(""), "Fans"));
  EXPECT_FALSE(read_schedule(compact(""), "Lamps"));
  const std::string day = R"({"field": "Through: 12/31"}, {"field": "For: AllDays"},)";
  EXPECT_TRUE(read_schedule(compact(day + R"({"field": "Until: 24:00"}, {"field": 1})"), "Fans"));
  for (const char* rest :
       {R"({"field": "Interpolate: Average"}, {"field": "Until: 24:00"}, {"field": 1})",
        R"({"field": "Until: 23:00"}, {"field": 1})", R"({"field": "Until: 25:00"}, {"field": 1})",
        R"({"field": 1})"}) {
    EXPECT_FALSE(read_schedule(compact(day + rest), "Fans")) << rest;
  }
  EXPECT_FALSE(read_schedule(compact(R"({"field": "Through: 12/31"}, {"field": "For: Workingdays"},
                 {"field": "Until: 24:00"}, {"field": 1})"),
                             "Fans"));
}

}  // namespace
}  // namespace recald::energyplus
