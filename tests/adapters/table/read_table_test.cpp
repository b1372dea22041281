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

TEST(ReadTable, AFirstColumnWithoutAName) {
  TableShape shape{.separator = ',', .time_column = "#1"};
  const Outcome outcome = read(
      "Export;of a notebook\n,main_kWh,ahu_kWh\n2025-09-01 00:00:00+02:00,2.5,0.5\n"
      "2025-09-01 00:15:00+02:00,2.5,0.5\n,main_kWh,ahu_kWh\n2025-09-01 00:30:00+02:00,3,1\n",
      shape, {column("main_kWh"), column("ahu_kWh")});
  ASSERT_TRUE(outcome.report.has_value()) << outcome.report.error().message;
  ASSERT_EQ(outcome.readings.size(), 6u);
  EXPECT_EQ(outcome.report->issues.total, 0u);
  EXPECT_EQ(metering::to_string(outcome.readings[0].start), "2025-08-31T22:00:00Z");
}

// A row without a time, as a sum below the table has none, is no header though that has no name.
TEST(ReadTable, ASumWithoutATimeIsRefused) {
  TableShape shape{.separator = ',', .time_column = "#1"};
  const Outcome outcome =
      read(",main_kWh\n2025-09-01 00:00:00Z,2.5\n2025-09-01 00:15:00Z,2.5\n,5\n", shape,
           {column("main_kWh")});
  EXPECT_EQ(outcome.readings.size(), 2u);
  EXPECT_EQ(outcome.report->issues.total, 1u);
}

TEST(ReadTable, NamesMayHaveLineBreaksAndWideBlanks) {
  TableShape shape{.separator = ',', .time_column = "Time", .time_format = TimeFormat::month_first};
  const Outcome outcome = read(
      "Time,\"Main meter\n(kW)\",AHU\xC2\xA0"
      "1\n09/01/2025 00:00,1,2\n09/01/2025 00:30,1,2\n",
      shape, {column("Main meter (kW)", "kW"), column("AHU 1", "kW")});
  ASSERT_TRUE(outcome.report.has_value()) << outcome.report.error().message;
  EXPECT_EQ(outcome.readings.size(), 4u);
}

TEST(ReadTable, CellsMayHaveTheirOwnUnits) {
  TableShape shape{.separator = ',', .time_column = "Time"};
  const Outcome outcome = read(
      "Time,Main\n2025-09-01 00:00,980 W\n2025-09-01 00:30,1.25 kW\n2025-09-01 01:00,2\n"
      "2025-09-01 01:30,0.5 MW\n2025-09-01 02:00,7 parsecs\n2025-09-01 02:30,{fault}\n",
      shape, {column("Main", "kW")});
  ASSERT_TRUE(outcome.report.has_value());
  ASSERT_EQ(outcome.readings.size(), 5u);
  for (const auto& [index, kW] : {std::pair{0, 0.98}, {1, 1.25}, {2, 2.0}, {3, 500.0}}) {
    EXPECT_DOUBLE_EQ(outcome.readings[static_cast<std::size_t>(index)].mean_kW, kW);
  }
  EXPECT_TRUE(std::isnan(outcome.readings[4].mean_kW));
  ASSERT_EQ(outcome.report->issues.total, 1u);
  EXPECT_THAT(outcome.report->issues.listed[0].reason, HasSubstr("'7 parsecs' is no number"));
  EXPECT_EQ(outcome.clock.words, 1u);
  EXPECT_EQ(outcome.clock.first_word, "{fault}");
}

