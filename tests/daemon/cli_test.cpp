/// Commands, exit codes, sentences: hourly readings of a first quarter, alternating 40 and 60 kW of
/// electricity and 20 and 30 kWh of heat, so that a day is 1200 and 600 kWh.
#include "daemon/commands/line/cli.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "command_line.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/version.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using recald::testing::edited;
using recald::testing::kSampleMeters;
using recald::testing::read_text;
using recald::testing::sample_site;
using recald::testing::write_text;
using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;
using testing::run;
using ::testing::StartsWith;

// A local first quarter in Zurich: one hour ahead of UTC until 28 March, then two.
const Instant kReadingsBegin = sys_days{year{2020} / 12 / 31} + hours{23};
const Instant kEnd = sys_days{year{2021} / 3 / 31} + hours{22};

std::string quarter_readings() {
  std::string text = "timestamp,meter,value,unit\n";
  bool high = false;
  for (Instant t = kReadingsBegin; t < kEnd; t += hours{1}, high = !high) {
    text += metering::to_string(t) + ",electricity," + (high ? "60" : "40") + ",kW\n";
    text += metering::to_string(t) + ",heat," + (high ? "30" : "20") + ",kWh\n";
  }
  return text;
}

std::string weather_of(int first_year) {
  std::string text = "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2\n";
  for (Instant t = sys_days{year{first_year - 1} / 12 / 31}; t < sys_days{year{first_year} / 4 / 2};
       t += hours{1}) {
    text += metering::to_string(t) + ",4.5,70,2,180,90\n";
  }
  return text;
}

std::ptrdiff_t lines_in(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

class Cli : public ::testing::Test {
 protected:
  Cli() {
    write("site.toml", std::string{kSampleMeters});
    write("readings.csv", quarter_readings());
  }

  void write(const char* name, const std::string& text) { write_text(folder_ / name, text); }
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string site() const { return path("site.toml"); }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(Cli, WrongUsageIsTwo) {
  const std::vector<std::vector<std::string>> misuses = {
      {"-q"},
      {"frobnicate"},
      {"--frobnicate"},
      {"replay"},
      {"replay", site(), "extra"},
      {"replay", site(), "--form", "2021-01-01"},
      {"replay", site(), "--from"},
      {"calibrate", site(), "--model", "daily"},
      {"calibrate", site(), "--sampler", "guess"},
      {"calibrate", site(), "--hyper-prior", "none"},
      {"calibrate", site(), "--draws", "many"},
      {"calibrate", site(), "--draws", "10"},
      {"calibrate", site(), "--chains", "1"},
      {"report"},
      {"report", site(), "--timezone", "Europe/Zurich"},
      {"report", site(), path("readings.csv")},
  };
  for (const auto& arguments : misuses) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kUsage) << ::testing::PrintToString(arguments);
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err, Not(IsEmpty()));
  }
}

TEST_F(Cli, DaysThatAreNoneAreWrongUsage) {
  const Outcome no_day = run({"replay", site(), "--from", "2021-02-30"});
  EXPECT_EQ(no_day.exit_code, kUsage);
  EXPECT_EQ(no_day.err,
            "recald: --from: '2021-02-30' is not a date of 1971 to 2100; write YYYY-MM-DD\n");
  EXPECT_EQ(run({"replay", site(), "--to", "February"}).exit_code, kUsage);
  const Outcome backwards = run({"replay", site(), "--from", "2021-03-01", "--to", "2021-02-01"});
  EXPECT_EQ(backwards.exit_code, kUsage);
  EXPECT_EQ(backwards.err, "recald: --to 2021-02-01 is before --from 2021-03-01\n");
}

TEST_F(Cli, HelpAndVersionAreSuccess) {
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.exit_code, kSuccess);
  for (const char* command : {"check", "replay", "profile", "calibrate", "report"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
  }
  EXPECT_THAT(help.err, IsEmpty());
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.exit_code, kSuccess);
  EXPECT_EQ(version.out, std::string{kVersion} + "\n");
}

