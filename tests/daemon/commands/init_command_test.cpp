/// Exports of other programs, one command to a site file, and the months that it leads to: those
/// of the truth that the exports were made from.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../command_line.hpp"
#include "adapters/table/table_shape.hpp"
#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::init_command_test {
namespace {

using metering::Day;
using metering::Instant;
using metering::LocalCalendar;
using recald::testing::clock_text;
using recald::testing::ExportSpan;
using recald::testing::ExportTruth;
using recald::testing::made_up_use;
using recald::testing::read_text;
using recald::testing::with_comma;
using recald::testing::with_point;
using recald::testing::write_text;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::run;

constexpr double kBtu_kWh = 1055.05585262 / 3.6e6;
constexpr double kTonHour_kWh = 12'000.0 * kBtu_kWh;

Day day(const std::string& text) { return *metering::parse_day(text); }
LocalCalendar zone(const std::string& name) { return *LocalCalendar::open(name); }

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in{line};
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

class Init : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::filesystem::path site() const { return path("site/site.toml"); }

  Outcome init(const std::string& file, const std::string& timezone = "") {
    std::vector<std::string> words{"init", path(file).string(), "--out", path("site").string()};
    if (!timezone.empty()) words.insert(words.end(), {"--timezone", timezone});
    return run(words);
  }

  /// kWh by meter and month, as `replay` has them.
  std::map<std::string, std::map<std::string, double>> replayed() {
    const Outcome outcome = run({"replay", site().string(), "--out", path("results").string()});
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    std::map<std::string, std::map<std::string, double>> energies;
    std::ifstream in{path("results") / "months.csv"};
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      const std::vector<std::string> fields = fields_of(line);
      const double daily_kWh = fields.at(2).empty() ? 0.0 : std::stod(fields.at(2));
      energies[fields.at(1)][fields.at(0)] =
          daily_kWh * metering::days_in(*metering::parse_month(fields.at(0)));
    }
    return energies;
  }

  /// Every month of the truth, to a ten-thousandth.
  static void expect_months(const std::map<std::string, double>& months, const ExportTruth& truth,
                            double kWh_per_unit) {
    EXPECT_EQ(months.size(), truth.month_sums.size());
    for (const auto& [month, sum] : truth.month_sums) {
      SCOPED_TRACE(month);
      ASSERT_TRUE(months.contains(month));
      EXPECT_NEAR(months.at(month), sum * kWh_per_unit, 1e-4 * sum * kWh_per_unit);
    }
  }

  /// Refused in one sentence, with nothing written.
  void expect_refused(const std::string& name, const std::string& text,
                      const std::string& sentence) {
    write_text(path(name), text);
    const Outcome outcome = init(name, "Europe/Berlin");
    EXPECT_EQ(outcome.exit_code, kFailure) << outcome.out << read_if_there();
    EXPECT_THAT(outcome.err, HasSubstr(sentence));
    EXPECT_THAT(outcome.err, HasSubstr(name));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("site")));
  }

  [[nodiscard]] std::string read_if_there() const {
    return std::filesystem::exists(site()) ? read_text(site()) : "";
  }

  recald::testing::TemporaryFolder folder_;
};

// A German portal: words above the header, day and time apart, ends of intervals, a clock change.
TEST_F(Init, PortalWithDecimalCommaAndDaysFirst) {
  const LocalCalendar berlin = zone("Europe/Berlin");
  const ExportTruth truth =
      made_up_use(berlin, {day("2024-02-01"), day("2024-03-31"), minutes{15}}, 1, 25.0);
  std::string text = "Lastgang;Rathaus\r\n\r\nDatum;Uhrzeit;Wirkarbeit (kWh);Status\r\n";
  for (const auto& [start, value] : truth.intervals) {
    const Instant end = start + minutes{15};
    text += clock_text(berlin, end, "%d.%m.%Y;%H:%M") + ";" + with_comma(value) + ";W\r\n";
  }
  write_text(path("portal.csv"), text);
  const Outcome outcome = init("portal.csv", "Europe/Berlin");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const std::string written = read_text(site());
  EXPECT_THAT(written,
              AllOf(HasSubstr("separator = \";\""), HasSubstr("decimal = \",\""),
                    HasSubstr("time_format = \"dd/mm/yyyy\""),
                    HasSubstr("clock_column = \"Uhrzeit\""), HasSubstr("stamps = \"end\"")));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Wrote "), HasSubstr("recald report "),
                                 HasSubstr("columns not used: Status (text)")));
  expect_months(replayed().at("wirkarbeit"), truth, 1.0);
}

