#include "adapters/csv/readings_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

namespace recald::csv::readings_csv_test {
namespace {

using metering::Instant;
using metering::Reading;
using metering::Reason;
using metering::Validity;
using std::chrono::minutes;
using std::chrono::seconds;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2016} / 3 / 1};

struct Outcome {
  Result<ReadingsReport> report;
  std::vector<Reading> readings;
  std::vector<MeterInFile> meters;
};

ReadingsOptions one_meter(std::string name = "main") {
  ReadingsOptions options;
  options.meters.push_back({});
  options.meters.back().name = std::move(name);
  return options;
}

Outcome read(std::string_view text, const ReadingsOptions& options = one_meter()) {
  Outcome outcome{ReadingsReport{}, {}, {}};
  const ReadingsSink sink{[&](const MeterInFile& meter) { outcome.meters.push_back(meter); },
                          [&](const Reading& reading) { outcome.readings.push_back(reading); }};
  outcome.report = read_readings_text(text, "feed.csv", options, sink);
  return outcome;
}

/// The only issue that a text gives; fails the test when there is not exactly one.
std::string issue(std::string_view text, const ReadingsOptions& options = one_meter()) {
  const Outcome outcome = read(text, options);
  if (!outcome.report) return "failed: " + outcome.report.error().message;
  EXPECT_EQ(outcome.report->issues.total, 1u);
  if (outcome.report->issues.listed.empty()) return "no issue";
  const LineIssue& first = outcome.report->issues.listed.front();
  return std::to_string(first.line) + ": " + first.reason;
}

const std::string kHead = "timestamp,meter,value,unit\n";
const std::string kThreeRows =
    "2016-03-01T00:00:00Z,main,10,kW\n"
    "2016-03-01T00:15:00Z,main,11.5,kW\n"
    "2016-03-01T00:30:00Z,main,12,kW\n";

TEST(ReadingsCsv, PlainFile) {
  const Outcome outcome = read(kHead + kThreeRows);
  ASSERT_TRUE(outcome.report.has_value()) << outcome.report.error().message;
  ASSERT_EQ(outcome.readings.size(), 3u);
  EXPECT_EQ(outcome.readings[1].start, kStart + minutes{15});
  EXPECT_EQ(outcome.readings[1].mean_kW, 11.5);
  EXPECT_EQ(outcome.report->issues.total, 0u);
  ASSERT_EQ(outcome.meters.size(), 1u);
  EXPECT_EQ(outcome.meters[0].interval, minutes{15});
  EXPECT_TRUE(outcome.meters[0].interval_inferred);
  EXPECT_EQ(outcome.meters[0].unit, "kW");
  const MeterReport& report = outcome.report->meters.at(0);
  EXPECT_EQ(report.readings, 3u);
  EXPECT_EQ(report.span, (metering::TimeSpan{kStart, kStart + minutes{45}}));
}

TEST(ReadingsCsv, MarkCrlfCommentsQuotesAndBlankLines) {
  const Outcome outcome = read(
      "\xEF\xBB\xBF# made by a logger\r\ntimestamp,meter,value,unit\r\n\r\n"
      "\"2016-03-01T00:00:00Z\",\"main\",\"10\",\"kW\"\r\n# a note\r\n"
      "2016-03-01 01:15:00+01:00, main , 11 ,kW\r\n");
  ASSERT_TRUE(outcome.report.has_value()) << outcome.report.error().message;
  EXPECT_EQ(outcome.report->issues.total, 0u);
  ASSERT_EQ(outcome.readings.size(), 2u);
  EXPECT_EQ(outcome.readings[1].mean_kW, 11.0);
  EXPECT_EQ(outcome.readings[1].start, kStart + minutes{15});
}

TEST(ReadingsCsv, UnitsBecomeMeanPowerOfTheInterval) {
  const Outcome outcome = read(kHead +
                               "2016-03-01T00:00:00Z,main,2.5,kWh\n"
                               "2016-03-01T00:15:00Z,main,10000,W\n"
                               "2016-03-01T00:30:00Z,main,2.5,kWh\n");
  ASSERT_EQ(outcome.readings.size(), 3u);
  for (const Reading& reading : outcome.readings) EXPECT_DOUBLE_EQ(reading.mean_kW, 10.0);
}

