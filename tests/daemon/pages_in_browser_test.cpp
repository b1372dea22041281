/// The pages of the running daemon in headless Chromium: tests/pages/browser/check_charts.mjs zooms
/// into the charts, under the policy that the daemon sends.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "adapters/stores/open.hpp"
#include "tests/daemon/serving_daemon.hpp"

namespace recald::daemon::pages_in_browser_test {
namespace {

using namespace std::chrono_literals;
using recald::testing::ServingDaemon;
using recald::testing::write_text;

/// A year of months that were forecast, before the daemon starts.
void write_forecasts(const std::filesystem::path& file, metering::Instant now) {
  const auto opened = stores::open_checked(file, {}, now);
  ASSERT_TRUE(opened.has_value()) << opened.error().message;
  std::vector<StoredForecast> months;
  for (int month = 1; month <= 12; ++month) {
    const double mean = 1000.0 + 20.0 * month;
    months.push_back({.output = "main_daily_kWh",
                      .month = std::chrono::year{2023} / month,
                      .made = now,
                      .mean = mean,
                      .sd = 30.0,
                      .q05 = mean - 50.0,
                      .q50 = mean,
                      .q95 = mean + 50.0,
                      .measured = mean + 10.0});
  }
  ASSERT_TRUE(opened->store->add_forecasts(months).has_value());
}

TEST(PagesInBrowser, ChartsAreZoomedAndFetchFinerValues) {
  const recald::testing::TemporaryFolder folder;
  write_text(folder / "site.toml", R"([site]
id = "tower"
timezone = "America/Chicago"
interval = "15m"
units = "IP"

[[meter]]
id = "main"
source = "http"
utility = "chilled_water"

[http]
listen = "127.0.0.1:0"
)");
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  ASSERT_NO_FATAL_FAILURE(write_forecasts(folder / "site.db", now));
  ServingDaemon daemon{RECALD_PROGRAM, folder.path()};
  ASSERT_NE(daemon.port(), "") << daemon.said();
  constexpr int kDays = 12;
  const std::string taken = daemon.post(
      "/api/v1/readings",
      recald::testing::readings_json(
          metering::interval_start(now, 1h) - std::chrono::days{kDays}, 15min, 96 * kDays,
          [](int i) { return 100.0 + 40.0 * std::sin(i * 0.0654) + 5.0 * (i % 3); }));
  ASSERT_THAT(taken, ::testing::HasSubstr(" 200 "));

  const std::string command =
      RECALD_NODE " " RECALD_SOURCE_DIR
                  "/tests/pages/browser/check_charts.mjs --modules " RECALD_BROWSER_MODULES " " +
      daemon.address() + " 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) said += static_cast<char>(c);
  const int status = ::pclose(pipe);
  constexpr int kSkipped = 77;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kSkipped) GTEST_SKIP() << said;
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(daemon.end(SIGTERM), 0) << daemon.said();
}

}  // namespace
}  // namespace recald::daemon::pages_in_browser_test