// Dates are cells with a format; the first floor and the second are the whole.
TEST_F(Init, WideWorkbookWithASum) {
  const LocalCalendar new_york = zone("America/New_York");
  const ExportSpan span{day("2023-10-01"), day("2023-12-31"), minutes{60}};
  const ExportTruth first = made_up_use(new_york, span, 1, 40.0);
  const ExportTruth second = made_up_use(new_york, span, 2, 30.0);
  const ExportTruth chilled = made_up_use(new_york, span, 3, 55.0);
  ExportTruth whole = first;
  std::vector<recald::testing::WorkbookRow> rows;
  whole.month_sums.clear();
  for (std::size_t i = 0; i < first.intervals.size(); ++i) {
    const Instant t = first.intervals[i].start;
    const double sum = first.intervals[i].value + second.intervals[i].value;
    whole.month_sums[metering::to_string(new_york.month_of(t))] += sum;
    rows.push_back(
        {recald::testing::spreadsheet_day(new_york, t),
         {sum, first.intervals[i].value, second.intervals[i].value, chilled.intervals[i].value}});
  }
  recald::testing::write_workbook(
      path("meters.xlsx"), {"Time", "Main kWh", "Floor 1 kWh", "Floor 2 kWh", "CHW [ton-hours]"},
      rows);
  const Outcome outcome = init("meters.xlsx", "America/New_York");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const std::string written = read_text(site());
  EXPECT_THAT(written, AllOf(HasSubstr("format = \"xlsx\""), HasSubstr("sheet = \"Meters\""),
                             HasSubstr("sum_of = [\"floor-1\", \"floor-2\"]"),
                             HasSubstr("utility = \"chilled_water\"")));
  const auto months = replayed();
  expect_months(months.at("main"), whole, 1.0);
  expect_months(months.at("floor-1"), first, 1.0);
  expect_months(months.at("floor-2"), second, 1.0);
  expect_months(months.at("chw"), chilled, kTonHour_kWh);
}

std::string feed_of(const ExportTruth& truth) {
  const std::string base = "https://portal.example/espi/1_1/resource/";
  const std::string reading = base + "Subscription/5/UsagePoint/1/MeterReading/7";
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<feed xmlns=\"http://www.w3.org/2005/Atom\">"
      "<entry><link rel=\"self\" href=\"" +
      base +
      "Subscription/5/UsagePoint/1\"/><content><espi:UsagePoint xmlns:espi=\"http://naesb.org/"
      "espi\"><espi:ServiceCategory><espi:kind>0</espi:kind></espi:ServiceCategory>"
      "</espi:UsagePoint></content></entry><entry><link rel=\"self\" href=\"" +
      reading + "\"/><link rel=\"related\" href=\"" + base +
      "ReadingType/3\"/><title>Grid</title><content><espi:MeterReading xmlns:espi=\"http://"
      "naesb.org/espi\"/></content></entry>";
  constexpr std::size_t kBlock = 96;
  // The newest block first, as portals have it; a whole number of thousandths of a kWh is a Wh.
  for (std::size_t end = truth.intervals.size(); end > 0;) {
    const std::size_t begin = end > kBlock ? end - kBlock : 0;
    text += "<entry><link rel=\"self\" href=\"" + reading + "/IntervalBlock/" +
            std::to_string(end) + "\"/><link rel=\"up\" href=\"" + reading +
            "/IntervalBlock\"/><content><espi:IntervalBlock xmlns:espi=\"http://naesb.org/espi\">";
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [start, value] = truth.intervals[i];
      text +=
          "<espi:IntervalReading><espi:timePeriod><espi:duration>900</espi:duration>"
          "<espi:start>" +
          std::to_string(start.time_since_epoch().count()) +
          "</espi:start></espi:timePeriod><espi:value>" +
          std::to_string(std::llround(value * 1000.0)) + "</espi:value></espi:IntervalReading>";
    }
    text += "</espi:IntervalBlock></content></entry>\n";
    end = begin;
  }
  return text + "<entry><link rel=\"self\" href=\"" + base +
         "ReadingType/3\"/><content><espi:ReadingType xmlns:espi=\"http://naesb.org/espi\">"
         "<espi:accumulationBehaviour>4</espi:accumulationBehaviour><espi:intervalLength>900"
         "</espi:intervalLength><espi:powerOfTenMultiplier>0</espi:powerOfTenMultiplier>"
         "<espi:uom>72</espi:uom></espi:ReadingType></content></entry></feed>";
}

