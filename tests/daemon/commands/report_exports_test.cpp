/// `recald report` of exports: the page of the site that `recald init` would write, without writing
/// one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../command_line.hpp"
#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::report_exports_test {
namespace {

using metering::LocalCalendar;
using recald::testing::clock_text;
using recald::testing::made_up_use;
using recald::testing::read_text;
using recald::testing::with_comma;
using recald::testing::with_point;
using recald::testing::write_text;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;
using testing::run;

metering::Day day(const std::string& text) { return *metering::parse_day(text); }

/// Works in a folder of its own, where init would write.
class ReportExports : public ::testing::Test {
 protected:
  ReportExports() {
    std::filesystem::current_path(folder_.path());
    ::setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  }
  ~ReportExports() override {
    ::unsetenv("SOURCE_DATE_EPOCH");
    std::filesystem::current_path(before_);
  }

  /// Two meters of a German portal, local stamps.
  void write_portal(const std::string& file, const std::string& first, const std::string& last) {
    const auto truth = made_up_use(berlin_, {day(first), day(last), minutes{15}}, 1, 25.0);
    std::string text = "Zeit;Main (kWh);Fernw\xC3\xA4rme (MWh)\r\n";
    for (const auto& [start, value] : truth.intervals) {
      text += clock_text(berlin_, start + minutes{15}, "%d.%m.%Y %H:%M") + ";" + with_comma(value) +
              ";" + with_comma(0.002 * value) + "\r\n";
    }
    write_text(file, text);
  }
  /// recald's own format, which needs no zone.
  static void write_own(const std::string& file) {
    std::string text = "timestamp,meter,value,unit\n";
    metering::Instant t = std::chrono::sys_days{day("2024-01-01")};
    for (int i = 0; i < 96 * 45; ++i, t += minutes{15}) {
      text += metering::to_string(t) + ",main," + std::to_string(10 + i % 7) + ",kW\n";
    }
    write_text(file, text);
  }
  void write_workbook(const std::string& file) const {
    const auto truth =
        made_up_use(berlin_, {day("2024-01-01"), day("2024-02-29"), minutes{60}}, 3, 40.0);
    std::vector<recald::testing::WorkbookRow> rows;
    for (const auto& [start, value] : truth.intervals) {
      rows.push_back({recald::testing::spreadsheet_day(berlin_, start), {value, 0.5 * value}});
    }
    recald::testing::write_workbook(file, {"Time", "Main kWh", "CHW [ton-hours]"}, rows);
  }

  /// The page of `report FILES` and that of `init FILES` and `report site.toml` are the same bytes.
  static void expect_same_page(const std::vector<std::string>& files_and_options) {
    std::vector<std::string> words{"report"};
    words.insert(words.end(), files_and_options.begin(), files_and_options.end());
    const Outcome direct = run(words);
    ASSERT_EQ(direct.exit_code, kSuccess) << direct.err;
    EXPECT_FALSE(std::filesystem::exists("site.toml"));
    words.front() = "init";
    const Outcome init = run(words);
    ASSERT_EQ(init.exit_code, kSuccess) << init.err;
    ASSERT_EQ(run({"report", "site.toml", "--out", "of-site.html"}).exit_code, kSuccess);
    const std::string page = read_text("report.html");
    EXPECT_THAT(page, HasSubstr("data-figure=\"load\""));
    EXPECT_TRUE(page == read_text("of-site.html")) << "the pages differ";
  }

