/// What single files leave open and the others of their kind settle; what their rows show together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "../command_line.hpp"
#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::init_kinds_test {
namespace {

using metering::Day;
using metering::Instant;
using metering::LocalCalendar;
using recald::testing::clock_text;
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

struct Written {
  std::string name;
  const char* first;
  const char* last;
  std::string header = "Time,Load (kWh)";
  std::string pattern = "%Y-%m-%d %H:%M";
  std::string zone = "Europe/Berlin";
  int minutes = 60;
};

/// A row's cell of a value; registers add up what comes before.
using CellOf = std::function<std::string(Instant start, double value)>;

class InitKinds : public ::testing::Test {
 protected:
  Outcome init(const std::vector<std::string>& files, std::vector<std::string> more = {}) const {
    std::filesystem::remove_all(folder_ / "site");
    std::vector<std::string> words{"init", "--timezone", "Europe/Berlin", "--out",
                                   (folder_ / "site").string()};
    for (const std::string& file : files) words.push_back((folder_ / file).string());
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  [[nodiscard]] std::string site() const { return read_text(folder_ / "site/site.toml"); }
  [[nodiscard]] static std::size_t meters(const std::string& toml) {
    std::size_t count = 0;
    for (std::size_t at = toml.find("[[meter]]"); at != std::string::npos;
         at = toml.find("[[meter]]", at + 1)) {
      ++count;
    }
    return count;
  }

  void write(const Written& file, const CellOf& cell_of = {}) const {
    const LocalCalendar calendar = LocalCalendar::open(file.zone).value();
    const auto truth =
        made_up_use(calendar, {day(file.first), day(file.last), minutes{file.minutes}}, 1, 40.0);
    std::string text = file.header + "\n";
    for (const auto& [start, value] : truth.intervals) {
      text += clock_text(calendar, start, file.pattern) + "," +
              (cell_of ? cell_of(start, value) : with_point(value)) + "\n";
    }
    write_text(folder_ / file.name, text);
  }

  recald::testing::TemporaryFolder folder_;
};

// A month's first days may be months; another file of the portal has a day after the twelfth.
TEST_F(InitKinds, TheOrderOfDatesOfOneFileHoldsForAll) {
  for (const std::string pattern : {"%d/%m/%Y %H:%M", "%m/%d/%Y %H:%M"}) {
    write({.name = "a.csv", .first = "2024-01-01", .last = "2024-01-31", .pattern = pattern});
    write({.name = "b.csv", .first = "2024-02-01", .last = "2024-02-01", .pattern = pattern});
    ASSERT_EQ(init({"b.csv"}).exit_code, kFailure);
    const Outcome both = init({"b.csv", "a.csv"});
    ASSERT_EQ(both.exit_code, kSuccess) << both.err;
    EXPECT_EQ(meters(site()), 1U) << site();
    const std::string order = pattern.starts_with("%d") ? "dd/mm/yyyy" : "mm/dd/yyyy";
    EXPECT_THAT(site(), HasSubstr("time_format = \"" + order + "\""));
  }
}

// Neither month alone shows both changes.
TEST_F(InitKinds, AClockThatNeverChangesShowsInAllMonthsTogether) {
  const std::string zone = "Etc/GMT-1";
  write({.name = "03.csv", .first = "2024-03-01", .last = "2024-03-31", .zone = zone});
  write({.name = "10.csv", .first = "2024-10-01", .last = "2024-10-31", .zone = zone});
  const Outcome both = init({"03.csv", "10.csv"});
  ASSERT_EQ(both.exit_code, kSuccess) << both.err;
  EXPECT_THAT(site(), HasSubstr("timezone = \"Etc/GMT-1\""));
  EXPECT_THAT(site(), Not(HasSubstr("stamps = \"end\"")));
  ASSERT_EQ(init({"03.csv"}).exit_code, kSuccess);
  EXPECT_THAT(site(), Not(HasSubstr("Etc/GMT-1")));
}

TEST_F(InitKinds, ZerosInTheHoursOfTheChangesAreAskedAbout) {
  const LocalCalendar clock = LocalCalendar::open("Etc/GMT-1").value();
  const auto rests_at_night = [&](Instant start, double value) {
    return clock.local_time(start).minute_of_day < 360 ? "0" : with_point(value);
  };
  write({.name = "y.csv", .first = "2024-02-01", .last = "2024-11-30", .zone = "Etc/GMT-1"},
        rests_at_night);
  const Outcome asked = init({"y.csv"});
  EXPECT_EQ(asked.exit_code, kFailure) << asked.out;
  EXPECT_THAT(asked.err, AllOf(HasSubstr("2024-03-31"), HasSubstr("--clock Etc/GMT-1"),
                               HasSubstr("Europe/Berlin")));
  EXPECT_EQ(init({"y.csv"}, {"--clock", "Etc/GMT-1"}).exit_code, kSuccess);
  // On the building's clock the autumn's hour comes twice.
  write({.name = "y.csv", .first = "2024-02-01", .last = "2024-11-30"}, rests_at_night);
  EXPECT_EQ(init({"y.csv"}).exit_code, kSuccess);
}

TEST_F(InitKinds, TheClockOfAnotherCountryIsAskedAbout) {
  for (const auto& [zone, other] :
       {std::pair{"America/Chicago", "America/New_York"}, std::pair{"Australia/Sydney", ""},
        std::pair{"Pacific/Auckland", ""}, std::pair{"Europe/London", ""}}) {
    write({.name = "y.csv", .first = "2024-01-01", .last = "2024-12-31", .zone = zone});
    const Outcome asked = init({"y.csv"});
    EXPECT_EQ(asked.exit_code, kFailure) << zone << asked.out;
    EXPECT_THAT(asked.err,
                AllOf(HasSubstr("twice"), HasSubstr(zone), HasSubstr(other), HasSubstr("--clock")));
    EXPECT_EQ(init({"y.csv"}, {"--clock", zone}).exit_code, kSuccess);
  }
}

// A last download of some days, in which a register that falls to zero each night hardly falls.
TEST_F(InitKinds, AShortFileHasTheRegistersOfTheLongOnes) {
  for (const bool is_daily : {true, false}) {
    const LocalCalendar berlin = LocalCalendar::open("Europe/Berlin").value();
    double sum = 0.0;
    Day last_day{};
    const auto reading = [&](Instant start, double value) {
      const std::string text = with_point(sum);
      const Day today = berlin.local_time(start).date;
      if (is_daily && today != last_day) sum = 0.0;
      last_day = today;
      sum += value;
      return text;
    };
    const std::string header = "Time,Load total (kWh)";
    write({.name = "a.csv", .first = "2024-04-01", .last = "2024-05-31", .header = header},
          reading);
    write({.name = "b.csv", .first = "2024-06-01", .last = "2024-06-01", .header = header},
          reading);
    const Outcome both = init({"a.csv", "b.csv"});
    ASSERT_EQ(both.exit_code, kSuccess) << both.err;
    EXPECT_EQ(meters(site()), 1U) << site();
    EXPECT_THAT(site(), HasSubstr(is_daily ? "resets = \"day\"" : "counter = { unit = \"kWh\" }"));
  }
}

// A day in which a load only rises is no register, if the other files are none.
TEST_F(InitKinds, AShortFileOfAmountsIsNoRegister) {
  write({.name = "a.csv", .first = "2024-04-01", .last = "2024-05-31"});
  double value_kWh = 3.0;
  write({.name = "b.csv", .first = "2024-06-01", .last = "2024-06-01"},
        [&](Instant, double) { return with_point(value_kWh += 0.25); });
  const Outcome alone = init({"b.csv"});
  EXPECT_THAT(site(), HasSubstr("counter = { unit = \"kWh\" }")) << alone.err;
  const Outcome both = init({"a.csv", "b.csv"});
  ASSERT_EQ(both.exit_code, kSuccess) << both.err;
  EXPECT_EQ(meters(site()), 1U) << site();
  EXPECT_THAT(site(), Not(HasSubstr("counter")));
}

// Ends of intervals in UTC: in summer they begin and end at the midnights of UTC as starts would;
// the months of winter, when the building's clock shows UTC, settle it.
TEST_F(InitKinds, EndsInUtcAreSettledByTheMonthsOfWinter) {
  const LocalCalendar lisbon = LocalCalendar::open("Europe/Lisbon").value();
  for (const bool are_ends : {true, false}) {
    SCOPED_TRACE(are_ends);
    const std::vector<std::array<const char*, 3>> months{{"a.csv", "2024-08-01", "2024-08-31"},
                                                         {"b.csv", "2024-09-01", "2024-09-30"},
                                                         {"c.csv", "2024-11-01", "2024-11-30"}};
    for (const auto& [name, first, last] : months) {
      const auto truth = made_up_use(lisbon, {day(first), day(last), minutes{60}}, 1, 40.0);
      std::string text = "Time (UTC),Load (kWh)\n";
      for (const auto& [start, value] : truth.intervals) {
        const Instant shown = start + (are_ends ? minutes{60} : minutes{0});
        std::string stamp = metering::to_string(shown).substr(0, 16);
        stamp[10] = ' ';
        text += stamp + "," + with_point(value) + "\n";
      }
      write_text(folder_ / name, text);
    }
    std::filesystem::remove_all(folder_ / "site");
    std::vector<std::string> words{"init", "--timezone", "Europe/Lisbon", "--out",
                                   (folder_ / "site").string()};
    for (const char* name : {"a.csv", "b.csv", "c.csv"}) words.push_back((folder_ / name).string());
    const Outcome all = run(words);
    ASSERT_EQ(all.exit_code, kSuccess) << all.err;
    EXPECT_THAT(site(), HasSubstr(are_ends ? "stamps = \"end\"" : "stamps = \"start\""));
    EXPECT_THAT(site(), Not(HasSubstr(are_ends ? "stamps = \"start\"" : "stamps = \"end\"")));
  }
}

// Mean, energy and share measured are those of all files.
TEST_F(InitKinds, TheTableCountsAllFilesOfAMeter) {
  for (const char* name : {"a.csv", "b.csv"}) {
    const bool is_second = name[0] == 'b';
    write({.name = name,
           .first = is_second ? "2024-02-01" : "2024-01-01",
           .last = is_second ? "2024-02-29" : "2024-01-31"},
          [&](Instant start, double) {
            const auto minute = start.time_since_epoch() / minutes{1};
            return with_point((is_second ? 30.0 : 10.0) + 0.01 * static_cast<double>(minute % 7));
          });
  }
  const Outcome both = init({"a.csv", "b.csv"});
  ASSERT_EQ(both.exit_code, kSuccess) << both.err;
  // (31 · 10 + 29 · 30) / 60 and the hundredths.
  EXPECT_THAT(both.out, AllOf(HasSubstr(" 19.7 "), HasSubstr("100.0 %"), HasSubstr("2024-02-29")));
}

// Of the days at the seam all were corrected later.
TEST_F(InitKinds, ASeamThatWasCorrectedJoins) {
  write({.name = "a.csv", .first = "2024-01-01", .last = "2024-02-02"});
  write({.name = "b.csv", .first = "2024-02-01", .last = "2024-02-29"},
        [](Instant, double value) { return with_point(1.25 * value); });
  const Outcome both = init({"a.csv", "b.csv"});
  ASSERT_EQ(both.exit_code, kSuccess) << both.err;
  EXPECT_EQ(meters(site()), 1U) << site();
  EXPECT_THAT(both.out, HasSubstr("has other values than earlier files"));
}

// From January on every half hour.
TEST_F(InitKinds, FilesOfAnotherStepJoinAtTheLonger) {
  write({.name = "a.csv", .first = "2023-12-01", .last = "2023-12-31"});
  write({.name = "b.csv", .first = "2024-01-01", .last = "2024-01-31", .minutes = 30});
  const Outcome both = init({"a.csv", "b.csv"});
  ASSERT_EQ(both.exit_code, kSuccess) << both.err;
  EXPECT_EQ(meters(site()), 1U) << site();
  EXPECT_THAT(site(), HasSubstr("interval = \"1h\""));
  EXPECT_THAT(both.out, HasSubstr("every 30 min, earlier files every 60 min"));
}

// "Reading" in each file: what they are of, their names say.
TEST_F(InitKinds, MetersThatAreCalledAlikeHaveTheirFilesNames) {
  const std::string header = "Time,Reading (kWh)";
  write({.name = "Gas.csv", .first = "2024-01-01", .last = "2024-01-31", .header = header});
  write({.name = "Lifts.csv", .first = "2024-01-01", .last = "2024-01-31", .header = header},
        [](Instant, double value) { return with_point(0.3 * value + 1.0); });
  const Outcome both = init({"Gas.csv", "Lifts.csv"});
  ASSERT_EQ(both.exit_code, kSuccess) << both.err;
  EXPECT_THAT(site(), AllOf(HasSubstr("id = \"gas\""), HasSubstr("id = \"lifts\""),
                            HasSubstr("utility = \"gas\""), HasSubstr("by its file's name")));
}

TEST_F(InitKinds, AFileAndItsColumnMayNameTwoUtilities) {
  write({.name = "Fernwaerme.csv",
         .first = "2024-01-01",
         .last = "2024-01-31",
         .header = "Zeit,Stromverbrauch (kWh)"});
  const Outcome one = init({"Fernwaerme.csv"});
  ASSERT_EQ(one.exit_code, kSuccess) << one.err;
  EXPECT_THAT(site(), HasSubstr("utility = \"electricity\""));
  EXPECT_THAT(one.out, HasSubstr("taken for electricity, by its name, though its file's name says "
                                 "heating"));
}

// Two values of each time, and nothing that says of what.
TEST_F(InitKinds, RowsThatNothingTellsApartAreRefused) {
  write({.name = "two.csv", .first = "2024-02-01", .last = "2024-02-29"},
        [](Instant, double value) { return with_point(value); });
  std::string doubled;
  const std::string text = read_text(folder_ / "two.csv");
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    doubled += line + "\n";
    if (at > 0) doubled += line.substr(0, line.find(',')) + ",0.125\n";
    at = end + 1;
  }
  write_text(folder_ / "two.csv", doubled);
  const Outcome refused = init({"two.csv"});
  EXPECT_EQ(refused.exit_code, kFailure) << refused.out;
  EXPECT_THAT(refused.err, AllOf(HasSubstr("same time"), HasSubstr("--meter-column")));
}

// Numbers of rows, contracts and prices, and columns of nothing but zeros are no meters.
TEST_F(InitKinds, ColumnsThatMeasureNothingAreNamed) {
  int row = 0;
  write({.name = "c.csv",
         .first = "2024-02-01",
         .last = "2024-02-29",
         .header = "Time,Lp.,Load (kWh),Rate (p/kWh),Avtal,Export (kWh)"},
        [&](Instant, double value) {
          ++row;
          return std::to_string(row) + "," + with_point(value) + "," +
                 (row % 24 < 7 ? "0.1243" : "0.3121") + ",2442748,0.000";
        });
  const Outcome outcome = init({"c.csv"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(meters(site()), 1U) << site();
  EXPECT_THAT(
      outcome.out,
      AllOf(HasSubstr("Lp. (the number of a row)"), HasSubstr("Rate (p/kWh) (money)"),
            HasSubstr("Avtal (an identifier)"), HasSubstr("'Export' is zero in all its rows")));
}

}  // namespace
}  // namespace recald::daemon::init_kinds_test