TEST_F(Init, GreenButton) {
  const LocalCalendar pacific = zone("America/Los_Angeles");
  const ExportTruth truth =
      made_up_use(pacific, {day("2024-02-01"), day("2024-03-31"), minutes{15}}, 4, 12.0);
  write_text(path("usage.xml"), feed_of(truth));
  const Outcome outcome = init("usage.xml", "America/Los_Angeles");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()),
              AllOf(HasSubstr("format = \"green_button\""),
                    HasSubstr("name_in_file = \"UsagePoint/1/MeterReading/7\"")));
  expect_months(replayed().at("grid"), truth, 1.0);
}

// The register starts at some value and stands there at the end of each hour.
TEST_F(Init, CumulativeRegister) {
  const LocalCalendar london = zone("Europe/London");
  const ExportTruth truth =
      made_up_use(london, {day("2024-01-01"), day("2024-02-29"), minutes{60}}, 5, 80.0);
  std::string text = "timestamp_utc,Heat meter [kWh]\n";
  double stands = 123'456.0;
  text += metering::to_string(truth.intervals.front().start) + "," + with_point(stands) + "\n";
  for (const auto& [start, value] : truth.intervals) {
    stands += value;
    text += metering::to_string(start + minutes{60}) + "," + with_point(stands) + "\n";
  }
  write_text(path("register.csv"), text);
  const Outcome outcome = init("register.csv", "Europe/London");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()),
              AllOf(HasSubstr("counter = { unit = \"kWh\" }"), HasSubstr("utility = \"heating\"")));
  EXPECT_THAT(outcome.out, HasSubstr("taken for a cumulative register"));
  expect_months(replayed().at("heat-meter"), truth, 1.0);
}

TEST_F(Init, NaiveStampsOverBothClockChanges) {
  const LocalCalendar berlin = zone("Europe/Berlin");
  const ExportTruth truth =
      made_up_use(berlin, {day("2024-03-01"), day("2024-11-30"), minutes{60}}, 6, 33.0);
  std::string text = "time,load kW\n";
  for (const auto& [start, value] : truth.intervals) {
    text += clock_text(berlin, start, "%Y-%m-%d %H:%M:%S") + "," + with_point(value) + "\n";
  }
  write_text(path("naive.csv"), text);
  ASSERT_EQ(init("naive.csv", "Europe/Berlin").exit_code, kSuccess);
  expect_months(replayed().at("load"), truth, 1.0);
}

TEST_F(Init, HourlyGasInMmbtuWithMonthsFirst) {
  const LocalCalendar chicago = zone("America/Chicago");
  const ExportTruth truth =
      made_up_use(chicago, {day("2023-11-01"), day("2024-01-31"), minutes{60}}, 7, 2.0);
  std::string text = "Date/Time,Natural Gas (MMBtu)\n";
  for (const auto& [start, value] : truth.intervals) {
    text += clock_text(chicago, start, "%m/%d/%Y %I:%M:%S %p") + "," + with_point(value) + "\n";
  }
  write_text(path("gas.csv"), text);
  const Outcome outcome = init("gas.csv", "America/Chicago");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()),
              AllOf(HasSubstr("time_format = \"mm/dd/yyyy\""), HasSubstr("utility = \"gas\""),
                    HasSubstr("unit = \"MMBtu\"")));
  expect_months(replayed().at("natural-gas"), truth, 1e6 * kBtu_kWh);
}

// --- What is decided by the whole file. ---

// Winter time all year: the hour of spring that summer time does not have, and once that of autumn.
TEST_F(Init, AClockThatIsNeverChanged) {
  const LocalCalendar berlin = zone("Europe/Berlin");
  const LocalCalendar winter = zone("Etc/GMT-1");
  const ExportTruth truth =
      made_up_use(berlin, {day("2024-03-01"), day("2024-11-30"), minutes{60}}, 8, 10.0);
  std::string text = "time,load kW\n";
  for (const auto& [start, value] : truth.intervals) {
    text += clock_text(winter, start, "%Y-%m-%d %H:%M") + "," + with_point(value) + "\n";
  }
  write_text(path("winter.csv"), text);
  ASSERT_EQ(init("winter.csv", "Europe/Berlin").exit_code, kSuccess);
  EXPECT_THAT(read_text(site()), HasSubstr("timezone = \"Etc/GMT-1\""));
  expect_months(replayed().at("load"), truth, 1.0);
}