TEST(ReadingsCsv, MultiplierAndUtilityOfTheMeter) {
  ReadingsOptions options = one_meter();
  options.meters[0].multiplier = 40.0;
  EXPECT_DOUBLE_EQ(read(kHead + kThreeRows, options).readings.at(1).mean_kW, 460.0);
  options.meters[0].multiplier = 1.0;
  options.meters[0].utility = metering::Utility::steam;
  const Outcome steam = read(kHead +
                                 "2016-03-01T00:00:00Z,main,1000,lb\n"
                                 "2016-03-01T01:00:00Z,main,1000,lb\n",
                             options);
  EXPECT_NEAR(steam.readings.at(0).mean_kW, 305.0, 1e-9);
}

TEST(ReadingsCsv, EndStampsAreMovedToTheStart) {
  ReadingsOptions options = one_meter();
  options.meters[0].stamps = Stamps::end;
  const Outcome outcome = read(kHead +
                                   "2016-02-29T23:45:00Z,main,9,kW\n"
                                   "2016-02-29T24:00:00Z,main,10,kW\n"
                                   "2016-03-01T00:15:00Z,main,11,kW\n",
                               options);
  ASSERT_EQ(outcome.readings.size(), 3u);
  // Stamped at midnight but measured before: it belongs to February.
  EXPECT_EQ(outcome.readings[1].start, kStart - minutes{15});
  EXPECT_EQ(outcome.readings[1].mean_kW, 10.0);
}

TEST(ReadingsCsv, HourlyFilesAreRecognised) {
  std::string text = kHead;
  for (int hour = 0; hour < 20; ++hour) {
    if (hour == 7 || hour == 8) continue;  // holes do not confuse it
    text += metering::to_string(kStart + std::chrono::hours{hour}) + ",main,5,kWh\n";
  }
  const Outcome outcome = read(text);
  ASSERT_EQ(outcome.meters.size(), 1u);
  EXPECT_EQ(outcome.meters[0].interval, std::chrono::hours{1});
  EXPECT_EQ(outcome.readings.at(0).mean_kW, 5.0);
}

TEST(ReadingsCsv, HalfHourZonesShowTheirPhase) {
  const Outcome outcome = read(kHead +
                               "2016-03-01T00:00:00+05:30,main,1,kW\n"
                               "2016-03-01T01:00:00+05:30,main,2,kW\n");
  ASSERT_EQ(outcome.meters.size(), 1u);
  EXPECT_EQ(outcome.meters[0].phase, minutes{30});
  EXPECT_EQ(outcome.readings.size(), 2u);
}

TEST(ReadingsCsv, ADeclaredIntervalIsTakenAsSaid) {
  ReadingsOptions options = one_meter();
  options.meters[0].interval = minutes{15};
  const Outcome outcome = read(kHead + "2016-03-01T00:00:00Z,main,1,kWh\n", options);
  EXPECT_EQ(outcome.readings.at(0).mean_kW, 4.0);
  EXPECT_FALSE(outcome.meters.at(0).interval_inferred);
}

TEST(ReadingsCsv, BlankIsAReadingThatTheSourceListsAsMissing) {
  const Outcome outcome = read(kHead +
                               "2016-03-01T00:00:00Z,main,,kW\n"
                               "2016-03-01T00:15:00Z,main,1,kW\n");
  ASSERT_EQ(outcome.readings.size(), 2u);
  EXPECT_TRUE(std::isnan(outcome.readings[0].mean_kW));
  EXPECT_EQ(outcome.report->meters[0].blanks, 1u);
}

TEST(ReadingsCsv, OptionalColumnsComeThrough) {
  const Outcome outcome = read(
      "timestamp,meter,value,unit,validity,late,reasons\n"
      "2016-03-01T00:00:00Z,main,1,kW,suspect,1,range|negative\n"
      "2016-03-01T00:15:00Z,main,2,kW,,,\n");
  ASSERT_EQ(outcome.readings.size(), 2u) << outcome.report->issues.total;
  EXPECT_EQ(outcome.readings[0].validity, Validity::suspect);
  EXPECT_EQ(outcome.readings[0].reasons, Reason::range | Reason::negative);
  EXPECT_TRUE(outcome.readings[0].late);
  EXPECT_EQ(outcome.readings[1].validity, Validity::ok);
}