TEST(ReadTable, LettersOfAZoneTellTheDoubledHourApart) {
  TableShape shape{.separator = ',', .time_column = "Time", .time_format = TimeFormat::day_first};
  const std::string rows =
      "Time,Main\n02-Nov-25 12:30:00 AM EDT,1\n02-Nov-25 01:00:00 AM EDT,2\n"
      "02-Nov-25 01:30:00 AM EDT,3\n02-Nov-25 01:00:00 AM EST,4\n02-Nov-25 01:30:00 AM EST,5\n";
  const Outcome outcome = read(rows, shape, {column("Main")}, "America/New_York");
  ASSERT_EQ(outcome.readings.size(), 5u);
  EXPECT_EQ(outcome.clock.naive, 0u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(outcome.readings[i].start,
              outcome.readings[0].start + std::chrono::minutes{30} * static_cast<int>(i));
  }
  // EST is also Sydney's: five hours behind UTC would be wrong there.
  const Outcome far = read(rows, shape, {column("Main")}, "Australia/Sydney");
  EXPECT_EQ(far.readings.size(), 0u);
  EXPECT_THAT(far.report->issues.listed.at(0).reason,
              HasSubstr("stand for UTC-04:00, far from Australia/Sydney"));
}

/// Hours of a day with their labels, "label;hour number from 1".
std::string labelled_day(const std::string& date, const std::vector<int>& labels) {
  std::string rows;
  int number = 0;
  for (const int label : labels) {
    rows += date + ";" + std::to_string(label) + ";" + std::to_string(++number) + "\n";
  }
  return rows;
}

// Days of 23 and 25 hours: by the count, and by the clock whose hour comes twice or not at all.
TEST(ReadTable, LabelsOfHoursAreInstants) {
  std::vector<int> count_25;
  std::vector<int> count_23;
  std::vector<int> clock_25;
  std::vector<int> clock_23;
  for (int label = 1; label <= 25; ++label) {
    count_25.push_back(label);
    if (label <= 23) count_23.push_back(label);
    if (label <= 24 && label != 3) clock_23.push_back(label);
    if (label <= 24) clock_25.push_back(label);
    if (label == 3) clock_25.push_back(label);
  }
  TableShape shape{.separator = ';',
                   .time_column = "Fecha",
                   .clock_column = "Hora",
                   .interval = std::chrono::hours{1},
                   .time_format = TimeFormat::day_first};
  for (const auto& [format, date, labels, first] :
       {std::tuple{ClockFormat::interval_number, "26/10/2025", count_25, "2025-10-25T22:00:00Z"},
        {ClockFormat::interval_number, "30/03/2025", count_23, "2025-03-29T23:00:00Z"},
        {ClockFormat::hour_ending, "26/10/2025", clock_25, "2025-10-25T22:00:00Z"},
        {ClockFormat::hour_ending, "30/03/2025", clock_23, "2025-03-29T23:00:00Z"}}) {
    SCOPED_TRACE(date);
    shape.clock_format = format;
    const Outcome outcome = read("Fecha;Hora;kWh\n" + labelled_day(date, labels), shape,
                                 {column("kWh")}, "Europe/Madrid");
    ASSERT_EQ(outcome.readings.size(), labels.size());
    EXPECT_EQ(metering::to_string(outcome.readings[0].start), first);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      EXPECT_EQ(outcome.readings[i].start,
                outcome.readings[0].start + std::chrono::hours{1} * static_cast<int>(i));
      EXPECT_DOUBLE_EQ(outcome.readings[i].mean_kW, static_cast<double>(i + 1));
    }
  }
  shape.clock_format = ClockFormat::interval_number;
  const Outcome many = read("Fecha;Hora;kWh\n" + labelled_day("27/10/2025", count_25), shape,
                            {column("kWh")}, "Europe/Madrid");
  EXPECT_EQ(many.readings.size(), 24u);
  EXPECT_THAT(many.report->issues.listed.at(0).reason, HasSubstr("number '25' is more than"));
  shape.clock_format = ClockFormat::hour_ending;
  const Outcome odd = read("Fecha;Hora;kWh\n27/10/2025;1;1\n27/10/2025;2;1\n27/10/2025;noon;1\n",
                           shape, {column("kWh")}, "Europe/Madrid");
  EXPECT_THAT(odd.report->issues.listed.at(0).reason, HasSubstr("'noon' in column 'Hora'"));
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