/// A table with a date and a number for each hour, counted as `format` says.
std::string with_hour_numbers(const LocalCalendar& calendar, const ExportTruth& truth,
                              table::ClockFormat format) {
  std::string text = "cups;fecha;hora;consumo_kWh;precio\n";
  std::string last_date;
  int number = 0;
  for (const auto& [start, value] : truth.intervals) {
    const std::string date = clock_text(calendar, start, "%d/%m/%Y");
    number = date == last_date ? number + 1 : 1;
    last_date = date;
    const int shown = std::stoi(clock_text(calendar, start, "%H")) + 1;
    text += "ES0099000000000001XX;" + date + ";" +
            std::to_string(format == table::ClockFormat::hour_ending ? shown : number) + ";" +
            with_comma(value) + ";0,12\n";
  }
  return text;
}

// Both changes of the clock, spring's alone, and none: whatever is counted, each hour is where it
// was.
TEST_F(Init, HourNumbers) {
  const LocalCalendar madrid = zone("Europe/Madrid");
  int number = 0;
  for (const auto& [first, last] : {std::pair{"2025-03-01", "2025-11-30"},
                                    {"2025-03-01", "2025-04-30"},
                                    {"2025-06-01", "2025-06-30"}}) {
    for (const auto format :
         {table::ClockFormat::hour_ending, table::ClockFormat::interval_number}) {
      SCOPED_TRACE(std::string{first} + " " + std::string{to_string(format)});
      const ExportTruth truth = made_up_use(madrid, {day(first), day(last), minutes{60}}, 11, 12.0);
      const std::string name = "hours" + std::to_string(++number) + ".csv";
      write_text(path(name), with_hour_numbers(madrid, truth, format));
      std::filesystem::remove_all(path("site"));
      const Outcome outcome = init(name, "Europe/Madrid");
      ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
      const bool has_change = std::string{first} != "2025-06-01";
      const auto written = has_change ? format : table::ClockFormat::interval_number;
      EXPECT_THAT(read_text(site()),
                  AllOf(HasSubstr("clock_format = \"" + std::string{to_string(written)} + "\""),
                        HasSubstr("stamps = \"start\""), Not(HasSubstr("Etc/GMT"))));
      EXPECT_THAT(outcome.out, HasSubstr("precio (money)"));
      expect_months(replayed().at("consumo"), truth, 1.0);
    }
  }
}

// On the day of 23 hours all 24 have a value: nothing says which is too many.
TEST_F(Init, HourNumbersThatNothingDecidesAreRefused) {
  std::string text = "fecha;hora;consumo_kWh\n";
  for (int date = 1; date <= 31; ++date) {
    for (int hour = 1; hour <= 24; ++hour) {
      text += (date < 10 ? "0" : "") + std::to_string(date) + "/03/2025;" + std::to_string(hour) +
              ";1,5\n";
    }
  }
  expect_refused(
      "hours.csv", text,
      "column 'hora' counts hours or intervals, but its labels on 2025-03-30, a day of 23 "
      "hours, do not show what they count in Europe/Berlin");
}

// The letters of the zone tell the doubled hour apart, in a file that begins with the newest row
// too.
TEST_F(Init, LettersOfAZone) {
  const LocalCalendar new_york = zone("America/New_York");
  const ExportTruth truth =
      made_up_use(new_york, {day("2025-10-01"), day("2025-11-30"), minutes{15}}, 12, 10.0);
  std::string text = "Timestamp,Trend Flags,Status,Value (kW-hr)\n";
  for (auto at = truth.intervals.rbegin(); at != truth.intervals.rend(); ++at) {
    const Instant end = at->start + minutes{15};
    const bool is_summer = new_york.utc_offset(end) == std::chrono::hours{-4};
    text += clock_text(new_york, end, "%d-%b-%y %I:%M:%S %p") + (is_summer ? " EDT" : " EST") +
            ",{ },{ok}," + with_point(at->value) + "\n";
  }
  write_text(path("history.csv"), text);
  const Outcome outcome = init("history.csv", "America/New_York");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  expect_months(replayed().at("value"), truth, 1.0);
}