TEST(ReadingsCsv, AMeterThatComesLaterInTheFileIsReadAsWell) {
  ReadingsOptions options = one_meter("a");
  options.meters.push_back({});
  options.meters.back().name = "b";
  std::string text = kHead;
  for (const char* name : {"a", "b"}) {
    for (int i = 0; i < 300; ++i) {
      text += metering::to_string(kStart + i * minutes{name[0] == 'a' ? 15 : 60}) + "," + name +
              ",1,kW\n";
    }
  }
  const Outcome outcome = read(text, options);
  EXPECT_EQ(outcome.readings.size(), 600u);
  ASSERT_EQ(outcome.meters.size(), 2u);
  EXPECT_EQ(outcome.meters[1].interval, minutes{60});
  EXPECT_EQ(outcome.report->issues.total, 0u);
}

TEST(ReadingsCsv, UnlistedMetersMayBeAdded) {
  ReadingsOptions options;
  options.add_unlisted_meters = true;
  const Outcome outcome = read(kHead + kThreeRows, options);
  EXPECT_EQ(outcome.readings.size(), 3u);
  EXPECT_EQ(outcome.report->meters.at(0).shown.name, "main");
}

TEST(ReadingsCsv, CountersBecomeIntervals) {
  ReadingsOptions options = one_meter();
  options.meters[0].counter = metering::CounterSettings{100.0, 0.1, 1e6};
  const Outcome outcome = read(kHead +
                                   "2016-03-01T00:00:00Z,main,999990,kWh\n"
                                   "2016-03-01T01:00:00Z,main,999998,kWh\n"
                                   "2016-03-01T02:00:00Z,main,12,kWh\n"
                                   "2016-03-01T03:00:00Z,main,20,kWh\n",
                               options);
  ASSERT_EQ(outcome.readings.size(), 3u);
  EXPECT_NEAR(outcome.readings[0].mean_kW, 8.0, 1e-9);
  EXPECT_NEAR(outcome.readings[1].mean_kW, 14.0, 1e-9);
  EXPECT_EQ(outcome.readings[1].reasons, Reason::rollover);
}

// --- Bad input: one sentence each, and the rest goes on. ---

TEST(ReadingsCsvBadInput, MissingFile) {
  const auto report = read_readings("/no/such/readings.csv", one_meter(), {});
  ASSERT_FALSE(report.has_value());
  EXPECT_EQ(report.error().code, ErrorCode::not_found);
  EXPECT_EQ(report.error().message, "readings file '/no/such/readings.csv' does not exist");
}

TEST(ReadingsCsvBadInput, ARowWithoutAStampIsNotOf1970) {
  ReadingsOptions options = one_meter();
  options.meters[0].counter = metering::CounterSettings{100.0, 0.1, 1e6};
  const std::string text = kHead +
                           ",main,10,kWh\n"
                           "2016-03-01T00:00:00Z,main,11,kWh\n"
                           "2016-03-01T00:15:00Z,main,12,kWh\n";
  EXPECT_EQ(read(text, options).readings.size(), 1u);
  EXPECT_THAT(issue(text, options), ::testing::StartsWith("2: timestamp ''"));
}

TEST(ReadingsCsvBadInput, WrongHeaderNamesTheExpectedOne) {
  for (const char* header :
       {"time,meter,value,unit\n", "timestamp;meter;value;unit\n", "timestamp,meter,value\n",
        "timestamp,meter,value,unit,colour\n", "2016-03-01T00:00:00Z,main,1,kW\n",
        "timestamp,\"meter,value,unit\n"}) {
    const Outcome outcome = read(std::string{header} + kThreeRows);
    ASSERT_FALSE(outcome.report.has_value()) << header;
    EXPECT_EQ(outcome.report.error().code, ErrorCode::malformed);
    EXPECT_NE(outcome.report.error().message.find(
                  "'feed.csv': the header must be 'timestamp,meter,value,unit'"),
              std::string::npos);
    EXPECT_TRUE(outcome.readings.empty());
  }
  EXPECT_NE(read("timestamp;meter\n").report.error().message.find("not semicolons"),
            std::string::npos);
}

