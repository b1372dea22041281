/// What openapi.json promises, asked of the running daemon by schemathesis: it makes requests from
/// the document, right and wrong ones, and holds the answers against it.
#include <gmock/gmock.h>

#include <filesystem>

#include "core/metering/civil_time.hpp"
#include "tests/daemon/gateway/run/polled_site.hpp"
#include "tests/daemon/serving_daemon.hpp"

namespace recald::daemon::interface_test {
namespace {

using recald::testing::eventually;
using recald::testing::ServingDaemon;

using Interface = recald::testing::PolledSite;

std::string post_reading(const ServingDaemon& daemon) {
  const std::string body = R"({"meter":"chw","unit":"kWh","readings":[{"time":")" +
                           metering::to_string(std::chrono::floor<std::chrono::hours>(
                               std::chrono::system_clock::now() - std::chrono::hours{2})) +
                           R"(","value":1.5}]})";
  return daemon.post("/api/v1/readings", body);
}

TEST_F(Interface, IsWhatTheDaemonAnswers) {
  if (!std::filesystem::exists(RECALD_SCHEMATHESIS "/installed")) {
    GTEST_SKIP() << "schemathesis could not be installed in " RECALD_SCHEMATHESIS;
  }
  recald::testing::write_text(folder_ / "site.toml",
                              recald::testing::read_text(folder_ / "site.toml") +
                                  "[[meter]]\nid = \"chw\"\nsource = \"http\"\n"
                                  "utility = \"chilled_water\"\n"
                                  "[http]\nlisten = \"127.0.0.1:0\"\n");
  ServingDaemon daemon{RECALD_PROGRAM, folder_.path()};
  ASSERT_NE(daemon.port(), "") << daemon.said();
  ASSERT_TRUE(eventually([&] { return post_reading(daemon).find(" 200 ") != std::string::npos; }));
  // A valid request may still be refused: a cursor or an id is text to the document. And a POST
  // that is not declared as JSON is refused before anybody looks where it goes.
  const std::string command = "cd " + folder_.path().string() +
                              " && " RECALD_SCHEMATHESIS "/bin/schemathesis run " +
                              daemon.address() +
                              "/api/v1/openapi.json --seed 1 --max-examples 25 --no-color "
                              "--phases examples,coverage,fuzzing --checks all --exclude-checks "
                              "positive_data_acceptance,unsupported_method "
                              "2>&1";
  const auto [status, said] = recald::testing::run_in_shell(command);
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(daemon.end(SIGTERM), 0) << daemon.said();
}

}  // namespace
}  // namespace recald::daemon::interface_test
