/// The notebook of daemon/gateway/serve/notebook.md, run against a running daemon and a real
/// calibration. run_readme_notebook.py says what is checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "command_line.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/daemon/serving_daemon.hpp"

namespace recald::daemon::readme_notebook_test {
namespace {

using namespace std::chrono_literals;
using recald::testing::eventually;
using recald::testing::ServingDaemon;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;

/// @return the folder of its results.
std::string calibrate_depot(const TemporaryFolder& folder) {
  recald::testing::write_depot_year(folder / "");
  const std::string results = (folder / "out").string();
  const testing::Outcome outcome =
      testing::run({"calibrate", (folder / "site.toml").string(), "--out", results});
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  return results;
}

void write_pushed_site(const TemporaryFolder& folder) {
  write_text(folder / "site.toml", R"([site]
id = "tower"
timezone = "America/Chicago"
interval = "1h"
watermark = "2h"

[[meter]]
id = "main"
source = "http"
utility = "electricity"

[http]
listen = "127.0.0.1:0"
)");
}

/// Hours of more than three months, so that at least two whole ones have closed.
std::string readings() {
  constexpr int kHours = 24 * 100;
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return recald::testing::readings_json(
      metering::interval_start(now, 1h) - std::chrono::hours{kHours}, 1h, kHours,
      [](int i) { return 60.0 + 25.0 * std::sin(i * 0.2618) + 0.01 * i + (i % 5); });
}

TEST(ReadmeNotebook, ReadsMonthsIntervalsAndDraws) {
  if (!std::filesystem::exists(RECALD_ARVIZ "/installed")) {
    GTEST_SKIP() << "ArviZ could not be installed in " RECALD_ARVIZ;
  }
  const TemporaryFolder depot;
  const std::string results = calibrate_depot(depot);
  const TemporaryFolder folder;
  write_pushed_site(folder);
  {
    ServingDaemon daemon{RECALD_PROGRAM, folder.path()};
    ASSERT_NE(daemon.port(), "") << daemon.said();
    ASSERT_THAT(daemon.post("/api/v1/readings", readings()), ::testing::HasSubstr(" 200 "));
    ASSERT_EQ(daemon.end(SIGTERM), 0) << daemon.said();
  }
  // Months close once an hour, and at the start.
  ServingDaemon daemon{RECALD_PROGRAM, folder.path()};
  ASSERT_NE(daemon.port(), "") << daemon.said();
  const auto months = [&] { return daemon.get("/api/v1/months?meter=main"); };
  const auto usable = [&] {
    int count = 0;
    const std::string text = months();
    for (std::size_t at = 0; (at = text.find("\"usable\":true", at)) != std::string::npos; ++at) {
      ++count;
    }
    return count;
  };
  ASSERT_TRUE(eventually([&] { return usable() >= 2; })) << months();

  const std::string command = RECALD_ARVIZ "/bin/python -W ignore " RECALD_SOURCE_DIR
                                           "/tests/daemon/run_readme_notebook.py " RECALD_SOURCE_DIR
                                           "/daemon/gateway/serve/notebook.md " +
                              daemon.address() + " " + results + " 2>&1";
  const auto [status, said] = recald::testing::run_in_shell(command);
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(daemon.end(SIGTERM), 0) << daemon.said();
}

}  // namespace
}  // namespace recald::daemon::readme_notebook_test