TEST(ReadingsCsvBadInput, EmptyFile) {
  for (const char* text : {"", "\n\n", "# only a comment\n"}) {
    const Outcome outcome = read(text);
    ASSERT_FALSE(outcome.report.has_value());
    EXPECT_NE(outcome.report.error().message.find("'feed.csv' is empty"), std::string::npos);
  }
}

TEST(ReadingsCsvBadInput, ABadLineHasItsNumberAndTheRestGoesOn) {
  const Outcome outcome = read(kHead + "2016-03-01T00:00:00Z,main,1\n" + kThreeRows + "nonsense\n");
  ASSERT_TRUE(outcome.report.has_value());
  EXPECT_EQ(outcome.readings.size(), 3u);
  ASSERT_EQ(outcome.report->issues.total, 2u);
  EXPECT_EQ(outcome.report->issues.listed[0].line, 2u);
  EXPECT_EQ(outcome.report->issues.listed[0].reason, "3 fields instead of 4");
  EXPECT_EQ(outcome.report->issues.listed[1].line, 6u);
}

TEST(ReadingsCsvBadInput, AfterAHundredOnlyTheCountGoesOn) {
  std::string text = kHead;
  for (int i = 0; i < 250; ++i) text += "nonsense\n";
  const Outcome outcome = read(text + kThreeRows);
  EXPECT_EQ(outcome.report->issues.listed.size(), 100u);
  EXPECT_EQ(outcome.report->issues.total, 250u);
  EXPECT_EQ(outcome.readings.size(), 3u);
}

TEST(ReadingsCsvBadInput, MetersThatNobodyAskedForAreOneSentence) {
  std::string text = kHead + kThreeRows;
  for (int i = 0; i < 300; ++i) text += "2016-03-01T00:45:00Z,other,1,kW\n";
  const Outcome outcome = read(text + "2016-03-01T00:45:00Z,third,1,kW\n");
  EXPECT_EQ(outcome.report->issues.total, 0u);
  EXPECT_EQ(outcome.report->others.lines(), 301u);
  EXPECT_EQ(outcome.report->others.words(),
            "2 meters are not configured, and their lines were left out: other (300), third (1)");
}

TEST(ReadingsCsvBadInput, OfTooManyOtherMetersTheFirstAreNamed) {
  std::string text = kHead + kThreeRows;
  for (int i = 0; i < 100; ++i) {
    text += "2016-03-01T00:45:00Z,m" + std::to_string(i) + ",1,kW\n";
  }
  const std::string words = read(text).report->others.words();
  EXPECT_NE(words.find("more than 20 meters are not configured"), std::string::npos) << words;
  EXPECT_NE(words.find("m19 (1) and others (80)"), std::string::npos) << words;
}

TEST(ReadingsCsvBadInput, ARefusedRowIsShownAsItStands) {
  const Outcome outcome = read(kHead + "2016-03-01T00:00:00Z,main,ten,kW\n" + kThreeRows);
  EXPECT_EQ(outcome.report->issues.listed.at(0).text, "2016-03-01T00:00:00Z,main,ten,kW");
  EXPECT_EQ(outcome.report->meters.at(0).refused, 1u);
  EXPECT_EQ(outcome.report->meters.at(0).first_refused.at(0).line, 2u);
}

TEST(ReadingsCsvBadInput, UnknownUnit) {
  const std::string unit = issue(kHead + kThreeRows + "2016-03-01T00:45:00Z,main,1,kvarh\n");
  EXPECT_NE(unit.find("5: unit 'kvarh' is not known"), std::string::npos) << unit;
  EXPECT_NE(unit.find("(meter 'main')"), std::string::npos);
}

TEST(ReadingsCsvBadInput, DecimalCommaIsRecognisedInBothForms) {
  EXPECT_EQ(issue(kHead + kThreeRows + "2016-03-01T00:45:00Z,main,12,5,kW\n"),
            "5: value '12,5' has a decimal comma; write 12.5");
  EXPECT_EQ(issue(kHead + kThreeRows + "2016-03-01T00:45:00Z,main,\"12,5\",kW\n"),
            "5: value '12,5' has a decimal comma; write 12.5");
}