// A meter after the other, each with its unit.
TEST_F(Init, LongTable) {
  const LocalCalendar berlin = zone("Europe/Berlin");
  const ExportSpan span{day("2024-05-01"), day("2024-05-31"), minutes{15}};
  const ExportTruth east = made_up_use(berlin, span, 9, 10.0);
  const ExportTruth heat = made_up_use(berlin, span, 10, 0.02);
  std::string text = "Sensor\tZeit\tWert\tEinheit\n";
  for (const auto& [start, value] : east.intervals) {
    text += "Ost\t" + clock_text(berlin, start, "%d.%m.%Y %H:%M") + "\t" + with_comma(value) +
            "\tkWh\n";
  }
  for (const auto& [start, value] : heat.intervals) {
    text += "W\xC3\xA4rme\t" + clock_text(berlin, start, "%d.%m.%Y %H:%M") + "\t" +
            with_comma(value) + "\tMWh\n";
  }
  write_text(path("long.txt"), text);
  const Outcome outcome = init("long.txt", "Europe/Berlin");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()),
              AllOf(HasSubstr("separator = \"tab\""), HasSubstr("meter_column = \"Sensor\""),
                    HasSubstr("unit_column = \"Einheit\"")));
  const auto months = replayed();
  expect_months(months.at("ost"), east, 1.0);
  expect_months(months.at("waerme"), heat, 1000.0);
}

std::string own_rows(int count) {
  std::string text = "timestamp,meter,value,unit\n";
  Instant t = std::chrono::sys_days{day("2024-01-01")};
  for (int i = 0; i < count; ++i, t += minutes{15}) {
    text += metering::to_string(t) + ",main," + std::to_string(10 + i % 7) + ",kW\n";
  }
  return text;
}

TEST_F(Init, ItsOwnFormatIsOneAmongThem) {
  write_text(path("readings.csv"), own_rows(96 * 31));
  const Outcome outcome = init("readings.csv");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()),
              AllOf(HasSubstr("name_in_file = \"main\""), Not(HasSubstr("time_column")),
                    HasSubstr("timezone = \"Etc/UTC\"")));
  EXPECT_THAT(outcome.out, HasSubstr("The time zone is taken for Etc/UTC"));
  EXPECT_EQ(replayed().at("main").size(), 1u);
}

TEST_F(Init, DatesThatNothingDecidesAreRefused) {
  std::string text = "when,kWh\n";
  for (int hour = 0; hour < 24; ++hour) {
    text += "03/04/2024 " + std::string(hour < 10 ? "0" : "") + std::to_string(hour) + ":00," +
            std::to_string(hour % 5) + ".5\n";
  }
  expect_refused("day.csv", text, "it may be mm/dd/yyyy; a day after the 12th");
}

/// A cool year, as an EPW file. Hours are the ends of their intervals.
std::string cool_year_epw() {
  std::string text =
      "LOCATION,Dresden,SN,Germany,X,104880,51.13,13.75,1.0,222.0\nDESIGN CONDITIONS,0\n"
      "TYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\n"
      "COMMENTS 1,\nCOMMENTS 2,\nDATA PERIODS,1,1,Data,Friday, 1/ 1,12/31\n";
  const std::chrono::sys_days begin{std::chrono::year{2021} / 1 / 1};
  for (int day = 0; day < 365; ++day) {
    const std::chrono::year_month_day date{begin + std::chrono::days{day}};
    for (int hour = 1; hour <= 24; ++hour) {
      text += fmt::format(
          "2021,{},{},{},0,?9,{:.1f},1.0,50,98000,9999,9999,300,100,200,50,0,0,0,0,270,3.5,0,0,16,"
          "77777,9,999999999,5,0.0,0,88,0,0,0\n",
          static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), hour,
          9.0 - 9.0 * std::cos(day * 0.0172));
    }
  }
  return text;
}