TEST_F(Cli, CheckOfARightFileSaysWhatIsInIt) {
  write("site.toml", sample_site());
  write("weather.csv", weather_of(2021));
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, StartsWith("Tram depot (depot), Europe/Zurich\n"));
  EXPECT_THAT(outcome.out, HasSubstr("('heat', start-stamped, interval as in the file)"));
  EXPECT_THAT(outcome.out, HasSubstr("triangular 0.8 / 2 / 2.6 m3/s"));
  EXPECT_THAT(outcome.out, HasSubstr("triangular 0 / 0.05 / 0.1 person/m2"));
  EXPECT_THAT(outcome.out, ::testing::EndsWith("\nok\n"));
}

TEST_F(Cli, CheckSaysWhatTheWeathersTemperaturesAreTakenFor) {
  write("weather.csv", weather_of(2021));
  for (const auto& [key, taken] : {std::pair{"values = \"mean\"\n", "mean (declared)"},
                                   std::pair{"values = \"instant\"\n", "instant (declared)"},
                                   std::pair{"", "instant (default)"}}) {
    write("site.toml", edited(sample_site(), "values = \"mean\"\n", key));
    EXPECT_THAT(
        run({"check", site()}).out,
        HasSubstr(std::string{"(start-stamped, temperature, humidity, wind and pressure: "} +
                  taken + ")\n"));
    EXPECT_THAT(run({"check", site(), "--json"}).out,
                HasSubstr(std::string{"\"weather_values\": \""} + taken + "\""));
  }
}

TEST_F(Cli, CheckOfAWrongFileExplainsEachMistake) {
  write("site.toml", edited(edited(std::string{kSampleMeters}, "altitude_m", "altitud_m"),
                            "utility = \"heating\"", "utility = \"warmth\""));
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(lines_in(outcome.err), 2);
  EXPECT_THAT(outcome.err, HasSubstr("recald: site.toml:7: [site] unknown key 'altitud_m'; did you "
                                     "mean 'altitude_m'?\n"));
  EXPECT_THAT(outcome.err, HasSubstr("recald: site.toml:20: [meter] 'warmth' is not a utility"));
}

TEST_F(Cli, CheckNamesDataFilesThatAreNotThere) {
  write("site.toml", sample_site());
  std::filesystem::remove(path("readings.csv"));
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, HasSubstr("recald: site.toml: the file of meter 'electricity', '" +
                                     path("readings.csv") + "' does not exist\n"));
  EXPECT_THAT(outcome.err, HasSubstr("recald: site.toml: the weather file '" + path("weather.csv") +
                                     "' does not exist\n"));
}

// A pipe that nobody writes to would keep a command waiting for ever.
TEST_F(Cli, InputThatIsNoFileIsRefusedAtOnce) {
  std::filesystem::remove(path("readings.csv"));
  ASSERT_EQ(::mkfifo(path("readings.csv").c_str(), 0600), 0);
  const std::string sentence =
      "'" + path("readings.csv") + "' is a pipe, not a file; save its content to a file first\n";
  EXPECT_THAT(run({"check", site()}).err, HasSubstr(sentence));
  EXPECT_EQ(run({"replay", site()}).err, "recald: readings file " + sentence);
  EXPECT_EQ(run({"import", site(), path("readings.csv"), "--reason", "old"}).err,
            "recald: readings file " + sentence);
  std::filesystem::remove(path("readings.csv"));
  std::filesystem::create_directory(path("readings.csv"));
  EXPECT_EQ(run({"replay", site()}).err,
            "recald: readings file '" + path("readings.csv") + "' is a folder, not a file\n");
  EXPECT_THAT(run({"check", site()}).err, HasSubstr("is a folder, not a file\n"));
}

TEST_F(Cli, CheckNamesPushedMetersThatNobodyCanPushTo) {
  const std::string pushed =
      "[site]\nid = \"x\"\ntimezone = \"UTC\"\n[[meter]]\nid = \"chw\"\nsource = \"http\"\n"
      "utility = \"chilled_water\"\n";
  write("site.toml", pushed);
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_EQ(outcome.err,
            "recald: site.toml: meter 'chw' has source = \"http\", but there is no [http] to send "
            "its readings to; add [http] with listen = \"127.0.0.1:8080\"\n");
  write("site.toml", pushed + "[http]\nlisten = \"127.0.0.1:8080\"\n");
  EXPECT_EQ(run({"check", site()}).exit_code, kSuccess);
}