TEST(ReadingsCsvBadInput, NotANumberAndNotFinite) {
  for (const char* value : {"NaN", "inf", "-inf", "n/a", "1e999", "12.5kW", "--"}) {
    EXPECT_EQ(issue(kHead + kThreeRows + "2016-03-01T00:45:00Z,main," + value + ",kW\n"),
              "5: value '" + std::string{value} +
                  "' is not a finite number; leave the field blank where nothing was measured");
  }
}

// Finite in the file and infinite in kW.
TEST(ReadingsCsvBadInput, MoreThanAnyMeterCounts) {
  EXPECT_EQ(issue(kHead + kThreeRows + "2016-03-01T00:45:00Z,main,1e307,GWh\n"),
            "5: value '1e307' is more than any meter counts");
  EXPECT_EQ(issue(kHead + kThreeRows + "2016-03-01T00:45:00Z,main,-1e19,kWh\n"),
            "5: value '-1e19' is more than any meter counts");
}

// What a file contains moves no cursor and begins no line of its own.
TEST(ReadingsCsvBadInput, ControlCharactersAreWrittenOut) {
  const auto other = read(kHead + kThreeRows + "2016-03-01T00:45:00Z,\x1B[2J,1,kWh\n").report;
  EXPECT_NE(other->others.words().find("left out: \\x1B[2J (1)"), std::string::npos);
  EXPECT_THAT(read("timestamp;\a\n").report.error().message,
              ::testing::HasSubstr("'timestamp;\\x07'"));
}

TEST(ReadingsCsvBadInput, UnsortedAndDuplicateRowsAreReportedAndHandedOn) {
  EXPECT_EQ(issue(kHead + kThreeRows + "2016-03-01T00:30:00Z,main,99,kW\n"),
            "5: meter 'main': interval 2016-03-01T00:30:00Z comes twice; the first value stays");
  const Outcome outcome = read(kHead +
                               "2016-03-01T00:15:00Z,main,2,kW\n"
                               "2016-03-01T00:00:00Z,main,1,kW\n"
                               "2016-03-01T00:30:00Z,main,3,kW\n"
                               "2016-03-01T00:45:00Z,main,3,kW\n");
  EXPECT_EQ(outcome.readings.size(), 4u);
  ASSERT_EQ(outcome.report->issues.total, 1u);
  EXPECT_NE(outcome.report->issues.listed[0].reason.find("not in order of time"),
            std::string::npos);
  EXPECT_EQ(outcome.report->meters[0].unsorted, 1u);
}

TEST(ReadingsCsvBadInput, OffGridStampsAreKeptOut) {
  EXPECT_EQ(issue(kHead + kThreeRows + "2016-03-01T00:49:00Z,main,1,kW\n"),
            "5: meter 'main': 2016-03-01T00:49:00Z is no start of an interval of 15 minutes");
}

// A logger whose clock is seven minutes off has no grid of its own: nothing is moved silently.
TEST(ReadingsCsvBadInput, AClockOffTheQuarterHourIsOffGridThroughout) {
  const Outcome outcome = read(kHead +
                               "2016-03-01T00:07:00Z,main,1,kW\n2016-03-01T00:22:00Z,main,2,kW\n"
                               "2016-03-01T00:37:00Z,main,3,kW\n");
  EXPECT_TRUE(outcome.readings.empty());
  EXPECT_EQ(outcome.report->meters.at(0).off_grid, 3u);
}

TEST(ReadingsCsvBadInput, StampsWithoutOffsetOrBeyondTheKnownYears) {
  EXPECT_NE(issue(kHead + kThreeRows + "2016-03-01T00:45:00,main,1,kW\n").find("no offset"),
            std::string::npos);
  EXPECT_NE(issue(kHead + kThreeRows + "2101-03-01T00:45:00Z,main,1,kW\n").find("1971 to 2100"),
            std::string::npos);
}

TEST(ReadingsCsvBadInput, IntervalsThatCannotBe) {
  EXPECT_NE(issue(kHead + "2016-03-01T00:00:00Z,main,1,kW\n").find("declare it"),
            std::string::npos);
  EXPECT_NE(issue(kHead + "2016-03-01T00:00:00Z,main,1,kWh\n2016-03-02T00:00:00Z,main,1,kWh\n")
                .find("comes every day; recald needs values of an hour or less"),
            std::string::npos);
}