class InitStarter : public Init {
 protected:
  InitStarter() {
    std::string text = "timestamp,meter,value,unit\n";
    const std::chrono::sys_days begin{std::chrono::year{2021} / 1 / 1};
    for (int hour = 0; hour < 24 * 200; ++hour) {
      const std::string stamp = metering::to_string(begin + std::chrono::hours{hour});
      text += fmt::format("{},main,{:.2f},kW\n", stamp, 40.0 + hour % 24 + std::sin(1.3 * hour));
      text += fmt::format("{},heat,{:.2f},kW\n", stamp, 30.0 + std::cos(1.3 * hour));
    }
    write_text(path("readings.csv"), text);
    write_text(path("place.epw"), cool_year_epw());
  }
  Outcome start(std::vector<std::string> more) {
    std::vector<std::string> words{"init", path("readings.csv").string(), "--out",
                                   path("site").string()};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
};

TEST_F(InitStarter, AddsWeatherAndATypicalBuilding) {
  const Outcome outcome = start({"--epw", path("place.epw").string(), "--use", "office", "--area",
                                 "7800", "--storeys", "3", "--built", "1985"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const std::string text = read_text(site());
  EXPECT_THAT(text, AllOf(HasSubstr("latitude_deg = 51.13"), HasSubstr("file = \"../place.epw\""),
                          HasSubstr("climate zone 5 (ASHRAE 90.1-1989"),
                          HasSubstr("calibration = { from = \"2021-01\", to = \"2021-06\" }"),
                          HasSubstr("outputs = [\"main\", \"heat\"]")));
  EXPECT_EQ(run({"check", site().string()}).exit_code, kSuccess);
}

TEST_F(InitStarter, TheWeatherAloneMakesNoModel) {
  ASSERT_EQ(start({"--epw", path("place.epw").string()}).exit_code, kSuccess);
  EXPECT_THAT(read_text(site()), AllOf(HasSubstr("[weather]"), Not(HasSubstr("[[model]]"))));
}

TEST_F(InitStarter, WeatherOfAnotherContinentIsRefused) {
  const Outcome outcome =
      start({"--epw", path("place.epw").string(), "--timezone", "America/Chicago"});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("is weather of"), HasSubstr("America/Chicago")));
  EXPECT_FALSE(std::filesystem::exists(path("site")));
}

TEST_F(InitStarter, WhatCannotBeIsRefusedWithNothingWritten) {
  EXPECT_EQ(start({"--use", "office", "--area", "7800"}).exit_code, kUsage);
  EXPECT_EQ(
      start({"--epw", path("place.epw").string(), "--use", "castle", "--area", "7800"}).exit_code,
      kUsage);
  const Outcome small =
      start({"--epw", path("place.epw").string(), "--use", "office", "--area", "2"});
  EXPECT_EQ(small.exit_code, kFailure);
  EXPECT_THAT(small.err, HasSubstr("a floor area of 2 m2 cannot be"));
  EXPECT_EQ(start({"--epw", path("none.epw").string()}).exit_code, kFailure);
  EXPECT_FALSE(std::filesystem::exists(site()));
}

TEST_F(Init, JsonNamesMetersAndTheNextCommand) {
  write_text(path("readings.csv"), own_rows(200));
  const Outcome outcome =
      run({"init", path("readings.csv").string(), "--out", path("site").string(), "--timezone",
           "Europe/Berlin", "--json", "--yes"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("meters").at(0).at("meter"), "main");
  EXPECT_EQ(json.at("meters").at(0).at("interval_s"), 900);
  EXPECT_THAT(json.at("next").get<std::string>(), HasSubstr("recald report "));
}

// --- Bad input: one sentence each, nothing half-written. ---

TEST_F(Init, EmptyAndBinaryAndMissingFiles) {
  expect_refused("empty.csv", "", "it is empty");
  expect_refused("blank.csv", "\n\n", "it is empty");
  expect_refused("binary.csv", std::string("\x7F\x45\x4C\x46\x02\x01\x00\x00zz", 10), "no text");
  expect_refused("old.xls", "\xD0\xCF\x11\xE0 and so on", ".xls workbook of the old kind");
  expect_refused("broken.xlsx", "PK\x03\x04 and no more", "is not .xlsx");
  expect_refused("page.xml", "<html><body>Log in</body></html>", "no interval readings");
  const Outcome missing = init("nowhere.csv");
  EXPECT_EQ(missing.exit_code, kFailure);
  EXPECT_THAT(missing.err, HasSubstr("does not exist"));
}

std::string hours_of_june(const std::function<std::string(int)>& value) {
  std::string text;
  for (int hour = 0; hour < 30 * 24; ++hour) {
    const int in_day = hour % 24;
    const int date = hour / 24 + 1;
    text += "2024-06-" + std::string(date < 10 ? "0" : "") + std::to_string(date) + " " +
            (in_day < 10 ? "0" : "") + std::to_string(in_day) + ":00," + value(hour) + "\n";
  }
  return text;
}

std::string plain_value(int hour) { return std::to_string(hour % 9) + ".25"; }

// A file a year, the newest row first in one of them: one meter, and no gap at the seam.
TEST_F(Init, YearsInFilesOfTheirOwn) {
  const LocalCalendar berlin = zone("Europe/Berlin");
  const ExportTruth truth =
      made_up_use(berlin, {day("2023-11-01"), day("2024-02-29"), minutes{15}}, 7, 25.0);
  std::vector<std::string> old_rows;
  std::string new_rows;
  double counted_kWh = 5000.0;
  std::string first_register;
  std::string second_register;
  for (const auto& [start, value] : truth.intervals) {
    const std::string clock = clock_text(berlin, start, "%d/%m/%Y %H:%M");
    const std::string row = clock + ";" + with_comma(value) + "\n";
    const std::string count = clock + ";" + with_comma(counted_kWh) + "\n";
    counted_kWh += value;
    if (clock.find("/2023") != std::string::npos) {
      old_rows.push_back(row);
      first_register += count;
    } else {
      new_rows += row;
      second_register += count;
    }
  }
  std::reverse(old_rows.begin(), old_rows.end());
  std::string old_text;
  for (const std::string& row : old_rows) old_text += row;
  write_text(path("2024.csv"), "Time;Main (kWh)\n" + new_rows);
  write_text(path("2023.csv"), "Time;Main (kWh)\n" + old_text);
  write_text(path("r2023.csv"), "Time;Register (kWh)\n" + first_register);
  write_text(path("r2024.csv"), "Time;Register (kWh)\n" + second_register);
  const Outcome outcome = run({"init", path("2024.csv").string(), path("r2024.csv").string(),
                               path("2023.csv").string(), path("r2023.csv").string(), "--out",
                               path("site").string(), "--timezone", "Europe/Berlin"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("with 2 meters"));
  EXPECT_THAT(read_text(site()), HasSubstr("file = [\"../2023.csv\", \"../2024.csv\"]"));
  auto months = replayed();
  expect_months(months.at("main"), truth, 1.0);
  // Of the register's last interval nobody knows the end.
  months.at("register").erase("2024-02");
  EXPECT_NEAR(months.at("register").at("2023-12"), truth.month_sums.at("2023-12"), 0.5);
  EXPECT_NEAR(months.at("register").at("2024-01"), truth.month_sums.at("2024-01"), 0.5);
}

// Hourly amounts in a second file would be taken for those of quarters of an hour.
TEST_F(Init, AFileOfAnotherIntervalIsRefused) {
  const auto rows = [](const std::string& month, int step_minutes) {
    std::string text = "Time,Main (kWh)\n";
    for (int minute = 0; minute < 20 * 1440; minute += step_minutes) {
      text += fmt::format("2024-{}-{:02} {:02}:{:02},{}\n", month, minute / 1440 + 1,
                          minute / 60 % 24, minute % 60, plain_value(minute));
    }
    return text;
  };
  write_text(path("june.csv"), rows("06", 15));
  write_text(path("july.csv"), rows("07", 60));
  ASSERT_EQ(init("june.csv", "Europe/Berlin").exit_code, kSuccess);
  std::string text = read_text(site());
  const std::string one = "file = \"../june.csv\"";
  text.replace(text.find(one), one.size(), "file = [\"../june.csv\", \"../july.csv\"]");
  write_text(site(), text);
  const Outcome outcome = run({"replay", site().string(), "--out", path("results").string()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("july.csv"), HasSubstr("does not come every 15 minutes "
                                                                  "as in the file before")));
}

// Two rows of names are one: what stands above a name is a part of it.
TEST_F(Init, TwoHeaders) {
  write_text(path("two.csv"),
             "Site,East,West\nTime,Main kWh,Light kWh\n" + hours_of_june([](int hour) {
               return plain_value(hour) + "," + plain_value(hour + 4);
             }));
  const Outcome outcome = init("two.csv", "Europe/Berlin");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()),
              AllOf(HasSubstr("id = \"east-main\""), HasSubstr("id = \"west-light\""),
                    HasSubstr("column = \"Main kWh\""), HasSubstr("unit = \"kWh\"")));
}

// A row of units below the names is no second header.
TEST_F(Init, ARowOfUnitsIsUnderstood) {
  write_text(path("units.csv"), "Time,Main\n,kWh\n" + hours_of_june(plain_value));
  const Outcome outcome = init("units.csv", "Europe/Berlin");
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()), HasSubstr("unit = \"kWh\"                     # as row 2 says"));
  EXPECT_EQ(replayed().at("main").size(), 1u);
}