TEST_F(Cli, CheckFindsAPriorThatTheBuildingDoesNotHave) {
  // Without occupants there is nothing that the library's range could be relative to.
  write("site.toml",
        edited(sample_site(), "occupancy_person_m2 = 0.05", "occupancy_person_m2 = 0"));
  write("weather.csv", weather_of(2021));
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_EQ(outcome.err,
            "recald: site.toml: occupancy_density: its range is relative to the design value, "
            "which is 0; give min, mode and max\n");
}

TEST_F(Cli, AShopThatLeaksMoreThanOfficesDoIsNoMistake) {
  write("site.toml",
        edited(sample_site(), "name = \"occupancy_density\"", "name = \"leakage_area\"") +
            "\n[building.infiltration]\nela_cm2_m2 = 9\n");
  write("weather.csv", weather_of(2021));
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("leakage_area         triangular 0.26 / 9 / 10.17 cm2/m2"));
}

TEST_F(Cli, APriorBeyondPhysicsIsNamedWithItsLine) {
  write("site.toml", edited(sample_site(), "name = \"occupancy_density\"",
                            "name = \"leakage_area\"\nmin = -2\nmode = 3\nmax = 60"));
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, HasSubstr("leakage_area cannot be -2 cm2/m2; it is at least 0 cm2/m2"));
  write("site.toml", edited(sample_site(), "name = \"occupancy_density\"",
                            "name = \"leakage_area\"\nmin = 0.1\nmode = 12\nmax = 60"));
  write("weather.csv", weather_of(2021));
  EXPECT_EQ(run({"check", site()}).exit_code, kSuccess);
}

/// Columns of the weather from the first to before `end`.
std::string weather_columns(int end) {
  std::istringstream lines{weather_of(2021)};
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    std::size_t at = 0;
    for (int i = 0; i < end; ++i) at = line.find(',', at) + 1;
    text += (at == 0 ? line : line.substr(0, at - 1)) + "\n";
  }
  return text;
}

TEST_F(Cli, CheckSaysWhatOfTheWeatherIsAssumed) {
  write("site.toml", sample_site());
  write("weather.csv", weather_columns(2));
  const Outcome check = run({"check", site()});
  EXPECT_EQ(check.exit_code, kSuccess);
  EXPECT_EQ(
      check.err,
      "recald: Humidity, wind and sun are not measured: they are assumed from the temperature "
      "and the clear sky, and count as uncertain.\n");
  write("weather.csv", weather_columns(5));
  EXPECT_EQ(
      run({"check", site()}).err,
      "recald: Sun is not measured: it is assumed from the temperature and the clear sky, and "
      "counts as uncertain.\n");
}

// The file has the column, and no value in it.
TEST_F(Cli, WeatherWithoutTemperatureSaysWhatStillWorks) {
  write("site.toml", sample_site());
  std::string text = "timestamp,dry_bulb_C,ghi_W_m2\n";
  for (int h = 0; h < 48; ++h) {
    text += metering::to_string(kReadingsBegin + hours{h}) + ",,100\n";
  }
  write("weather.csv", text);
  const std::string sentence =
      "the weather in weather.csv has no dry_bulb_C. Without the temperature no model can be run: "
      "calibrate, report, profile, doe, drift and diagnose do not work. replay, run, import and "
      "export do. Add it, or give an EPW file\n";
  const Outcome check = run({"check", site()});
  EXPECT_EQ(check.exit_code, kFailure);
  EXPECT_EQ(check.err, "recald: site.toml: " + sentence);
  const Outcome calibrate = run({"calibrate", site()});
  EXPECT_EQ(calibrate.exit_code, kFailure);
  EXPECT_THAT(calibrate.err, HasSubstr("recald: " + sentence));
  EXPECT_EQ(run({"replay", site()}).exit_code, kSuccess);
}

