#include "adapters/table/read_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "adapters/table/delimited.hpp"

namespace recald::table::read_table_test {
namespace {

using metering::LocalCalendar;
using metering::Reading;
using ::testing::HasSubstr;

struct Outcome {
  Result<csv::ReadingsReport> report;
  std::vector<Reading> readings;
  ClockFacts clock;
};

Outcome read(std::string_view text, const TableShape& shape, const std::vector<TableMeter>& meters,
             const char* zone = "Europe/Berlin") {
  const auto calendar = LocalCalendar::open(zone);
  Outcome outcome{csv::ReadingsReport{}, {}, {}};
  const csv::ReadingsSink sink{
      .on_meter = {}, .on_reading = [&](const Reading& r) { outcome.readings.push_back(r); }};
  const auto rows = delimited_rows(csv::bytes_of(text), shape.separator);
  outcome.report = read_table(*rows, "export.csv", shape, meters, *calendar, sink, &outcome.clock);
  return outcome;
}

TableShape portal() {
  return {.separator = ';',
          .decimal = ',',
          .time_column = "Zeit",
          .time_format = TimeFormat::day_first};
}

TableMeter column(const std::string& name, const std::string& unit = "kWh") {
  return {.rows = {.name = name}, .column = name, .unit = unit};
}

constexpr std::string_view kPortal =
    "Rathaus;Lastgang\n"
    "\n"
    "Zeit;Ost;West\n"
    ";kWh;kWh\n"
    "01.02.2024 00:00;1,5;10\n"
    "01.02.2024 00:15;2,5;\n"
    "Zeit;Ost;West\n"
    "01.02.2024 00:30;1.003,5;12\n";

TEST(ReadTable, HeadAndUnitsAndHeadersAgainAreNoRows) {
  const Outcome outcome = read(kPortal, portal(), {column("Ost"), column("West")});
  ASSERT_TRUE(outcome.report.has_value()) << outcome.report.error().message;
  EXPECT_EQ(outcome.report->issues.total, 0u);
  EXPECT_EQ(outcome.report->lines, 3u);
  ASSERT_EQ(outcome.readings.size(), 6u);
  EXPECT_EQ(metering::to_string(outcome.readings[0].start), "2024-01-31T23:00:00Z");
  EXPECT_DOUBLE_EQ(outcome.readings[0].mean_kW, 6.0);
  EXPECT_DOUBLE_EQ(outcome.readings[2].mean_kW, 4014.0);
  EXPECT_TRUE(std::isnan(outcome.readings[4].mean_kW));  // a blank is listed as such
}

TEST(ReadTable, AColumnMayBeNamedByItsNumber) {
  TableShape shape = portal();
  shape.time_column = "#1";
  TableMeter meter = column("#3");
  const Outcome outcome = read("01.02.2024 00:00;1;7\n01.02.2024 00:15;1;8\n", shape, {meter});
  ASSERT_EQ(outcome.readings.size(), 2u);
  EXPECT_DOUBLE_EQ(outcome.readings[1].mean_kW, 32.0);
}

TEST(ReadTable, ABadRowSaysWhichAndWhyAndWhatItWas) {
  const std::string text = std::string{kPortal} + "soon;1;2\n01.02.2024 00:45;many;13\n";
  const Outcome outcome = read(text, portal(), {column("Ost"), column("West")});
  ASSERT_EQ(outcome.report->issues.total, 2u);
  EXPECT_EQ(outcome.report->issues.listed[0].line, 9u);
  EXPECT_EQ(outcome.report->issues.listed[0].reason, "timestamp 'soon' is not dd/mm/yyyy");
  EXPECT_EQ(outcome.report->issues.listed[0].text, "soon;1;2");
  EXPECT_THAT(outcome.report->issues.listed[1].reason,
              HasSubstr("meter 'Ost': 'many' is no number with a decimal comma"));
  EXPECT_EQ(outcome.report->meters[0].refused, 1u);
  EXPECT_EQ(outcome.report->meters[1].refused, 0u);
}

TEST(ReadTable, NoSuchColumnNamesTheNearestOrAll) {
  EXPECT_EQ(read(kPortal, portal(), {column("Osts")}).report.error().message,
            "'export.csv' has no column 'Osts'; did you mean 'Ost'?");
  EXPECT_EQ(read(kPortal, portal(), {column("chiller")}).report.error().message,
            "'export.csv' has no column 'chiller'; it has 'Zeit', 'Ost', 'West'");
  EXPECT_EQ(read("", portal(), {column("Ost")}).report.error().message, "'export.csv' is empty");
}

TEST(ReadTable, ATimeThatTheClockJumpsOverIsRefused) {
  const std::string text =
      "Zeit;Ost\n31.03.2024 01:00;1\n31.03.2024 02:00;1\n31.03.2024 03:00;1\n31.03.2024 04:00;1\n";
  const Outcome outcome = read(text, portal(), {column("Ost")});
  EXPECT_EQ(outcome.clock.skipped, 1u);
  EXPECT_EQ(outcome.clock.naive, 4u);
  ASSERT_EQ(outcome.report->issues.total, 1u);
  EXPECT_THAT(outcome.report->issues.listed[0].reason,
              HasSubstr("does not exist in Europe/Berlin"));
  TableShape winter = portal();
  winter.timezone = "Etc/GMT-1";
  EXPECT_EQ(read(text, winter, {column("Ost")}).readings.size(), 4u);
  winter.timezone = "Mars";
  EXPECT_EQ(read(text, winter, {column("Ost")}).report.error().code, ErrorCode::not_found);
}

// Portals that list the newest row first: read from the end, the hour that comes twice included.
TEST(ReadTable, FromNewToOld) {
  const std::string text =
      "Zeit;Ost\n27.10.2024 03:00;5\n27.10.2024 02:00;4\n27.10.2024 02:00;3\n"
      "27.10.2024 01:00;2\nsoon;1\n27.10.2024 00:00;1\n";
  const Outcome outcome = read(text, portal(), {column("Ost")});
  ASSERT_EQ(outcome.readings.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(outcome.readings[i].mean_kW, static_cast<double>(i + 1));
    EXPECT_EQ(outcome.readings[i].start,
              outcome.readings[0].start + std::chrono::hours{1} * static_cast<int>(i));
  }
  ASSERT_EQ(outcome.report->issues.total, 1u);
  EXPECT_EQ(outcome.report->issues.listed[0].line, 6u);
  EXPECT_EQ(outcome.report->issues.listed[0].text, "soon;1");
}

TEST(ReadTable, ALongFileFromNewToOld) {
  std::string text = "Zeit;Ost\n";
  for (int row = 499; row >= 0; --row) {
    const int hour = row % 24;
    const int date = row / 24 + 1;
    text += (date < 10 ? "0" : "") + std::to_string(date) + ".06.2024 " + (hour < 10 ? "0" : "") +
            std::to_string(hour) + ":00;" + std::to_string(row) + "\n";
  }
  const Outcome outcome = read(text, portal(), {column("Ost")});
  ASSERT_EQ(outcome.readings.size(), 500u);
  EXPECT_EQ(outcome.report->issues.total, 0u);
  for (std::size_t i = 0; i < 500; ++i) {
    EXPECT_DOUBLE_EQ(outcome.readings[i].mean_kW, static_cast<double>(i));
  }
}

// 12,5 may have been 12,55: a last line without its end counts only when it surely is whole.
TEST(ReadTable, ALastLineThatMayBeCutIsKeptOut) {
  const std::string rows = "Zeit;Ost\n01.02.2024 00:00;12,25\n01.02.2024 00:15;12,50\n";
  EXPECT_EQ(read(rows + "01.02.2024 00:30;12,75", portal(), {column("Ost")}).readings.size(), 3u);
  const Outcome cut = read(rows + "01.02.2024 00:30;12,7", portal(), {column("Ost")});
  EXPECT_EQ(cut.readings.size(), 2u);
  EXPECT_THAT(cut.report->issues.listed.at(0).reason, HasSubstr("may be cut"));
}

TEST(ReadTable, RowsOfALongTableGoToTheirMeters) {
  TableShape shape{
      .separator = ',', .time_column = "time", .meter_column = "point", .unit_column = "unit"};
  std::vector<TableMeter> meters{column("a", ""), column("b", "")};
  for (TableMeter& meter : meters) meter.column = "value";
  const Outcome outcome = read(
      "time,point,value,unit\n"
      "2024-01-01T00:00:00Z,a,1,kWh\n2024-01-01T00:00:00Z,b,2,MWh\n"
      "2024-01-01T00:15:00Z,a,3,kWh\n2024-01-01T00:15:00Z,b,4,MWh\n"
      "2024-01-01T00:15:00Z,c,4,MWh\n2024-01-01T00:30:00Z,a,3,furlong\n",
      shape, meters);
  ASSERT_TRUE(outcome.report.has_value()) << outcome.report.error().message;
  ASSERT_EQ(outcome.readings.size(), 4u);
  EXPECT_DOUBLE_EQ(outcome.readings[2].mean_kW, 8000.0);
  EXPECT_EQ(outcome.report->others.words(),
            "1 meter is not configured, and its lines were left out: c (1)");
  EXPECT_THAT(outcome.report->issues.listed.at(0).reason, HasSubstr("'furlong' is not known"));
}

TEST(ReadTable, MoreColumnsThanSixtyFour) {
  std::string header = "Zeit";
  std::string first = "01.02.2024 00:00";
  std::string second = "01.02.2024 00:15";
  std::vector<TableMeter> meters;
  for (int i = 0; i < 200; ++i) {
    const std::string name = "m" + std::to_string(i);
    header += ";" + name;
    first += ";" + std::to_string(i);
    second += ";1";
    meters.push_back(column(name, "kW"));
  }
  const Outcome outcome = read(header + "\n" + first + "\n" + second + "\n", portal(), meters);
  ASSERT_EQ(outcome.readings.size(), 400u);
  EXPECT_DOUBLE_EQ(outcome.readings[2 * 199].mean_kW, 199.0);
}

TEST(ReadTable, Utf16AndLatin1AreUnderstood) {
  std::string wide{"\xFF\xFE"};
  for (const char c : std::string{kPortal}) wide += {c, '\0'};
  EXPECT_EQ(read(wide, portal(), {column("Ost")}).readings.size(), 3u);
  const Outcome outcome = read("Zeit;Gas m\xB3\n01.02.2024 00:00;1\n01.02.2024 00:15;1\n", portal(),
                               {column("Gas m\xC2\xB3")});
  EXPECT_EQ(outcome.readings.size(), 2u);
}

// The file cut at every byte: nothing is read that was not there.
TEST(ReadTable, CutAnywhereItReadsWhatIsWhole) {
  const Outcome whole = read(kPortal, portal(), {column("Ost")});
  for (std::size_t length = 0; length < kPortal.size(); ++length) {
    const Outcome cut = read(kPortal.substr(0, length), portal(), {column("Ost")});
    ASSERT_LE(cut.readings.size(), whole.readings.size());
    for (std::size_t i = 0; i < cut.readings.size(); ++i) {
      EXPECT_EQ(cut.readings[i].mean_kW, whole.readings[i].mean_kW) << length;
    }
  }
}

}  // namespace
}  // namespace recald::table::read_table_test