TEST_F(Init, MixedFormats) {
  std::string mixed = "Time,kWh\n";
  for (int hour = 0; hour < 48; ++hour) {
    const std::string clock = (hour % 24 < 10 ? "0" : "") + std::to_string(hour % 24) + ":00";
    mixed += hour < 24 ? "2024-06-21 " + clock + ",1.5\n" : "22/06/2024 " + clock + ",1.5\n";
  }
  expect_refused("dates.csv", mixed, "its dates change their format");
  expect_refused("numbers.csv", "Time,Main\n" + hours_of_june([](int hour) {
                                  return hour % 2 == 0 ? "\"1,25\"" : plain_value(hour);
                                }),
                 "its numbers change their decimal sign");
}

TEST_F(Init, TextInThePlaceOfNumbers) {
  expect_refused("text.csv",
                 "Time,State\n" + hours_of_june([](int) { return std::string{"running"}; }),
                 "no column has numbers");
  expect_refused("notimes.csv", "a,b\n1,2\n3,1\n", "no column has dates and times");
}

TEST_F(Init, StampsOutOfOrder) {
  std::vector<std::string> lines;
  std::istringstream in{hours_of_june(plain_value)};
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  for (std::size_t i = 0; i + 1 < lines.size(); i += 2) std::swap(lines[i], lines[i + 1]);
  std::string text = "Time,kWh\n";
  for (const std::string& line : lines) text += line + "\n";
  expect_refused("mixed.csv", text, "its stamps are out of order");
}

