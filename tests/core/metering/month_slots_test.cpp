#include "core/metering/months/month_slots.hpp"

#include <gtest/gtest.h>

#include <map>

#include "month_builder.hpp"

namespace recald::metering::month_slots_test {
namespace {

using std::chrono::seconds;
using testing::calendar;
using testing::kHour;
using testing::kQuarter;
using testing::month;
using testing::utc;

MonthGrid grid(const std::string& zone, int year, unsigned number, seconds interval = kQuarter) {
  return MonthGrid{calendar(zone), month(year, number), interval, seconds{0}};
}

std::map<int, int> slots_by_day(const MonthGrid& grid) {
  std::map<int, int> slots;
  for (int slot = 0; slot < grid.slots(); ++slot) ++slots[grid.day(slot) + 1];
  return slots;
}

TEST(MonthGrid, ChangeDaysHave92And100Quarters) {
  const MonthGrid march = grid("America/Chicago", 2016, 3);
  EXPECT_EQ(march.slots(), 31 * 96 - 4);
  EXPECT_EQ(slots_by_day(march).at(13), 92);
  const MonthGrid november = grid("America/Chicago", 2016, 11);
  EXPECT_EQ(november.slots(), 30 * 96 + 4);
  EXPECT_EQ(slots_by_day(november).at(6), 100);
  EXPECT_EQ(slots_by_day(november).at(7), 96);
}

TEST(MonthGrid, HourlyMarchInLondonHas743Slots) {
  EXPECT_EQ(grid("Europe/London", 2016, 3, kHour).slots(), 743);
  EXPECT_EQ(grid("Europe/London", 2016, 10, kHour).slots(), 745);
}

TEST(MonthGrid, LordHoweChangesByHalfAnHour) {
  const MonthGrid april = grid("Australia/Lord_Howe", 2016, 4);
  EXPECT_EQ(slots_by_day(april).at(3), 98);
  const MonthGrid october = grid("Australia/Lord_Howe", 2016, 10);
  EXPECT_EQ(slots_by_day(october).at(2), 94);
}

// São Paulo changed at midnight: 2017-10-15 began at 01:00, which is 03:00 UTC.
TEST(MonthGrid, ADayWithoutMidnightBeginsWithItsFirstInstant) {
  const MonthGrid october = grid("America/Sao_Paulo", 2017, 10);
  EXPECT_EQ(slots_by_day(october).at(15), 92);
  const auto first = october.slot_at(utc(2017, 10, 15, 3));
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(october.day(*first), 14);
  EXPECT_EQ(october.day(*first - 1), 13);
  EXPECT_EQ(october.time_of_day(*first), 4);  // 01:00
}

TEST(MonthGrid, LeapFebruaryHas29Days) {
  EXPECT_EQ(grid("Europe/Berlin", 2016, 2).slots(), 29 * 96);
  EXPECT_EQ(grid("Europe/Berlin", 2016, 2).days(), 29);
  EXPECT_EQ(grid("Europe/Berlin", 2015, 2).slots(), 28 * 96);
}

TEST(MonthGrid, TheLocalYearIsNotTheYearOfUtc) {
  const MonthGrid january = grid("Asia/Tokyo", 2016, 1);
  EXPECT_EQ(january.start(0), utc(2015, 12, 31, 15));
  EXPECT_EQ(january.end(), utc(2016, 1, 31, 15));
  EXPECT_FALSE(january.slot_at(utc(2016, 1, 31, 15)).has_value());
  EXPECT_EQ(january.slot_at(utc(2016, 1, 31, 14, 45)), january.slots() - 1);
}

TEST(MonthGrid, OffGridAndForeignInstantsHaveNoSlot) {
  const MonthGrid may = grid("UTC", 2016, 5);
  EXPECT_EQ(may.slot_at(utc(2016, 5, 1)), 0);
  EXPECT_FALSE(may.slot_at(utc(2016, 5, 1, 0, 7)).has_value());
  EXPECT_FALSE(may.slot_at(utc(2016, 4, 30, 23, 45)).has_value());
  EXPECT_FALSE(may.slot_at(utc(2016, 6, 1)).has_value());
}

// Hourly values on the local hour at UTC+5:30 start half past the hour of UTC.
TEST(MonthGrid, PhaseCarriesHalfHourZones) {
  const MonthGrid may{calendar("Asia/Kolkata"), month(2016, 5), kHour, seconds{1800}};
  EXPECT_EQ(may.slots(), 744);
  EXPECT_EQ(may.start(0), utc(2016, 4, 30, 18, 30));
  EXPECT_EQ(may.time_of_day(0), 0);
}

// Every instant of a year belongs to exactly one slot of one month, whatever the zone does.
TEST(MonthGrid, MonthsTileTheYearWithoutHoleOrOverlap) {
  for (const char* zone : {"America/Chicago", "Australia/Lord_Howe", "America/Sao_Paulo",
                           "Asia/Beirut", "Africa/Casablanca", "Pacific/Apia", "Europe/Dublin"}) {
    SCOPED_TRACE(zone);
    const LocalCalendar zone_calendar = calendar(zone);
    for (int year : {2011, 2016, 2022}) {
      Instant expected = zone_calendar.month_span(month(year, 1)).begin;
      for (unsigned number = 1; number <= 12; ++number) {
        const MonthGrid months{zone_calendar, month(year, number), kQuarter, seconds{0}};
        EXPECT_EQ(months.start(0), expected);
        expected = months.end();
      }
      EXPECT_EQ(expected, zone_calendar.month_span(month(year + 1, 1)).begin);
    }
  }
}

}  // namespace
}  // namespace recald::metering::month_slots_test