/// Meters of halves of a building, and of what its roof feeds in: by day 1200, 600 and 180 kWh.
class SumOfMeters : public Cli {
 protected:
  SumOfMeters() {
    write("halves.csv", halves());
    write("site.toml", site_text());
  }
  static std::string halves(Instant gap = {}) {
    std::string text = "timestamp,meter,value,unit\n";
    bool high = false;
    for (Instant t = kReadingsBegin; t < kEnd; t += hours{1}, high = !high) {
      const std::string stamp = metering::to_string(t);
      text += stamp + ",east," + (high ? "60" : "40") + ",kW\n";
      if (t != gap) text += stamp + ",west," + (high ? "30" : "20") + ",kW\n";
      text += stamp + ",pv," + (high ? "10" : "5") + ",kW\n";
    }
    return text;
  }
  static std::string site_text() {
    std::string text = "[site]\nid = \"x\"\ntimezone = \"Europe/Zurich\"\n";
    for (const char* id : {"east", "west", "pv"}) {
      text += std::string{"[[meter]]\nid = \""} + id +
              "\"\nutility = \"electricity\"\nfile = \"halves.csv\"\n";
    }
    return text +
           "[[meter]]\nid = \"all\"\nutility = \"electricity\"\nsum_of = [\"east\", \"west\", "
           "\"-pv\"]\n";
  }
};

TEST_F(SumOfMeters, IsAMeterWithMonthsAndAPeak) {
  const Outcome outcome = run({"replay", site()});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2021-01  all                  1620.0 kWh/day  peak     80.0 "
                                     "kW  measured 100.0 %"));
  EXPECT_THAT(outcome.err,
              HasSubstr("all: 2159 readings every 3600 s (the sum of east, west, less pv)\n"));
  const Outcome check = run({"check", site()});
  EXPECT_EQ(check.exit_code, kSuccess) << check.err;
  EXPECT_THAT(check.out, HasSubstr("the sum of east, west, less pv\n"));
}

TEST_F(SumOfMeters, LacksWhatAPartLacks) {
  write("halves.csv", halves(sys_days{year{2021} / 2 / 10} + hours{9}));
  const Outcome outcome = run({"replay", site()});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2021-02  all                  1620.0 kWh/day  peak     80.0 "
                                     "kW  measured  99.9 %"));
}

TEST_F(SumOfMeters, OfPartsWithOtherIntervalsIsNamed) {
  std::string text = "timestamp,meter,value,unit\n";
  for (Instant t = kReadingsBegin; t < kEnd; t += std::chrono::minutes{30}) {
    text += metering::to_string(t) + ",west,25,kW\n";
  }
  write("west.csv", text);
  write("site.toml",
        edited(site_text(), "\"west\"\nutility = \"electricity\"\nfile = \"halves.csv\"",
               "\"west\"\nutility = \"electricity\"\nfile = \"west.csv\""));
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_EQ(outcome.err,
            "recald: meter 'all' cannot be summed: 'east' reads every 3600 s and 'west' every "
            "1800 s; bring the files to one interval\n");
}

TEST_F(SumOfMeters, OfPartsThatDoNotFitIsNamed) {
  const auto problem_of = [&](const std::string& parts) {
    write("site.toml", edited(site_text(), "[\"east\", \"west\", \"-pv\"]", parts));
    return run({"check", site()}).err;
  };
  EXPECT_THAT(problem_of("[\"east\"]"), HasSubstr("'sum_of' needs the ids of at least two meters"));
  EXPECT_THAT(problem_of("[\"east\", \"wset\"]"),
              HasSubstr("'sum_of' names 'wset', which is not the id of a [[meter]]"));
  EXPECT_THAT(problem_of("[\"east\", \"-east\"]"), HasSubstr("'sum_of' names 'east' twice"));
  const std::string gas =
      edited(site_text(), "\"pv\"\nutility = \"electricity\"", "\"pv\"\nutility = \"gas\"");
  write("site.toml", gas);
  EXPECT_THAT(run({"check", site()}).err,
              HasSubstr("'sum_of' names 'pv', which meters gas, not electricity"));
  EXPECT_THAT(problem_of("[\"east\", \"all\"]"),
              HasSubstr("'sum_of' names 'all', which is itself a sum; name its parts instead"));
  write("site.toml", site_text() + "file = \"halves.csv\"\n");
  EXPECT_THAT(run({"check", site()}).err, HasSubstr("unknown key 'file'"));
}

