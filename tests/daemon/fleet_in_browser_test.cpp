/// The pages of a fleet in headless Chromium, served by the real program from a real PostgreSQL:
/// what tests/pages/browser/check_pages.mjs asks of every page, and an operator's clicks
/// (check_fleet.mjs).
#include <gmock/gmock.h>

#include <cstdio>
#include <sstream>

#include "adapters/record/jobs.hpp"
#include "tests/adapters/record/record_fixture.hpp"
#include "tests/support/background_process.hpp"

namespace recald::daemon::fleet_in_browser_test {
namespace {

using recald::testing::BackgroundProcess;
using recald::testing::eventually;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using record::month_of;

constexpr int kSkipped = 77;
const std::string kBrowser = RECALD_SOURCE_DIR "/tests/pages/browser/";

/// @return the exit code, and what was said.
std::pair<int, std::string> run(const std::string& command) {
  std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {-1, "no pipe"};
  std::string said;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) said += static_cast<char>(c);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, said};
}

class FleetInBrowser : public record::Record {
 protected:
  void SetUp() override {
    Record::SetUp();
    if (IsSkipped()) return;
    ASSERT_NO_FATAL_FAILURE(fill());
    write_text(folder_ / "fleet.toml", "[record]\nurl = \"" + url_ +
                                           "\"\n[mqtt]\nurl = \"mqtt://127.0.0.1:1\"\n[http]\n"
                                           "listen = \"127.0.0.1:0\"\n");
    serving_ = std::make_unique<BackgroundProcess>(
        std::vector<std::string>{RECALD_PROGRAM, "fleet", "serve",
                                 (folder_ / "fleet.toml").string()},
        folder_ / "said.txt");
    ASSERT_TRUE(eventually([this] { return !port().empty(); })) << said();
  }

  /// Three sites: one with a cause and a change, one whose job failed, one that is silent.
  void fill() {
    auto south = record::described("south");
    south.use = "laboratory & office";
    south.climate = "2A";
    south.latitude_deg = 29.8;
    south.longitude_deg = -95.4;
    auto north = record::described("north");
    north.longitude_deg = -74.0;
    north.name = "Hall <north>";
    ASSERT_TRUE(record::put_site(*connection_, south, "ann"));
    ASSERT_TRUE(record::put_site(*connection_, north, "ann"));
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    for (const char* site : {"south", "north"}) {
      record::RecordBatch batch{.outbox = 11, .is_first = true};
      std::int64_t number = 0;
      for (const unsigned month : {2u, 3u}) {
        for (const char* meter : {"steam", "power"}) {
          batch.entries.push_back(
              record::month_entry(++number, meter, month_of(2024, month), 100.0));
        }
      }
      const auto taken = record::take(*connection_, site, batch, now);
      ASSERT_TRUE(taken) << taken.error().message;
    }
    for (int i = 0; i < 4; ++i) ASSERT_NO_FATAL_FAILURE(finish_next());
  }
  void finish_next() {
    const auto leased = record::lease(*connection_, "w1", {});
    ASSERT_TRUE(leased && *leased);
    const record::FleetJob& job = **leased;
    if (job.site == "south") {
      ASSERT_TRUE(record::fail(*connection_, job, "there are 2 months, and 12 are needed").value());
      return;
    }
    const record::FleetResult result{
        .accepted = true,
        .summary = R"({"outputs":[{"meter":"steam","unit":"kWh/day","measured":100.0,
          "cvrmse":0.21,"gap_money_month":1234.0}],
          "alarms":[{"sentence":"Steam is 8 % above its forecast since March."}],
          "meter_changes":[]})",
        .files = {{"calibration.json", "{}"},
                  {"report.html", "<!doctype html><title>Calibration</title><h1>Report</h1>"}}};
    ASSERT_TRUE(record::finish(*connection_, job, result).value());
  }

  [[nodiscard]] std::string said() const {
    const auto file = folder_ / "said.txt";
    return std::filesystem::exists(file) ? read_text(file) : "";
  }
  [[nodiscard]] std::string port() const {
    const std::string text = said();
    const std::size_t at = text.find("listening on 127.0.0.1:");
    const std::size_t end = text.find('\n');
    return at == std::string::npos || end == std::string::npos
               ? ""
               : text.substr(at + 23, end - at - 23);
  }
  [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + port(); }

  TemporaryFolder folder_;
  std::unique_ptr<BackgroundProcess> serving_;
};

TEST_F(FleetInBrowser, ItsPagesPassAxeAtThreeWidthsLightDarkAndOnPaper) {
  std::ostringstream command;
  command << RECALD_NODE << ' ' << kBrowser << "check_pages.mjs --modules " RECALD_BROWSER_MODULES;
  for (const char* path : {"/", "/sites/north", "/rerun", "/audit"}) {
    command << ' ' << address() << path;
  }
  const auto [code, words] = run(command.str());
  if (code == kSkipped) GTEST_SKIP() << words;
  EXPECT_EQ(code, 0) << words << said();
}

TEST_F(FleetInBrowser, AnOperatorFindsTheSiteAndLetsItsJobRunAgain) {
  const auto [code, words] =
      run(std::string{RECALD_NODE} + " " + kBrowser + "check_fleet.mjs " + address());
  if (code == kSkipped) GTEST_SKIP() << words;
  EXPECT_EQ(code, 0) << words << said();
  EXPECT_EQ(ask("SELECT s.id, j.month, j.asked_by FROM job j JOIN site s ON s.number = j.site "
                "WHERE j.state = 'waiting'"),
            "south|2024-03|rerun\n");
  EXPECT_EQ(ask("SELECT who, subject FROM audit WHERE action = 'rerun'"), "page|south\n");
}

}  // namespace
}  // namespace recald::daemon::fleet_in_browser_test
