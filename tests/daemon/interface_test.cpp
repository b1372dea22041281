/// What openapi.json promises, asked of the running daemon by schemathesis: it makes requests from
/// the document, right and wrong ones, and holds the answers against it.
#include <gmock/gmock.h>

#include <boost/asio/ip/tcp.hpp>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "core/metering/civil_time.hpp"
#include "tests/daemon/gateway/run/polled_site.hpp"
#include "tests/support/background_process.hpp"

namespace recald::daemon::interface_test {
namespace {

using recald::testing::BackgroundProcess;
using recald::testing::eventually;

class Interface : public recald::testing::PolledSite {
 protected:
  [[nodiscard]] std::string what_was_said() const {
    const auto file = folder_ / "said.txt";
    return std::filesystem::exists(file) ? recald::testing::read_text(file) : "";
  }
  /// Empty until the daemon listens.
  [[nodiscard]] std::string port() const {
    const std::string text = what_was_said();
    const std::size_t at = text.rfind(" port=");
    return at == std::string::npos ? "" : text.substr(at + 6, text.find('\n', at) - at - 6);
  }
  [[nodiscard]] std::string post_reading() const {
    const std::string body = R"({"meter":"chw","unit":"kWh","readings":[{"time":")" +
                             metering::to_string(std::chrono::floor<std::chrono::hours>(
                                 std::chrono::system_clock::now() - std::chrono::hours{2})) +
                             R"(","value":1.5}]})";
    boost::asio::ip::tcp::iostream server{"127.0.0.1", port()};
    server << "POST /api/v1/readings HTTP/1.1\r\nHost: x\r\nConnection: close\r\n"
              "Content-Type: application/json\r\nContent-Length: "
           << body.size() << "\r\n\r\n"
           << body << std::flush;
    return {std::istreambuf_iterator{server}, {}};
  }
};

TEST_F(Interface, IsWhatTheDaemonAnswers) {
  if (!std::filesystem::exists(RECALD_SCHEMATHESIS "/installed")) {
    GTEST_SKIP() << "schemathesis could not be installed in " RECALD_SCHEMATHESIS;
  }
  recald::testing::write_text(folder_ / "site.toml",
                              recald::testing::read_text(folder_ / "site.toml") +
                                  "[[meter]]\nid = \"chw\"\nsource = \"http\"\n"
                                  "utility = \"chilled_water\"\n"
                                  "[http]\nlisten = \"127.0.0.1:0\"\n");
  BackgroundProcess daemon{{RECALD_PROGRAM, "run", (folder_ / "site.toml").string()},
                           folder_ / "said.txt"};
  ASSERT_TRUE(eventually([&] { return !port().empty(); })) << what_was_said();
  ASSERT_TRUE(eventually([&] { return post_reading().find(" 200 ") != std::string::npos; }));
  // A valid request may still be refused: a cursor or an id is text to the document. And a POST
  // that is not declared as JSON is refused before anybody looks where it goes.
  const std::string command = "cd " + folder_.path().string() +
                              " && " RECALD_SCHEMATHESIS
                              "/bin/schemathesis run "
                              "http://127.0.0.1:" +
                              port() +
                              "/api/v1/openapi.json --seed 1 --max-examples 25 --no-color "
                              "--phases examples,coverage,fuzzing --checks all --exclude-checks "
                              "positive_data_acceptance,unsupported_method "
                              "2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) said += static_cast<char>(c);
  EXPECT_EQ(::pclose(pipe), 0) << said;
  EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
}

}  // namespace
}  // namespace recald::daemon::interface_test
