/// Tables whose times, or days, run across the header.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/table/layouts/guess_layout.hpp"
#include "tests/adapters/table/read_text.hpp"
#include "tests/support/sample_exports.hpp"

namespace recald::table::column_a_time_test {
namespace {

using metering::LocalCalendar;
using std::chrono::minutes;
using ::testing::HasSubstr;
using testing::read_text_as;
using testing::ReadText;

recald::testing::ExportTruth truth_of(const char* first, const char* last, unsigned seed,
                                      int step) {
  return recald::testing::made_up_use(
      *LocalCalendar::open("Europe/Berlin"),
      {*metering::parse_day(first), *metering::parse_day(last), minutes{step}}, seed, 5.0);
}

std::vector<TableMeter> named(const std::vector<std::string>& names) {
  std::vector<TableMeter> meters;
  for (const std::string& name : names)
    meters.push_back({.rows = {.name = name}, .column = "value"});
  return meters;
}

void expect_truth(const ReadText& read, const recald::testing::ExportTruth& truth,
                  std::uint32_t meter) {
  ASSERT_TRUE(read.report.has_value()) << read.report.error().message;
  EXPECT_EQ(read.report->issues.total, 0u);
  std::size_t i = 0;
  for (const metering::Reading& reading : read.readings) {
    if (reading.meter != meter) continue;
    ASSERT_LT(i, truth.intervals.size());
    EXPECT_EQ(reading.start, truth.intervals[i].start);
    EXPECT_NEAR(reading.mean_kW * metering::in_hours(read.report->meters[meter].shown.interval),
                truth.intervals[i].value, 1e-9);
    ++i;
  }
  EXPECT_EQ(i, truth.intervals.size());
}

/// Two meters, a row each; stamps as `pattern` has them, or in UTC with a Z.
std::string across(const recald::testing::ExportTruth& one,
                   const recald::testing::ExportTruth& other, const std::string& pattern) {
  const auto berlin = *LocalCalendar::open("Europe/Berlin");
  std::string text = "entity,unit";
  for (const auto& interval : one.intervals) {
    text += "," + (pattern.empty() ? metering::to_string(interval.start)
                                   : recald::testing::clock_text(berlin, interval.start, pattern));
  }
  for (const auto& [name, truth] : {std::pair{"in", &one}, std::pair{"out", &other}}) {
    text += std::string{"\n"} + name + ",kWh";
    for (const auto& interval : truth->intervals) {
      text += "," + recald::testing::with_point(interval.value);
    }
  }
  return text + "\n";
}

TEST(ColumnATime, GuessedAndReadOverBothClockChanges) {
  for (const char* pattern : {"", "%Y-%m-%d %H:%M", "%d.%m.%Y %H:%M", "%m/%d/%Y %H:%M"}) {
    for (const char* last : {"2024-03-29", "2024-04-01"}) {  // 5 days, 8 days: one skips an hour
      SCOPED_TRACE(std::string{pattern} + last);
      const auto one = truth_of("2024-03-25", last, 1, 60);
      const auto other = truth_of("2024-03-25", last, 2, 60);
      const std::string text = across(one, other, pattern);
      const auto rows = delimited_rows(csv::bytes_of(text), ',', kWideRows);
      const auto layout = guess_layout(testing::kept_rows(*rows));
      ASSERT_TRUE(layout.has_value());
      auto guess = guess_table(layout->rows);
      ASSERT_TRUE(guess.has_value()) << guess.error().message;
      settle_layout(*layout, *guess);
      guess->shape.separator = ',';
      EXPECT_EQ(guess->shape.layout, Layout::column_a_time);
      EXPECT_EQ(guess->shape.meter_column, "entity");
      EXPECT_EQ(guess->shape.unit_column, "unit");
      const auto read = read_text_as(text, guess->shape, named({"in", "out"}),
                                     *LocalCalendar::open("Europe/Berlin"));
      expect_truth(read, one, 0);
      expect_truth(read, other, 1);
    }
  }
}

/// A year of quarters of an hour is 35 136 columns: longer and wider than other tables may be.
TEST(ColumnATime, AYearMayRunAcross) {
  const auto year = truth_of("2024-01-01", "2024-12-31", 3, 15);
  const std::string text = across(year, year, "%Y-%m-%d %H:%M");
  const TableShape shape{.layout = Layout::column_a_time,
                         .separator = ',',
                         .time_column = "timestamp",
                         .meter_column = "entity",
                         .unit_column = "unit"};
  const auto read =
      read_text_as(text, shape, named({"out"}), *LocalCalendar::open("Europe/Berlin"));
  expect_truth(read, year, 0);
}

/// Days across, times of the day below each other.
TEST(ColumnATime, AColumnADayIsTurned) {
  const auto berlin = *LocalCalendar::open("Europe/Berlin");
  const auto truth = truth_of("2024-03-25", "2024-04-05", 4, 15);
  std::map<std::string, std::map<std::string, double>> cells;
  for (const auto& [start, value] : truth.intervals) {
    const std::string date = recald::testing::clock_text(berlin, start, "%d.%m.%Y");
    cells[recald::testing::clock_text(berlin, start, "%H:%M")][date] = value;
  }
  std::string text = "Zeit";
  std::vector<std::string> dates;
  for (int day = 25; day < 37; ++day) {
    dates.push_back(day < 32 ? std::to_string(day) + ".03.2024"
                             : "0" + std::to_string(day - 31) + ".04.2024");
    text += ";" + dates.back();
  }
  for (const auto& [time, values] : cells) {
    text += "\n" + time;
    for (const std::string& date : dates) {
      const auto found = values.find(date);
      text += ";" + (found == values.end() ? "" : recald::testing::with_comma(found->second));
    }
  }
  text += "\n";
  const auto rows = delimited_rows(csv::bytes_of(text), ';', kWideRows);
  const auto layout = guess_layout(testing::kept_rows(*rows));
  ASSERT_TRUE(layout.has_value());
  auto guess = guess_table(layout->rows);
  ASSERT_TRUE(guess.has_value()) << guess.error().message;
  settle_layout(*layout, *guess);
  guess->shape.separator = ';';
  EXPECT_EQ(guess->shape.clock_column, "Zeit");
  const auto read = read_text_as(
      text, guess->shape, {{.rows = {.name = "use"}, .column = "value", .unit = "kWh"}}, berlin);
  expect_truth(read, truth, 0);
}

TEST(ColumnATime, WhatIsMissingIsSaid) {
  const TableShape shape{
      .layout = Layout::column_a_time, .separator = ',', .time_column = "timestamp"};
  const auto read = read_text_as("a,b\n1,2\n", shape, named({""}), *LocalCalendar::open("Etc/UTC"));
  EXPECT_THAT(read.report.error().message, HasSubstr("no row has times written as yyyy-mm-dd"));
}

}  // namespace
}  // namespace recald::table::column_a_time_test
