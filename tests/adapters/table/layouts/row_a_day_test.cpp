/// Tables with a row a day, in the many ways that portals write them, made from a truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "adapters/table/layouts/day_columns.hpp"
#include "adapters/table/layouts/guess_layout.hpp"
#include "tests/adapters/table/read_text.hpp"
#include "tests/support/sample_exports.hpp"

namespace recald::table::row_a_day_test {
namespace {

using metering::Day;
using metering::Instant;
using metering::LocalCalendar;
using std::chrono::days;
using std::chrono::minutes;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::read_text_as;
using testing::ReadText;
using ::testing::SizeIs;

/// How a header writes the interval that starts `start` minutes after midnight, the n-th of a day.
using LabelWriter = std::function<std::string(int start, int step, int n)>;

std::string two(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }
std::string clock(int minute, const std::string& sign = ":") {
  return two(minute / 60) + sign + two(minute % 60);
}

struct LabelStyle {
  const char* name;
  LabelWriter write;
};

const std::vector<LabelStyle>& styles() {
  static const std::vector<LabelStyle> all{
      {"starts", [](int start, int, int) { return clock(start); }},
      {"ends", [](int start, int step, int) { return clock(start + step); }},
      {"ends at 0:00", [](int start, int step, int) { return clock((start + step) % 1440); }},
      {"from to",
       [](int start, int step, int) { return clock(start) + "-" + clock((start + step) % 1440); }},
      {"from – to",
       [](int start, int step, int) {
         return std::to_string(start / 60) + ":" + two(start % 60) + " \xE2\x80\x93 " +
                clock(start + step);
       }},
      {"points", [](int start, int, int) { return clock(start, "."); }},
      {"h", [](int start, int, int) { return clock(start, "h"); }},
      {"seconds", [](int start, int, int) { return clock(start) + ":00"; }},
      {"in words",
       [](int start, int step, int) { return "Value " + clock(start + step) + " [kWh]"; }},
      {"hhmm", [](int start, int step,
                  int) { return "KWH_" + two((start + step) / 60) + two((start + step) % 60); }},
      {"counted", [](int, int, int n) { return std::to_string(n); }},
      {"from 0", [](int, int, int n) { return "H" + two(n - 1); }},
      {"interval", [](int, int, int n) { return "Interval " + std::to_string(n); }},
      {"Q", [](int, int, int n) { return "Q" + std::to_string(n); }},
      {"am pm",
       [](int start, int, int) {
         const int hour = start / 60 % 12 == 0 ? 12 : start / 60 % 12;
         return std::to_string(hour) + ":" + two(start % 60) + (start < 720 ? " AM" : " PM");
       }},
  };
  return all;
}

enum class ShortDay { blank, zero, at_end };
enum class LongDay { summed, further_columns, in_its_place };

struct Variant {
  const LabelStyle* style;
  int step = 15;
  ShortDay short_day = ShortDay::blank;
  LongDay long_day = LongDay::summed;
  bool newest_first = false;
  bool has_total = false;
};

constexpr const char* kZone = "Europe/Berlin";

/// The days around both clock changes.
recald::testing::ExportTruth truth_of(const Variant& variant) {
  const auto calendar = LocalCalendar::open(kZone);
  const auto use = [&](const char* first, const char* last) {
    return recald::testing::made_up_use(
        *calendar, {*metering::parse_day(first), *metering::parse_day(last), minutes{variant.step}},
        7, 20.0);
  };
  auto truth = use("2024-03-28", "2024-04-03");
  const auto autumn = use("2024-10-24", "2024-10-30");
  truth.intervals.insert(truth.intervals.end(), autumn.intervals.begin(), autumn.intervals.end());
  return truth;
}

int columns_of(const Variant& variant) {
  const int usual = 1440 / variant.step;
  return variant.long_day == LongDay::summed ? usual : usual + 60 / variant.step;
}

std::string header_of(const Variant& variant) {
  std::string text = "POD;Giorno;";
  const int in_hour = 60 / variant.step;
  int n = 0;
  for (int i = 0; i < columns_of(variant); ++i) {
    int start = i * variant.step;
    if (variant.long_day == LongDay::in_its_place && start >= 180) start -= 60;
    ++n;
    const bool counts_twice = variant.long_day == LongDay::in_its_place && i >= 3 * in_hour;
    text += variant.style->write(start, variant.step, counts_twice ? n - in_hour : n) + ";";
  }
  return text + (variant.has_total ? "Totale;kWh\n" : "kWh\n");
}

/// The cells of one day, from its intervals in order of time.
std::vector<std::string> cells_of(const Variant& variant, const std::vector<double>& values) {
  const auto usual = static_cast<std::size_t>(1440 / variant.step);
  const auto in_hour = static_cast<std::size_t>(60 / variant.step);
  std::vector<std::string> cells;
  for (const double value : values) cells.push_back(recald::testing::with_comma(value));
  const auto at = [&](std::size_t hour) {
    return cells.begin() + static_cast<std::ptrdiff_t>(hour * in_hour);
  };
  if (values.size() < usual && variant.short_day != ShortDay::at_end) {
    cells.insert(at(2), in_hour, variant.short_day == ShortDay::zero ? "0,000" : "");
  }
  if (values.size() > usual && variant.long_day == LongDay::summed) {
    for (std::size_t i = 0; i < in_hour; ++i) {
      cells[2 * in_hour + i] =
          recald::testing::with_comma(values[2 * in_hour + i] + values[3 * in_hour + i]);
    }
    cells.erase(at(3), at(4));
  }
  if (values.size() <= usual && variant.long_day == LongDay::in_its_place) {
    cells.insert(at(3), in_hour, "");
  }
  cells.resize(static_cast<std::size_t>(columns_of(variant)));
  return cells;
}

std::string table_of(const Variant& variant, const recald::testing::ExportTruth& truth) {
  const auto calendar = LocalCalendar::open(kZone);
  std::map<Day, std::vector<double>> by_day;
  for (const auto& [start, value] : truth.intervals) {
    by_day[calendar->local_time(start).date].push_back(value);
  }
  std::vector<std::string> rows;
  for (const auto& [date, values] : by_day) {
    const std::string iso = metering::to_string(date);
    std::string row =
        "IT001E1;" + iso.substr(8, 2) + "/" + iso.substr(5, 2) + "/" + iso.substr(0, 4);
    double total = 0.0;
    for (const double value : values) total += value;
    for (const std::string& cell : cells_of(variant, values)) row += ";" + cell;
    if (variant.has_total) row += ";" + recald::testing::with_comma(total);
    rows.push_back(row + ";kWh\n");
  }
  if (variant.newest_first) std::reverse(rows.begin(), rows.end());
  std::string text = header_of(variant);
  for (const std::string& row : rows) text += row;
  return text;
}

TableShape shape_of(const Variant&) {
  return {.layout = Layout::row_a_day,
          .separator = ';',
          .decimal = ',',
          .time_column = "Giorno",
          .time_format = TimeFormat::day_first};
}

ReadText read(const std::string& text, const TableShape& shape) {
  return read_text_as(text, shape, {{.rows = {.name = "use"}, .column = "value", .unit = "kWh"}},
                      *LocalCalendar::open(kZone));
}

/// Every interval of the truth, in order; the two hours of a doubled one only in their sum.
void expect_truth(const ReadText& read, const recald::testing::ExportTruth& truth,
                  const Variant& variant) {
  ASSERT_TRUE(read.report.has_value()) << read.report.error().message;
  EXPECT_EQ(read.report->issues.total, 0u)
      << (read.report->issues.listed.empty() ? "" : read.report->issues.listed.front().reason);
  ASSERT_EQ(read.readings.size(), truth.intervals.size());
  int wrong = 0;
  for (std::size_t i = 0; i < truth.intervals.size(); ++i) {
    EXPECT_EQ(read.readings[i].start, truth.intervals[i].start);
    const double kWh = read.readings[i].mean_kW * variant.step / 60.0;
    if (std::abs(kWh - truth.intervals[i].value) > 1e-9) ++wrong;
  }
  const int in_hour = 60 / variant.step;
  EXPECT_LE(wrong, variant.long_day == LongDay::summed ? 2 * in_hour : 0);
  double sum = 0.0;
  for (const auto& one : truth.intervals) sum += one.value;
  EXPECT_NEAR(read.energy(), sum, 1e-6 * sum);
}

TEST(RowADay, EachStyleOfLabelsAndEachWayOfClockChanges) {
  for (const LabelStyle& style : styles()) {
    for (const int step : {15, 30, 60}) {
      for (const ShortDay short_day : {ShortDay::blank, ShortDay::zero, ShortDay::at_end}) {
        for (const LongDay long_day :
             {LongDay::summed, LongDay::further_columns, LongDay::in_its_place}) {
          const std::string name = style.name;
          // Clock labels of further columns would go beyond midnight.
          const bool has_clock =
              name != "counted" && name != "from 0" && name != "interval" && name != "Q";
          if (long_day == LongDay::further_columns && has_clock) continue;
          // Labels stand for times then, not for the count of intervals.
          if (long_day == LongDay::in_its_place && short_day == ShortDay::at_end) continue;
          const Variant variant{&style, step, short_day, long_day};
          SCOPED_TRACE(name + ", " + std::to_string(step) + " min, " +
                       std::to_string(static_cast<int>(short_day)) +
                       std::to_string(static_cast<int>(long_day)));
          const auto truth = truth_of(variant);
          const auto outcome = read(table_of(variant, truth), shape_of(variant));
          expect_truth(outcome, truth, variant);
          EXPECT_THAT(outcome.notes, SizeIs(long_day == LongDay::summed ? 1 : 0));
        }
      }
    }
  }
}

TEST(RowADay, TheNewestDayMayComeFirstAndTotalsAreNoReadings) {
  for (const bool newest_first : {false, true}) {
    const Variant variant{&styles()[3], 15, ShortDay::blank, LongDay::summed, newest_first, true};
    const auto truth = truth_of(variant);
    const auto outcome = read(table_of(variant, truth), shape_of(variant));
    expect_truth(outcome, truth, variant);
    EXPECT_THAT(outcome.notes, Contains(HasSubstr("2024-10-27: the clock shows an hour twice")));
  }
}

/// On a clock that is never changed each day has 24 hours, also the one that others skip an hour
/// of.
TEST(RowADay, AFixedClockShowsInTheHourThatIsSkipped) {
  std::string text = "Giorno";
  for (int hour = 0; hour < 24; ++hour) text += ";" + clock(60 * hour);
  text += "\n";
  for (const char* date : {"30/03/2024", "31/03/2024", "01/04/2024"}) {
    text += date;
    for (int hour = 0; hour < 24; ++hour) text += ";" + std::to_string(10 + hour);
    text += "\n";
  }
  TableShape shape = shape_of({});
  const auto local = read(text, shape);
  EXPECT_EQ(local.clock.skipped, 1u);
  EXPECT_EQ(local.report->issues.total, 1u);
  const auto fixed =
      read_text_as(text, shape, {{.rows = {.name = "use"}, .column = "value", .unit = "kWh"}},
                   *LocalCalendar::open("Etc/GMT-1"));
  EXPECT_EQ(fixed.clock.skipped, 0u);
  EXPECT_EQ(fixed.readings.size(), 72u);
}

/// A load that rests is no reason to take one hour for another.
TEST(RowADay, ADayOfZerosIsReadAsItStands) {
  std::string text = "Giorno";
  for (int hour = 1; hour <= 25; ++hour) text += ";" + std::to_string(hour);
  text += "\n";
  for (const char* date : {"30/03/2024", "31/03/2024", "26/10/2024", "27/10/2024"}) {
    text += date;
    const std::string iso = date;
    const int hours = iso == "31/03/2024" ? 23 : iso == "27/10/2024" ? 25 : 24;
    for (int hour = 0; hour < 25; ++hour) text += hour < hours ? ";0" : ";";
    text += "\n";
  }
  const auto outcome = read(text, shape_of({}));
  ASSERT_TRUE(outcome.report.has_value());
  EXPECT_EQ(outcome.readings.size(), 24u + 23u + 24u + 25u);
  EXPECT_EQ(outcome.report->issues.total, 0u);
}

TEST(RowADay, FlagsBetweenTheValuesAreACol) {
  std::string text = "MPAN,Date";
  for (int i = 1; i <= 48; ++i) text += ",HH" + std::to_string(i) + ",HH" + std::to_string(i) + "F";
  text += "\n1200,2024-01-15";
  for (int i = 1; i <= 48; ++i) text += "," + std::to_string(i) + (i == 5 ? ",E" : ",A");
  text += "\n";
  const TableShape shape{.layout = Layout::row_a_day, .separator = ',', .time_column = "Date"};
  const auto rows = layout_rows(delimited_rows(csv::bytes_of(text), ','), shape, nullptr);
  const auto kept = testing::kept_rows(*rows);
  ASSERT_EQ(kept.size(), 49u);
  EXPECT_EQ(kept[0].cells,
            (std::vector<std::string>{"timestamp", "value", "flag", "MPAN", "Date"}));
  EXPECT_EQ(kept[5].cells,
            (std::vector<std::string>{"2024-01-15T02:00:00", "5", "E", "1200", "2024-01-15"}));
}

TEST(RowADay, AFewTimesOrOtherNumbersAreNoDay) {
  const auto found = [](std::vector<std::string_view> header) {
    return find_day_columns(header).has_value();
  };
  std::vector<std::string> names;
  for (int i = 1; i <= 31; ++i) names.push_back(std::to_string(i));  // days of a month
  EXPECT_FALSE(found({names.begin(), names.end()}));
  names.resize(24);
  EXPECT_TRUE(found({names.begin(), names.end()}));
  names[7] = "7";
  EXPECT_FALSE(found({names.begin(), names.end()}));
}

TEST(RowADay, WhatIsMissingIsSaid) {
  EXPECT_THAT(read("a;b\n1;2\n", shape_of({})).report.error().message,
              HasSubstr("no row names the times of a day"));
  const Variant variant{&styles()[0]};
  const auto truth = truth_of(variant);
  TableShape shape = shape_of(variant);
  shape.time_column = "Datum";
  EXPECT_THAT(read(table_of(variant, truth), shape).report.error().message,
              HasSubstr("no column 'Datum'"));
}

/// Guessed from the head of the table, then read as guessed.
TEST(RowADay, IsGuessedWithItsMetersAndUnits) {
  for (const LabelStyle& style : styles()) {
    SCOPED_TRACE(style.name);
    Variant variant{&style, 15, ShortDay::blank, LongDay::summed, false, true};
    const auto truth = truth_of(variant);
    const std::string text = table_of(variant, truth);
    const auto rows = delimited_rows(csv::bytes_of(text), ';');
    const auto layout = guess_layout(testing::kept_rows(*rows));
    ASSERT_TRUE(layout.has_value());
    EXPECT_EQ(layout->layout, Layout::row_a_day);
    auto guess = guess_table(layout->rows);
    ASSERT_TRUE(guess.has_value()) << guess.error().message;
    settle_layout(*layout, *guess);
    EXPECT_EQ(guess->shape.time_column, "Giorno");
    EXPECT_EQ(guess->shape.time_format, TimeFormat::day_first);
    EXPECT_EQ(guess->shape.decimal, ',');
    EXPECT_EQ(guess->shape.layout, Layout::row_a_day);
    ASSERT_THAT(guess->values, SizeIs(1));
    EXPECT_EQ(guess->values[0].column, "value");
    guess->shape.separator = ';';
    guess->shape.meter_column.clear();
    guess->shape.unit_column.clear();
    expect_truth(read(text, guess->shape), truth, variant);
  }
}

TEST(RowADay, ATableOfRowsIsNone) {
  std::vector<KeptRow> rows{{1, {"Time", "Main", "Side"}}};
  for (int i = 0; i < 40; ++i) {
    rows.push_back({static_cast<std::uint64_t>(i + 2),
                    {"2024-01-01 " + clock(15 * i), std::to_string(i), "3"}});
  }
  EXPECT_FALSE(guess_layout(rows).has_value());
}

}  // namespace
}  // namespace recald::table::row_a_day_test