TEST(ReadingsCsvBadInput, BrokenQuoteAndLongLine) {
  EXPECT_EQ(issue(kHead + "2016-03-01T00:00:00Z,\"main,1,kW\n" + kThreeRows),
            "2: a quote is not closed, or text follows a closing quote");
  EXPECT_EQ(issue(kHead + std::string(70'000, 'x') + "\n" + kThreeRows), "2: longer than 64 KiB");
}

TEST(ReadingsCsvBadInput, OptionalColumnsWithWrongWords) {
  const std::string head = "timestamp,meter,value,unit,validity,reasons,late\n";
  const std::string good =
      "2016-03-01T00:00:00Z,main,1,kW,ok,,0\n2016-03-01T00:15:00Z,main,1,kW,ok,,0\n";
  EXPECT_NE(issue(head + good + "2016-03-01T00:30:00Z,main,1,kW,fine,,0\n").find("'fine'"),
            std::string::npos);
  EXPECT_NE(issue(head + good + "2016-03-01T00:30:00Z,main,1,kW,ok,odd,0\n").find("'odd'"),
            std::string::npos);
  EXPECT_NE(issue(head + good + "2016-03-01T00:30:00Z,main,1,kW,ok,,maybe\n").find("'maybe'"),
            std::string::npos);
}

// A file cut at any byte gives a prefix of its readings and nothing else. The unit is the trap:
// cut inside kWh, a row still looks whole and would mean another power.
TEST(ReadingsCsvBadInput, CutAtEveryByteNothingIsInvented) {
  for (const std::string unit : {"kWh", "kW"}) {
    std::string text = kHead;
    for (int i = 0; i < 6; ++i) {
      text += metering::to_string(kStart + i * minutes{15}) + ",main," + std::to_string(i) +
              "12.75," + unit + "\n";
      text += metering::to_string(kStart + i * minutes{15}) + ",\"other\",,MWh\n";
    }
    ReadingsOptions options = one_meter();
    options.meters.push_back({});
    options.meters.back().name = "other";
    options.meters[0].interval = options.meters[1].interval = minutes{15};
    std::map<std::pair<std::uint32_t, Instant>, double> whole;
    for (const Reading& r : read(text, options).readings) whole[{r.meter, r.start}] = r.mean_kW;
    ASSERT_EQ(whole.size(), 12u);
    std::size_t before = 0;
    for (std::size_t cut = 0; cut <= text.size(); ++cut) {
      const Outcome outcome = read(std::string_view{text}.substr(0, cut), options);
      EXPECT_GE(outcome.readings.size(), before) << "at byte " << cut;
      before = outcome.readings.size();
      for (const Reading& r : outcome.readings) {
        const auto known = whole.find({r.meter, r.start});
        ASSERT_NE(known, whole.end()) << "at byte " << cut;
        if (!std::isnan(known->second)) {
          EXPECT_EQ(r.mean_kW, known->second) << "at byte " << cut;
        }
      }
    }
    EXPECT_EQ(before, 12u);
  }
}

// Any byte replaced by any of a few nasty ones: no crash, and no reading out of nowhere.
TEST(ReadingsCsvBadInput, DamagedBytesNeverCrash) {
  const std::string text = kHead + kThreeRows;
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char nasty : {'\0', '"', ',', '\n', '\r', '\xFF', '9', '-', ';'}) {
      std::string damaged = text;
      damaged[at] = nasty;
      const Outcome outcome = read(damaged);
      if (outcome.report) {
        EXPECT_LE(outcome.readings.size(), 4u) << "at byte " << at;  // a new line may appear
      }
    }
  }
}

TEST(ReadingsCsv, AFileOnDiskReadsLikeItsText) {
  const auto file = std::filesystem::path{::testing::TempDir()} / "recald_readings_csv_test.csv";
  std::ofstream{file, std::ios::binary} << kHead << kThreeRows;
  std::vector<Reading> readings;
  const ReadingsSink sink{{}, [&](const Reading& reading) { readings.push_back(reading); }};
  const auto report = read_readings(file, one_meter(), sink);
  std::filesystem::remove(file);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(readings.size(), 3u);
}

}  // namespace
}  // namespace recald::csv::readings_csv_test
