/// Ends of intervals where clocks are changed: as the clock shows them, or as the begin's time plus
/// the length, in zones and layouts drawn by program.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "read_text.hpp"

namespace recald::table::ends_at_change_test {
namespace {

using metering::Instant;
using metering::LocalCalendar;
using std::chrono::minutes;
using testing::read_text_as;
using testing::ReadText;

enum class Written { by_clock, by_begin, by_begin_sorted };

struct Change {
  const char* zone;
  const char* noon_before;  ///< UTC.
};

const std::vector<Change> kChanges{{"Europe/Berlin", "2024-03-30T12:00:00Z"},
                                   {"Europe/Berlin", "2024-10-26T12:00:00Z"},
                                   {"America/Chicago", "2024-03-09T18:00:00Z"},
                                   {"America/Chicago", "2024-11-02T18:00:00Z"},
                                   {"Australia/Lord_Howe", "2024-04-06T02:00:00Z"},
                                   {"Australia/Lord_Howe", "2024-10-05T02:00:00Z"}};

std::string local_text(Instant as_if_utc) {
  std::string text = metering::to_string(as_if_utc);
  text[10] = ' ';
  return text.substr(0, 16);
}

Instant instant(const char* text) { return parse_stamp(text, TimeFormat::year_first)->clock; }

/// Two meters of two days; a value is the number of its interval.
struct Export {
  std::string text;
  std::vector<Instant> begins;
};

enum class Layout { columns, in_turn, one_after_the_other };

Export export_of(const Change& change, minutes step, Written written, Layout layout) {
  const auto calendar = LocalCalendar::open(change.zone);
  struct Row {
    std::string stamp;
    std::size_t number;
  };
  std::vector<Row> rows;
  Export made;
  const Instant first = instant(change.noon_before);
  for (Instant begin = first; begin < first + std::chrono::hours{24}; begin += step) {
    const Instant of = written == Written::by_clock ? begin + step : begin;
    const Instant shown = begin + step + calendar->utc_offset(of);
    rows.push_back({local_text(shown), made.begins.size()});
    made.begins.push_back(begin);
  }
  if (written == Written::by_begin_sorted) {
    std::ranges::stable_sort(rows, {}, &Row::stamp);
  }
  const auto line = [](const Row& row, const std::string& meter) {
    return row.stamp + ";" + meter + ";" + std::to_string(row.number) + "\n";
  };
  if (layout == Layout::columns) {
    made.text = "time;a;b\n";
    for (const Row& row : rows) made.text += line(row, std::to_string(row.number));
    return made;
  }
  made.text = "time;meter;value\n";
  for (const Row& row : rows) {
    made.text += line(row, "a");
    if (layout == Layout::in_turn) made.text += line(row, "unknown") + line(row, "b");
  }
  if (layout == Layout::in_turn) return made;
  for (const Row& row : rows) made.text += line(row, "b");
  return made;
}

ReadText read(const Export& made, const Change& change, minutes step, Layout layout) {
  TableShape shape{.separator = ';', .time_column = "time"};
  std::vector<TableMeter> meters;
  for (const char* name : {"a", "b"}) {
    meters.push_back({.rows = {.name = name, .stamps = csv::Stamps::end, .interval = step},
                      .column = layout == Layout::columns ? name : "value",
                      .unit = "kW"});
  }
  if (layout != Layout::columns) shape.meter_column = "meter";
  return read_text_as(made.text, shape, meters, *LocalCalendar::open(change.zone));
}

TEST(EndsAtChange, EachIntervalIsWhereItBegan) {
  for (const Change& change : kChanges) {
    for (const int step : {5, 15, 30, 60}) {
      // Where the clock moves by half an hour, hours of it have no common grid.
      if (step == 60 && std::string{change.zone} == "Australia/Lord_Howe") continue;
      for (const Written written :
           {Written::by_clock, Written::by_begin, Written::by_begin_sorted}) {
        for (const Layout layout :
             {Layout::columns, Layout::in_turn, Layout::one_after_the_other}) {
          SCOPED_TRACE(std::string{change.zone} + " " + change.noon_before + ", every " +
                       std::to_string(step) + " min, written " +
                       std::to_string(static_cast<int>(written)) + ", layout " +
                       std::to_string(static_cast<int>(layout)));
          const Export made = export_of(change, minutes{step}, written, layout);
          const ReadText read_back = read(made, change, minutes{step}, layout);
          ASSERT_TRUE(read_back.report) << read_back.report.error().message;
          // Sorted by what is written, times run back and forth, which is told.
          if (written != Written::by_begin_sorted) {
            EXPECT_EQ(read_back.report->issues.total, 0u);
          }
          ASSERT_EQ(read_back.readings.size(), 2 * made.begins.size());
          for (const metering::Reading& reading : read_back.readings) {
            EXPECT_EQ(reading.start, made.begins[static_cast<std::size_t>(reading.mean_kW)]);
          }
        }
      }
    }
  }
}

// Tables of 24 hours a day have the hour that the clock skips as well, blank or zero.
TEST(EndsAtChange, AnHourThatIsSkippedMayBeWritten) {
  const Change& change = kChanges.front();
  for (const int step : {15, 30, 60}) {
    for (const char* empty : {"", "0", "0.000"}) {
      SCOPED_TRACE(std::string{empty} + " every " + std::to_string(step));
      Export made = export_of(change, minutes{step}, Written::by_begin, Layout::columns);
      std::string hour;
      for (int past = step; past <= 60; past += step) {
        const Instant end = instant("2024-03-31T02:00:00Z") + minutes{past};
        hour += local_text(end) + ";" + empty + ";" + empty + "\n";
      }
      const std::size_t behind = made.text.find("2024-03-31 03:");
      const std::size_t four = made.text.find("2024-03-31 04:");
      made.text.insert(std::min(behind, four), hour);
      const ReadText read_back = read(made, change, minutes{step}, Layout::columns);
      ASSERT_TRUE(read_back.report) << read_back.report.error().message;
      std::size_t values = 0;
      for (const metering::Reading& reading : read_back.readings) {
        if (std::isnan(reading.mean_kW)) continue;
        ++values;
        EXPECT_EQ(reading.start, made.begins[static_cast<std::size_t>(reading.mean_kW)]);
      }
      EXPECT_EQ(values, 2 * made.begins.size());
    }
  }
}

// The labels of a clock that stays on winter time have rows of their own in the hour that others
// skip: none of them may be taken for the end before it.
TEST(EndsAtChange, AClockThatIsNotChangedIsNotMistakenForIt) {
  for (const int step : {15, 60}) {
    SCOPED_TRACE(step);
    std::string text = "time;a;b\n";
    const Instant first = instant("2024-03-31T00:00:00Z");
    for (Instant end = first; end < first + std::chrono::hours{6}; end += minutes{step}) {
      text += local_text(end) + ";1;1\n";
    }
    const ReadText read_back =
        read({.text = text, .begins = {}}, kChanges.front(), minutes{step}, Layout::columns);
    ASSERT_TRUE(read_back.report) << read_back.report.error().message;
    EXPECT_EQ(read_back.clock.skipped, static_cast<std::uint64_t>(60 / step));
  }
}

}  // namespace
}  // namespace recald::table::ends_at_change_test