TEST_F(Cli, TwoMetersOfTheWholeBuildingCountTwice) {
  const std::string twice = edited(
      edited(sample_site(), "outputs = [\"electricity\"", "outputs = [\"electricity\", \"west\""),
      "[[meter]]\nid = \"district_heat\"",
      "[[meter]]\nid = \"west\"\nutility = \"electricity\"\nfile = \"west.csv\"\n"
      "name_in_file = \"electricity\"\n\n[[meter]]\nid = \"district_heat\"");
  write("site.toml", twice);
  write("west.csv", quarter_readings());
  write("weather.csv", weather_of(2021));
  const std::string sentence =
      "the outputs 'electricity' and 'west' both stand for all electricity of the building, so it "
      "would count twice; if each meters a part of it, add a [[meter]] with sum_of = "
      "[\"electricity\", \"west\"] and put that among the outputs, or say by 'end_uses' what each "
      "of them meters\n";
  const Outcome check = run({"check", site()});
  EXPECT_EQ(check.exit_code, kFailure);
  EXPECT_THAT(check.err, HasSubstr("recald: site.toml: " + sentence));
  const Outcome calibrate = run({"calibrate", site()});
  EXPECT_EQ(calibrate.exit_code, kFailure);
  EXPECT_THAT(calibrate.err, HasSubstr(sentence));
}

// The file ends on the tenth of March: what has not been read yet is not missing.
TEST_F(Cli, TimeAfterTheLastReadingIsNoGap) {
  const auto until = [&](const std::string& meter, Instant end) {
    std::istringstream lines{quarter_readings()};
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      const bool is_its = meter.empty() || line.find("," + meter + ",") != std::string::npos;
      const bool is_kept = text.empty() || !is_its || line < metering::to_string(end);
      if (is_kept) text += line + "\n";
    }
    return text;
  };
  const Instant march_10 = sys_days{year{2021} / 3 / 10};
  write("readings.csv", until("", march_10));
  EXPECT_THAT(run({"replay", site()}).err, Not(HasSubstr("without readings")));
  write("readings.csv", until("heat", march_10));
  EXPECT_THAT(run({"replay", site()}).err,
              HasSubstr("district_heat: 526 intervals without readings, in one stretch of 21.9 "
                        "days from 2021-03-10 01:00."));
}

TEST_F(Cli, AMisspeltCommandIsToldWhatWasMeant) {
  const Outcome outcome = run({"calibrte", site()});
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_EQ(outcome.err, "recald: there is no command 'calibrte'; did you mean 'calibrate'?\n");
  EXPECT_EQ(run({"nosuch", "--help"}).exit_code, kUsage);
  EXPECT_EQ(run({"qqqqqqqq"}).err, "recald: there is no command 'qqqqqqqq'; see recald --help\n");
  EXPECT_THAT(run({"nosuch", "--help"}).out, IsEmpty());
  EXPECT_THAT(run({"model", "lst", site()}).err,
              HasSubstr("there is no command 'model lst'; did you mean 'list'?"));
  EXPECT_EQ(run({"model", "--help"}).exit_code, kSuccess);
}

TEST_F(Cli, CheckAsJson) {
  const auto good = nlohmann::json::parse(run({"check", site(), "--json"}).out);
  EXPECT_EQ(good, (nlohmann::json{{"ok", true}, {"problems", nlohmann::json::array()}}));
  const Outcome bad = run({"check", path("absent.toml"), "--json"});
  EXPECT_EQ(bad.exit_code, kFailure);
  const auto json = nlohmann::json::parse(bad.out);
  EXPECT_EQ(json["ok"], false);
  EXPECT_EQ(json["problems"][0], "site file '" + path("absent.toml") + "' does not exist");
}

TEST_F(Cli, ReplayPrintsEachMonthAsItCloses) {
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(lines_in(outcome.out), 6);
  // January closes when the meter's own readings reach 72 h beyond it.
  EXPECT_THAT(outcome.out,
              HasSubstr("2021-01  electricity          1200.0 kWh/day  peak     60.0 kW  measured "
                        "100.0 %  closed 2021-02-03T23:00:00Z\n"));
  EXPECT_THAT(outcome.out,
              HasSubstr("2021-02  district_heat         600.0 kWh/day  peak     30.0 kW"));
  EXPECT_THAT(outcome.out, HasSubstr("2021-03  electricity"));
  EXPECT_THAT(outcome.err,
              HasSubstr("electricity: 2159 readings every 3600 s (inferred from the file)\n"));
}