  /// @param answer  What somebody types; the words on err come back with the outcome.
  static Outcome asked(const std::string& answer, const std::vector<std::string>& words) {
    std::vector<const char*> argv{"recald"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    std::istringstream in{answer};
    std::ostringstream out;
    std::ostringstream err;
    const Console console{out, err, false, Console::Detail::usual, &in};
    const int code = run_cli(static_cast<int>(argv.size()), argv.data(), console);
    return {code, out.str(), err.str()};
  }

  std::filesystem::path before_ = std::filesystem::current_path();
  recald::testing::TemporaryFolder folder_;
  LocalCalendar berlin_ = *LocalCalendar::open("Europe/Berlin");
};

TEST_F(ReportExports, PortalGivesThePageOfItsSite) {
  write_portal("portal.csv", "2024-01-01", "2024-04-30");
  expect_same_page({"portal.csv", "--timezone", "Europe/Berlin"});
}

TEST_F(ReportExports, OwnFormatGivesThePageOfItsSite) {
  write_own("readings.csv");
  expect_same_page({"readings.csv"});
}

TEST_F(ReportExports, WorkbookGivesThePageOfItsSite) {
  write_workbook("meters.xlsx");
  expect_same_page({"meters.xlsx", "--timezone", "Europe/Berlin"});
}

TEST_F(ReportExports, SeveralFilesGiveThePageOfTheirSite) {
  std::filesystem::create_directory("exports");
  write_portal("exports/b.csv", "2024-03-01", "2024-04-30");
  write_portal("exports/a.csv", "2024-01-01", "2024-02-29");
  write_own("readings.csv");
  expect_same_page(
      {"exports/b.csv", "exports/a.csv", "readings.csv", "--timezone", "Europe/Berlin"});
}

TEST_F(ReportExports, SaysTheGuessesAndWhatInitWouldWrite) {
  write_portal("my portal.csv", "2024-01-01", "2024-02-29");
  const Outcome outcome =
      run({"report", "my portal.csv", "--timezone", "Europe/Berlin", "--out", "page.html"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("  main "), HasSubstr("15 min  2024-01-01 2024-02-29"),
                    HasSubstr("Look at these, on which the page rests:\n  main: taken for "
                              "electricity.\n"),
                    HasSubstr("Wrote page.html. "),
                    HasSubstr("  recald init 'my portal.csv' --timezone Europe/Berlin\n"
                              "writes site.toml with each guess beside its key.\n")));
  EXPECT_TRUE(std::filesystem::exists("page.html"));
  EXPECT_FALSE(std::filesystem::exists("site.toml"));
  // Init writes over no site file, so another folder is named.
  write_text("site.toml", "mine");
  const Outcome beside = run({"report", "my portal.csv", "--timezone", "Europe/Berlin", "--json"});
  ASSERT_EQ(beside.exit_code, kSuccess) << beside.err;
  const auto json = nlohmann::json::parse(beside.out);
  EXPECT_EQ(json.at("page"), "report.html");
  EXPECT_EQ(json.at("site"), "my portal/site.toml");
  EXPECT_EQ(json.at("next"),
            "recald init 'my portal.csv' --timezone Europe/Berlin --out 'my portal'");
  EXPECT_EQ(json.at("meters").size(), 2u);
  EXPECT_EQ(read_text("site.toml"), "mine");
}

// The sentence is init's, whatever is wrong.
TEST_F(ReportExports, IsRefusedAsInitRefuses) {
  write_portal("naive.csv", "2024-01-01", "2024-01-31");
  write_text("empty.csv", "");
  write_text("notimes.csv", "a,b\n1,2\n3,1\n");
  write_text("page.xml", "<html><body>Log in</body></html>");
  const std::vector<std::vector<std::string>> refused{
      {"naive.csv"}, {"naive.csv", "--timezone", "Europe/Berln"},
      {"empty.csv"}, {"notimes.csv"},
      {"page.xml"},  {"nowhere.csv"},
      {"nowhere"},   {"naive.csv", "naive.csv", "--timezone", "Europe/Berlin"}};
  for (std::vector<std::string> words : refused) {
    SCOPED_TRACE(::testing::PrintToString(words));
    words.insert(words.begin(), "report");
    const Outcome report = run(words);
    words.front() = "init";
    const Outcome init = run(words);
    EXPECT_EQ(report.err, init.err);
    EXPECT_EQ(report.exit_code, init.exit_code);
    EXPECT_NE(report.exit_code, kSuccess);
    EXPECT_EQ(std::count(report.err.begin(), report.err.end(), '\n'), 1);
    EXPECT_THAT(report.out, IsEmpty());
    EXPECT_FALSE(std::filesystem::exists("report.html"));
  }
  EXPECT_THAT(run({"report", "naive.csv"}).err, HasSubstr("--timezone"));
}

TEST_F(ReportExports, AsksForTheZoneWhereSomebodyIsThere) {
  write_portal("naive.csv", "2024-01-01", "2024-01-31");
  const Outcome told = asked("  Europe/Berlin \n", {"report", "naive.csv"});
  EXPECT_EQ(told.exit_code, kSuccess) << told.err;
  EXPECT_THAT(told.err, HasSubstr("The building's time zone, such as Europe/Berlin: "));
  EXPECT_THAT(told.out, HasSubstr("recald init naive.csv --timezone Europe/Berlin\n"));
  for (const char* nothing : {"", "\n", " \n"}) {
    const Outcome outcome = asked(nothing, {"report", "naive.csv"});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_THAT(outcome.err, HasSubstr("run again with --timezone"));
  }
  const Outcome wrong = asked("Europe/Berln\n", {"report", "naive.csv"});
  EXPECT_EQ(wrong.exit_code, kUsage);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'Europe/Berlin'?"));
  // Who has said it, or whose stamps say it, is not asked.
  write_own("readings.csv");
  EXPECT_THAT(asked("", {"report", "readings.csv"}).err, Not(HasSubstr("time zone")));
  EXPECT_THAT(asked("", {"report", "naive.csv", "--timezone", "Europe/Berlin"}).err,
              Not(HasSubstr("time zone")));
}

TEST_F(ReportExports, ASiteFileIsNoExport) {
  write_own("readings.csv");
  ASSERT_EQ(run({"init", "readings.csv"}).exit_code, kSuccess);
  EXPECT_EQ(run({"report", "site.toml"}).exit_code, kSuccess);
  EXPECT_TRUE(std::filesystem::exists("report.html"));
  // Under another name it is known by how it begins.
  for (const char* name : {"SITE.TOML", "site.conf", "site"}) {
    std::filesystem::copy_file("site.toml", name);
    EXPECT_EQ(run({"report", name, "--out", "again.html"}).out, "again.html\n") << name;
  }
  EXPECT_THAT(run({"report", "nowhere.toml"}).err, HasSubstr("site file 'nowhere.toml'"));
  EXPECT_THAT(run({"report", "."}).err, HasSubstr("is a folder; name the TOML file in it"));
  const Outcome both = run({"report", "readings.csv", "site.toml"});
  EXPECT_EQ(both.exit_code, kUsage);
  EXPECT_THAT(both.err, HasSubstr("'site.toml' is a site file"));
  const Outcome zone = run({"report", "site.toml", "--timezone", "Europe/Berlin"});
  EXPECT_EQ(zone.exit_code, kUsage);
  EXPECT_THAT(zone.err, HasSubstr("--timezone is for exports"));
}

}  // namespace
}  // namespace recald::daemon::report_exports_test
