/// Every clock change of thirteen zones from 2000 to 2100: days and months tile time, and offsets
/// are those that the C library reads from the same zone files with code of its own.
#include <gtest/gtest.h>

#include <set>

#include "c_library_zone.hpp"
#include "core/metering/civil_time.hpp"
#include "month_builder.hpp"

namespace recald::metering::zone_changes_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using std::chrono::sys_days;
using testing::calendar;
using testing::CLibraryZone;
using testing::month;
using testing::utc;

Day day(int year, unsigned number, unsigned d) { return month(year, number) / std::chrono::day{d}; }

struct Zone {
  const char* name;
  std::set<int> slots;        ///< Quarter hours that its days had from 2000 to 2024.
  int days_without_midnight;  ///< Of them.
};

void PrintTo(const Zone& zone, std::ostream* out) { *out << zone.name; }

class ZoneChanges : public ::testing::TestWithParam<Zone> {
 protected:
  static constexpr Day kFirst = sys_days{std::chrono::year{2000} / 1 / 1};
  /// What comes later some decree may change yet.
  static constexpr Day kDecided = sys_days{std::chrono::year{2024} / 12 / 31};
  static constexpr Day kLast = sys_days{std::chrono::year{2100} / 12 / 30};
  LocalCalendar calendar_ = calendar(GetParam().name);
};

TEST_P(ZoneChanges, OffsetsAreThoseOfTheCLibrary) {
  const CLibraryZone zone{GetParam().name};
  for (Instant t = utc(2000, 1, 1); t < utc(2100, 12, 31); t += hours{1}) {
    const seconds offset = calendar_.utc_offset(t);
    ASSERT_EQ(offset, zone.utc_offset(t)) << to_string(t);
    if (calendar_.utc_offset(t + hours{1}) == offset) continue;
    for (Instant near = t; near <= t + hours{1}; near += seconds{30}) {
      ASSERT_EQ(calendar_.utc_offset(near), zone.utc_offset(near)) << to_string(near);
    }
  }
}

// Each day begins where the one before ends, is a whole number of slots, and shows its own date.
TEST_P(ZoneChanges, DaysTileTime) {
  std::set<int> slots;
  int without_midnight = 0;
  Instant expected = calendar_.day_span(kFirst).begin;
  for (Day date = kFirst; date <= kLast; date = sys_days{date} + days{1}) {
    const TimeSpan span = calendar_.day_span(date);
    ASSERT_EQ(span.begin, expected) << to_string(date);
    expected = span.end;
    ASSERT_EQ(span.length() % minutes{15}, seconds{0}) << to_string(date);
    if (date <= kDecided) slots.insert(static_cast<int>(span.length() / minutes{15}));
    if (span.length() == seconds{0}) continue;
    const LocalTime begin = calendar_.local_time(span.begin);
    ASSERT_EQ(begin.date, date);
    ASSERT_EQ(calendar_.local_time(span.end - seconds{1}).date, date);
    ASSERT_LT(calendar_.local_time(span.begin - seconds{1}).date, date);
    without_midnight += static_cast<int>(date <= kDecided && begin.minute_of_day != 0);
  }
  EXPECT_EQ(slots, GetParam().slots);
  EXPECT_EQ(without_midnight, GetParam().days_without_midnight);
}

// A month is its days, and its grid gives each of them the slots that it lasts.
TEST_P(ZoneChanges, MonthsAreTheirDays) {
  for (Month m = month(2000, 1); m < month(2100, 12); m = next_month(m)) {
    const MonthGrid grid{calendar_, m, minutes{15}, seconds{0}};
    ASSERT_EQ(grid.start(0), calendar_.day_span(m / std::chrono::day{1}).begin) << to_string(m);
    ASSERT_EQ(grid.end(), calendar_.day_span(next_month(m) / std::chrono::day{1}).begin);
    const std::vector<int>& begins = grid.day_begins();
    for (int d = 0; d < grid.days(); ++d) {
      const auto index = static_cast<std::size_t>(d);
      const TimeSpan span = calendar_.day_span(m / std::chrono::day{static_cast<unsigned>(d + 1)});
      ASSERT_EQ((begins[index + 1] - begins[index]) * minutes{15}, span.length())
          << to_string(m) << " day " << d + 1;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Zones, ZoneChanges,
    ::testing::Values(
        Zone{"America/Chicago", {92, 96, 100}, 0}, Zone{"America/New_York", {92, 96, 100}, 0},
        Zone{"Europe/Berlin", {92, 96, 100}, 0},
        // Half an hour, and a zone whose offset is no whole hour.
        Zone{"Australia/Lord_Howe", {94, 96, 98}, 0}, Zone{"Pacific/Chatham", {92, 96, 100}, 0},
        Zone{"Asia/Kathmandu", {96}, 0},
        // Moved its offset by half an hour, once each way.
        Zone{"America/Caracas", {94, 96, 98}, 0},
        // Crossed the date line: a day that never was.
        Zone{"Pacific/Apia", {0, 92, 96, 100}, 1},
        // Change at midnight: days that begin at one o'clock.
        Zone{"America/Sao_Paulo", {92, 96, 100}, 19}, Zone{"Africa/Cairo", {92, 96, 100}, 16},
        Zone{"Asia/Beirut", {92, 96, 100}, 25}, Zone{"America/Havana", {92, 96, 100}, 23},
        // Winter time in Ramadan.
        Zone{"Africa/Casablanca", {92, 96, 100}, 4}),
    [](const auto& zone) {
      std::string name = zone.param.name;
      std::erase_if(name, [](char c) { return c == '/' || c == '_'; });
      return name;
    });

struct FirstInstant {
  const char* zone;
  Day date;
  Instant begin;
  int minute_of_day;  ///< That the wall clock shows then.
  int slots;
};

// Facts of single dates, from the decrees rather than from the zone files.
TEST(MidnightMissing, TheDayBeginsAtItsFirstInstant) {
  const std::vector<FirstInstant> facts{
      {"America/Sao_Paulo", day(2018, 11, 4), utc(2018, 11, 4, 3), 60, 92},
      {"Africa/Cairo", day(2023, 4, 28), utc(2023, 4, 27, 22), 60, 92},
      {"Africa/Cairo", day(2023, 10, 26), utc(2023, 10, 25, 21), 0, 100},
      {"Asia/Beirut", day(2016, 3, 27), utc(2016, 3, 26, 22), 60, 92},
      {"America/Havana", day(2015, 3, 8), utc(2015, 3, 8, 5), 60, 92},
      {"Pacific/Apia", day(2011, 12, 31), utc(2011, 12, 30, 10), 0, 96},
      {"Pacific/Apia", day(2011, 12, 29), utc(2011, 12, 29, 10), 0, 96},
  };
  for (const FirstInstant& fact : facts) {
    SCOPED_TRACE(std::string{fact.zone} + " " + to_string(fact.date));
    const LocalCalendar zone = calendar(fact.zone);
    const TimeSpan span = zone.day_span(fact.date);
    EXPECT_EQ(span.begin, fact.begin) << to_string(span.begin);
    EXPECT_EQ(zone.local_time(span.begin).minute_of_day, fact.minute_of_day);
    EXPECT_EQ(span.length() / minutes{15}, fact.slots);
  }
}

}  // namespace
}  // namespace recald::metering::zone_changes_test