TEST_F(Cli, ReplayReportsBadLinesAndGoesOn) {
  const std::string good = run({"replay", site()}).out;
  std::string text = quarter_readings();
  text.insert(text.find("2020-12-31T23:00:00Z,heat"), "not a reading\n");
  text += "2021-03-31T22:00:00Z,electricity,fifty,kW\n";
  write("readings.csv", text);
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_EQ(outcome.out, good);
  EXPECT_THAT(outcome.err, HasSubstr("readings.csv: 2 lines to look at\n"));
  EXPECT_THAT(outcome.err, HasSubstr("  readings.csv:3: 1 fields instead of 4\n"));
  EXPECT_THAT(outcome.err, HasSubstr("  readings.csv:4321: value 'fifty' is not a finite number"));
}

TEST_F(Cli, ReplayShowsTenBadLinesAndCountsTheRest) {
  std::string text = quarter_readings();
  for (int i = 0; i < 12; ++i) text += "bad\n";
  write("readings.csv", text);
  const Outcome outcome = run({"replay", site()});
  EXPECT_THAT(outcome.err, HasSubstr("readings.csv: 12 lines to look at\n"));
  EXPECT_THAT(outcome.err, HasSubstr("  … and 2 more\n"));
}

TEST_F(Cli, ReplayReportsAMeterThatNobodyDeclaredAndGoesOn) {
  const std::string good = run({"replay", site()}).out;
  write("readings.csv", quarter_readings() + "2021-03-31T22:00:00Z,water,1,m3\n");
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_EQ(outcome.out, good);
  EXPECT_THAT(outcome.err, HasSubstr("readings.csv: 1 meter is not configured, and its lines were "
                                     "left out: water (1)\n"));
}

TEST_F(Cli, ReplayTakesWholeLocalDaysBothIncluded) {
  const Outcome outcome = run({"replay", site(), "--from", "2021-02-01", "--to", "2021-02-28"});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_EQ(lines_in(outcome.out), 2);
  EXPECT_THAT(outcome.out, HasSubstr("2021-02  electricity          1200.0 kWh/day  peak     60.0 "
                                     "kW  measured 100.0 %"));
  EXPECT_THAT(outcome.out, HasSubstr("2021-02  district_heat"));
}

TEST_F(Cli, ReplayAsJsonIsOneObject) {
  const Outcome outcome = run({"replay", site(), "--json"});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["site"], "depot");
  EXPECT_EQ(json["readings"], 2 * 2159);
  EXPECT_EQ(json["bad_lines"], 0);
  ASSERT_EQ(json["meters"].size(), 2u);
  EXPECT_EQ(json["meters"][1]["meter"], "district_heat");
  EXPECT_EQ(json["meters"][1]["interval_s"], 3600);
  EXPECT_EQ(json["meters"][1]["interval_inferred"], true);
  EXPECT_EQ(json["meters"][1]["months"], 3);
}

TEST_F(Cli, ReplayWritesMonths) {
  const Outcome outcome = run({"replay", site(), "--out", path("made/below")});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  const std::string months = read_text(folder_ / "made/below/months.csv");
  EXPECT_THAT(months,
              StartsWith("month,meter,value,unit,coverage,filled_share,peak_kW,peak_at,"
                         "method,usable,different,revision,tzdata,estimated_share,value_sd\n"
                         "2021-01,electricity,1200,kWh/day,1.000000,0.000000,60,"
                         "2021-01-01T00:00:00Z,block-"));
  EXPECT_EQ(lines_in(months), 1 + 6);
  EXPECT_THAT(months, HasSubstr("2021-03,district_heat,"));
}

