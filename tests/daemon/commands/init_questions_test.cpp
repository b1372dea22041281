/// What no evidence settles is asked of whoever is there, and refused with the option that answers
/// it where nobody is.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "../command_line.hpp"
#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::init_questions_test {
namespace {

using metering::Day;
using metering::LocalCalendar;
using recald::testing::clock_text;
using recald::testing::ExportTruth;
using recald::testing::made_up_use;
using recald::testing::read_text;
using recald::testing::with_point;
using recald::testing::write_text;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::run;

Day day(const char* text) { return metering::parse_day(text).value(); }

class InitQuestions : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] std::string site() const { return path("site/site.toml"); }

  Outcome init(const std::vector<std::string>& files, std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"init", "--timezone", "Europe/Berlin", "--out", path("site")};
    for (const std::string& file : files) words.push_back(path(file));
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  /// As `init`, with somebody at the console who types these lines.
  Outcome init_asked(const std::string& file, const std::string& lines) const {
    std::istringstream answers{lines};
    std::ostringstream out;
    std::ostringstream err;
    const std::vector<std::string> words{"recald", "init",       "--timezone", "Europe/Berlin",
                                         "--out",  path("site"), path(file)};
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    Console console{out, err, false};
    console.answers = &answers;
    const int code = run_cli(static_cast<int>(argv.size()), argv.data(), console);
    return {code, out.str(), err.str()};
  }

  /// A quarter of an hour a row on Berlin's clock. @param pattern  Of its stamps, as strftime.
  void write_export(const std::string& name, const std::string& header, const char* from,
                    const char* to, const std::string& pattern = "%Y-%m-%d %H:%M",
                    unsigned seed = 1, const std::string& zone = "Europe/Berlin") const {
    const LocalCalendar calendar = LocalCalendar::open(zone).value();
    std::string text = header + "\n";
    for (const auto& [start, value] :
         made_up_use(calendar, {day(from), day(to), minutes{15}}, seed, 40.0).intervals) {
      text += clock_text(calendar, start, pattern) + "," + with_point(value) + "\n";
    }
    write_text(folder_ / name, text);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(InitQuestions, AUnitThatNothingSaysIsRefusedWithItsOption) {
  for (const std::string name : {"Value", "Total load", "Lastgang", "P1"}) {
    write_export("load.csv", "Time," + name, "2024-02-01", "2024-02-29");
    const Outcome refused = init({"load.csv"});
    EXPECT_EQ(refused.exit_code, kFailure) << refused.out;
    EXPECT_THAT(refused.err,
                AllOf(HasSubstr("nothing says the unit of '" + name + "'"), HasSubstr("--unit")));
    EXPECT_FALSE(std::filesystem::exists(site()));
    for (const std::string& unit : {std::string{"kW"}, name + "=kW"}) {
      const Outcome told = init({"load.csv"}, {"--unit", unit});
      EXPECT_EQ(told.exit_code, kSuccess) << told.err;
      EXPECT_THAT(read_text(site()), HasSubstr("unit = \"kW\"")) << unit;
      std::filesystem::remove_all(path("site"));
    }
  }
}

// As home automation names its sensors, a row a value.
TEST_F(InitQuestions, AUnitInTheNameOfARowsMeterIsSaid) {
  const LocalCalendar calendar = LocalCalendar::open("Europe/Berlin").value();
  std::string text = "entity_id,state,last_changed\n";
  for (const auto& [start, value] :
       made_up_use(calendar, {day("2024-02-01"), day("2024-02-29"), minutes{15}}, 1, 40.0)
           .intervals) {
    for (const char* name : {"sensor.main_power_kw", "sensor.pump_wh"}) {
      text += std::string{name} + "," + with_point(value) + "," + metering::to_string(start) + "\n";
    }
  }
  write_text(folder_ / "history.csv", text);
  const Outcome outcome = init({"history.csv"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(read_text(site()), AllOf(HasSubstr("unit = \"kw\""), HasSubstr("unit = \"wh\""),
                                       HasSubstr("as its name says")));
}

TEST_F(InitQuestions, SomebodyAtTheConsoleIsAsked) {
  write_export("load.csv", "Time,Value", "2024-02-01", "2024-02-29");
  const Outcome asked = init_asked("load.csv", "kW\n");
  EXPECT_EQ(asked.exit_code, kSuccess) << asked.err;
  EXPECT_THAT(asked.out, HasSubstr("nothing says the unit of 'Value'"));
  EXPECT_THAT(read_text(site()), HasSubstr("unit = \"kW\""));
  std::filesystem::remove_all(path("site"));
  EXPECT_EQ(init_asked("load.csv", "\n").exit_code, kFailure);
  EXPECT_FALSE(std::filesystem::exists(site()));
}

// Days up to the twelfth may be months as well.
TEST_F(InitQuestions, AnOrderOfDatesThatNothingSaysIsAsked) {
  write_export("one.csv", "Time,Load (kWh)", "2024-03-03", "2024-03-03", "%d/%m/%Y %H:%M");
  const Outcome refused = init({"one.csv"});
  EXPECT_EQ(refused.exit_code, kFailure) << refused.out;
  EXPECT_THAT(refused.err, AllOf(HasSubstr("its dates may be"), HasSubstr("--dates dd/mm/yyyy")));
  EXPECT_EQ(init({"one.csv"}, {"--dates", "mm/dd/yyyy"}).exit_code, kSuccess);
  EXPECT_THAT(read_text(site()), HasSubstr("time_format = \"mm/dd/yyyy\""));
}

TEST_F(InitQuestions, WhatNoBuildingUsesIsNotWritten) {
  write_export("main.csv", "Time,Main (GWh)", "2024-02-01", "2024-02-29");
  const std::string text = read_text(folder_ / "main.csv");
  write_text(folder_ / "main.csv", "Time,Main (MWh)" + text.substr(text.find('\n')));
  const Outcome plain = init({"main.csv"});
  // 40 MWh a quarter of an hour are 160 MW.
  EXPECT_EQ(plain.exit_code, kFailure) << plain.out;
  EXPECT_THAT(plain.err, AllOf(HasSubstr("which no building does"), HasSubstr("--unit")));
  EXPECT_FALSE(std::filesystem::exists(site()));
}

// A clock that stays on winter time shows it on both days on which others change.
TEST_F(InitQuestions, AFixedClockNeedsBothChanges) {
  write_export("year.csv", "Time,Load (kWh)", "2024-02-01", "2024-11-30", "%Y-%m-%d %H:%M", 1,
               "Etc/GMT-1");
  const Outcome both = init({"year.csv"});
  EXPECT_EQ(both.exit_code, kSuccess) << both.err;
  EXPECT_THAT(read_text(site()), HasSubstr("timezone = \"Etc/GMT-1\""));
  EXPECT_THAT(both.out, HasSubstr("read on the clock Etc/GMT-1"));
  std::filesystem::remove_all(path("site"));

  write_export("spring.csv", "Time,Load (kWh)", "2024-02-01", "2024-05-31", "%Y-%m-%d %H:%M", 1,
               "Etc/GMT-1");
  const Outcome one = init({"spring.csv"});
  EXPECT_EQ(one.exit_code, kSuccess) << one.err;
  EXPECT_THAT(read_text(site()), Not(HasSubstr("Etc/GMT-1\"")));
  EXPECT_THAT(one.out, AllOf(HasSubstr("4 rows in an hour that the clock of Europe/Berlin jumps"),
                             HasSubstr("--clock Etc/GMT-1")));
  std::filesystem::remove_all(path("site"));
  EXPECT_EQ(init({"spring.csv"}, {"--clock", "Etc/GMT-1"}).exit_code, kSuccess);
  EXPECT_THAT(read_text(site()), HasSubstr("timezone = \"Etc/GMT-1\""));
}

// Stamps that do not exist, as a program slips them in: the clock is the building's all the same.
TEST_F(InitQuestions, OneOddStampIsNoClock) {
  for (const char* odd : {"2024-03-31 02:00,12.000\n", "2024-03-31 02:30,0.000\n",
                          "2024-03-31 02:15,\n2024-03-31 02:30,\n"}) {
    write_export("year.csv", "Time,Load (kWh)", "2024-02-01", "2024-11-30");
    std::string text = read_text(folder_ / "year.csv");
    text.insert(text.find("2024-03-31 03:00"), odd);
    write_text(folder_ / "year.csv", text);
    const Outcome outcome = init({"year.csv"});
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    EXPECT_THAT(read_text(site()), Not(HasSubstr("Etc/GMT"))) << odd;
    std::filesystem::remove_all(path("site"));
  }
}

// What is said is not guessed: the interval of a file of two rows, which columns are meters.
TEST_F(InitQuestions, WhatIsSaidIsNotGuessed) {
  write_text(folder_ / "holes.csv",
             "Time,A (kWh),B (kWh)\n2024-03-13 00:00,1.5,2.5\n2024-03-13 01:00,1.7,2.5\n"
             "2024-03-13 02:00,1.25,2.75\n2024-03-13 02:15,1.5,2.25\n");
  ASSERT_EQ(
      init({"holes.csv"}, {"--interval", "15", "--column", "B (kWh)", "--stamps", "end"}).exit_code,
      kSuccess);
  EXPECT_THAT(read_text(site()),
              AllOf(HasSubstr("interval = \"15m\""), HasSubstr("column = \"B (kWh)\""),
                    HasSubstr("stamps = \"end\""), Not(HasSubstr("A (kWh)"))));
  std::filesystem::remove_all(path("site"));
  EXPECT_THAT(init({"holes.csv"}).err, HasSubstr("is no start of an interval of 60 minutes"));
  EXPECT_THAT(init({"holes.csv"}, {"--column", "C"}).err, HasSubstr("it has no column 'C'"));
}

// Downloads that overlap are one meter, and the one that ends later corrects the others.
TEST_F(InitQuestions, DownloadsThatOverlapAreOneMeter) {
  write_export("a.csv", "Time,Load (kWh)", "2024-01-01", "2024-02-10");
  write_export("b.csv", "Time,Load (kWh)", "2024-01-01", "2024-03-10");
  write_export("c.csv", "Time,Load (kWh)", "2024-01-01", "2024-04-10");
  std::string text = read_text(folder_ / "b.csv");
  const auto at = text.find("2024-02-05 10:00,");
  text.replace(at, text.find('\n', at) - at, "2024-02-05 10:00,999.000");
  write_text(folder_ / "b.csv", text);
  const Outcome outcome = init({"c.csv", "a.csv", "b.csv"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const std::string written = read_text(site());
  EXPECT_THAT(written, AllOf(HasSubstr("a.csv\", "), Not(HasSubstr("load-2"))));
  const Outcome replayed = run({"replay", site(), "--out", path("results")});
  EXPECT_EQ(replayed.exit_code, kSuccess) << replayed.err;
  EXPECT_THAT(read_text(folder_ / "results/months.csv"), HasSubstr("2024-04"));
}

}  // namespace
}  // namespace recald::daemon::init_questions_test