TEST_F(Init, NaiveStampsNeedAZone) {
  write_text(path("naive.csv"), "Time,kWh\n" + hours_of_june(plain_value));
  const Outcome outcome = init("naive.csv");
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, HasSubstr("run again with --timezone"));
  EXPECT_FALSE(std::filesystem::exists(path("site")));
  EXPECT_EQ(init("naive.csv", "Mars/Olympus").exit_code, kUsage);
}

TEST_F(Init, AFileNamedTwiceIsRefused) {
  write_text(path("main.csv"), "Time,kWh\n" + hours_of_june(plain_value));
  const std::string file = path("main.csv").string();
  const Outcome outcome =
      run({"init", file, file, "--out", path("site").string(), "--timezone", "Europe/Berlin"});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_THAT(outcome.err, HasSubstr("is named twice"));
}

TEST_F(Init, AnExportInThePlaceOfASiteFileLeadsToInit) {
  write_text(path("main.csv"), "Time,kWh\n" + hours_of_june(plain_value));
  const Outcome outcome = run({"check", path("main.csv").string()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, HasSubstr("is an export, not a site file; `recald init` makes"));
}

// The last row is gone, as after a cut: the first still says what its stamps are.
TEST_F(Init, OneEndOfTheFileSaysWhatStampsAre) {
  std::string text = "Time,kWh\n";
  for (int minute = 15; minute < 20 * 1440 - 50; minute += 15) {
    text += fmt::format("2024-06-{:02} {:02}:{:02},{}\n", minute / 1440 + 1, minute / 60 % 24,
                        minute % 60, plain_value(minute));
  }
  write_text(path("ends.csv"), text);
  ASSERT_EQ(init("ends.csv", "Europe/Berlin").exit_code, kSuccess);
  EXPECT_THAT(read_text(site()), HasSubstr("stamps = \"end\""));
}

TEST_F(Init, ASiteFileThatIsThereStays) {
  write_text(path("readings.csv"), own_rows(200));
  ASSERT_EQ(init("readings.csv").exit_code, kSuccess);
  write_text(site(), "mine");
  const Outcome outcome = init("readings.csv");
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, HasSubstr("is there already"));
  EXPECT_EQ(read_text(site()), "mine");
}

// Ten times the rows, the same memory: within a few megabytes of noise.
TEST_F(Init, MemoryDoesNotGrowWithRows) {
  const auto largest_MB = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
  };
  const auto write = [&](const std::string& name, int rows) {
    std::ofstream out{path(name)};
    out << "Time,Main kWh\n";
    Instant t = std::chrono::sys_days{day("2010-01-01")};
    for (int i = 0; i < rows; ++i, t += minutes{1}) {
      out << metering::to_string(t) << ',' << i % 97 << ".5\n";
    }
  };
  write("short.csv", 20'000);
  write("long.csv", 200'000);
  ASSERT_EQ(init("short.csv").exit_code, kSuccess);
  std::filesystem::remove_all(path("site"));
  const double before_MB = largest_MB();
  ASSERT_EQ(init("long.csv").exit_code, kSuccess);
  EXPECT_LT(largest_MB(), before_MB + 3.0);
}

}  // namespace
}  // namespace recald::daemon::init_command_test