// A recorded register reads 0 for ten days around the end of January, while half the usual load
// runs, and comes back: both months have the energy that it counted.
TEST_F(Cli, ReplayKnowsTheEnergyOfARegisterAtZero) {
  write("site.toml", edited(std::string{kSampleMeters}, "rated_kW = 400",
                            "rated_kW = 400\ncounter = { unit = \"kWh\" }"));
  const Instant begin = sys_days{year{2020} / 12 / 31} + hours{23};  // midnight in Zurich
  std::string text = "timestamp,meter,value,unit\n";
  double count_kWh = 50'000.0;
  for (int h = 0; h <= 59 * 24; ++h) {
    const bool is_half = h >= 26 * 24 && h < 36 * 24;
    const bool is_zero = h > 26 * 24 && h < 36 * 24;
    const std::string stamp = metering::to_string(begin + hours{h});
    text += stamp + ",electricity," + std::to_string(is_zero ? 0.0 : count_kWh) + ",kWh\n";
    text += stamp + ",heat," + std::to_string(40 + h % 24) + ",kW\n";
    count_kWh += (is_half ? 0.5 : 1.0) * (50.0 + 10.0 * std::sin(h * 0.2617993878));
  }
  write("readings.csv", text);
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2021-01  electricity          1103.2 kWh/day"));
  EXPECT_THAT(outcome.out, HasSubstr("2021-02  electricity          1092.9 kWh/day"));
}

TEST_F(Cli, ReplayCannotWriteBelowAFile) {
  const Outcome outcome = run({"replay", site(), "--out", path("readings.csv")});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, HasSubstr("recald: cannot "));
}

TEST_F(Cli, MissingReadingsFileIsOneSentence) {
  std::filesystem::remove(path("readings.csv"));
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_EQ(outcome.err, "recald: readings file '" + path("readings.csv") + "' does not exist\n");
  EXPECT_THAT(outcome.out, IsEmpty());
}

TEST_F(Cli, WrongHeaderIsOneSentence) {
  write("readings.csv", "time,meter,value,unit\n2021-01-01T00:00:00Z,electricity,1,kW\n");
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_EQ(lines_in(outcome.err), 1);
  EXPECT_THAT(outcome.err,
              HasSubstr("the header must be 'timestamp,meter,value,unit' (then validity, late or "
                        "reasons, if any) but is 'time,meter,value,unit'"));
}

TEST_F(Cli, CheckSaysWhatReplayWouldRefuse) {
  write("readings.csv", quarter_readings() + "2021-03-31T22:00:00Z,heat,much,kWh\n");
  const Outcome outcome = run({"check", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_THAT(outcome.err, HasSubstr("readings.csv: 1 line to look at\n"));
  EXPECT_THAT(outcome.err, HasSubstr("  readings.csv:4320: value 'much' is not a finite number"));
  EXPECT_THAT(outcome.err, HasSubstr("\n    2021-03-31T22:00:00Z,heat,much,kWh\n"));
}

TEST_F(Cli, WhereEveryRowIsRefusedTheFirstThreeSayWhy) {
  std::string text = "timestamp,meter,value,unit\n";
  for (int i = 0; i < 5; ++i)
    text += "2021-01-01T0" + std::to_string(i) + ":00:00Z,heat,1,furlong\n";
  write("readings.csv", quarter_readings());
  write("heat.csv", text);
  write("site.toml", edited(std::string{kSampleMeters}, "file = \"readings.csv\"\nname_in_file",
                            "file = \"heat.csv\"\nname_in_file"));
  for (const char* command : {"check", "replay"}) {
    const Outcome outcome = run({command, site()});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_THAT(
        outcome.err,
        HasSubstr("heat.csv has no usable row of meter 'heat'; 5 lines were refused: line 2 "
                  "\"2021-01-01T00:00:00Z,heat,1,furlong\": unit 'furlong' is not known"));
    EXPECT_THAT(outcome.err, HasSubstr("; line 4 \"2021-01-01T02:00:00Z,heat,1,furlong\": "));
    EXPECT_THAT(outcome.err, Not(HasSubstr("line 5")));
  }
}

TEST_F(Cli, ARegisterWithoutCounterIsDoubted) {
  std::string text = quarter_readings();
  for (std::size_t at = text.find(",heat,"); at != std::string::npos;
       at = text.find(",heat,", at + 1)) {
    text.replace(at + 6, text.find(',', at + 6) - at - 6, std::to_string(10'000 + at / 50));
  }
  write("readings.csv", text);
  const std::string doubt =
      "The values hardly ever fall, as those of a cumulative register; if it is one, "
      "add rated_kW = ";
  for (const char* command : {"check", "replay"}) {
    const Outcome outcome = run({command, site()});
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("! district_heat: " + doubt));
    EXPECT_THAT(outcome.err, HasSubstr("counter = { unit = \"kWh\" } to its [[meter]]."));
    EXPECT_THAT(outcome.err, Not(HasSubstr("! electricity: " + doubt)));
  }
}

// Who says how long zeros may last need not be asked.
TEST_F(Cli, ZerosThatTheSiteFileSpeaksOfAreNoFinding) {
  std::string text = quarter_readings();
  std::size_t at = 0;
  for (int i = 0; i < 84; ++i) {
    at = text.find(",heat,", at + 1);
    text.replace(at + 6, text.find(',', at + 6) - at - 6, "0");
  }
  write("readings.csv", text);
  EXPECT_THAT(run({"replay", site()}).err, Not(HasSubstr("Exactly zero")));
  write("site.toml", edited(std::string{kSampleMeters}, "zero_run_max = \"96h\"\n", ""));
  EXPECT_THAT(run({"replay", site()}).err, HasSubstr("Exactly zero for 3.5 days"));
}

TEST_F(Cli, MeterThatTheFileDoesNotHaveIsOneSentence) {
  write("site.toml", edited(std::string{kSampleMeters}, "\"heat\"", "\"heet\""));
  const Outcome outcome = run({"replay", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err,
              HasSubstr("recald: " + path("readings.csv") +
                        " has no usable row of meter 'heet'; 1 meter is not configured, "
                        "and its lines were left out: heat (2159)\n"));
}

TEST_F(Cli, SiteWithoutModelIsOneSentence) {
  for (const char* command : {"calibrate", "profile"}) {
    const Outcome outcome = run({command, site()});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_EQ(outcome.err,
              "recald: site.toml describes meters but no [[model]]; add one with a [building] and "
              "a [period] to calibrate, or a [weather] with the temperature, on which `recald "
              "calibrate` forecasts meters without a model, or use `recald replay`\n")
        << command;
  }
}

TEST_F(Cli, MissingWeatherIsOneSentence) {
  write("site.toml", sample_site());
  for (const char* command : {"calibrate", "profile"}) {
    const Outcome outcome = run({command, site()});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_THAT(outcome.err, HasSubstr("weather.csv'")) << command;
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

// The meters are fine: the sentence must not send people to look for readings.
TEST_F(Cli, WeatherOfAnotherYearIsOneSentenceThatNamesTheMonth) {
  write("site.toml", sample_site());
  write("weather.csv", weather_of(2019));
  for (const char* command : {"calibrate", "profile"}) {
    const Outcome outcome = run({command, site()});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_EQ(outcome.err.substr(outcome.err.find("recald: ")),
              "recald: the weather covers no calibration month from 2021-01 to 2021-09 (of 2021-01 "
              "it has 0 %); give weather of these months, or change [period]\n")
        << command;
  }
}

TEST_F(Cli, ProfileSplitsTheMeterIntoLightsAndPlugs) {
  write("site.toml", edited(edited(sample_site(), "to = \"2021-09\"", "to = \"2021-02\""),
                            "from = \"2021-10\"", "from = \"2021-03\""));
  write("weather.csv", weather_of(2021));
  const Outcome outcome = run({"profile", site(), "--json", "--out", path("made")});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(read_text(folder_ / "made/profile.json"), outcome.out);
  const auto json = nlohmann::json::parse(outcome.out);
  for (int hour = 0; hour < 24; ++hour) {
    SCOPED_TRACE(hour);
    const auto at = [&](const char* part) { return json[part]["workday"][hour].get<double>(); };
    EXPECT_EQ(at("measured_kW"), hour % 2 == 0 ? 40.0 : 60.0);
    EXPECT_NEAR(at("lights_kW") + at("plugs_kW") + at("fans_and_pumps_kW"), at("measured_kW"),
                1e-9);
  }
  EXPECT_THAT(run({"profile", site()}).out, HasSubstr("One load profile predicts the electricity"));
}

}  // namespace
}  // namespace recald::daemon
