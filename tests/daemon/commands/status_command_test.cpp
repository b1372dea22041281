/// recald status against a server of the test's own.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "daemon/gateway/serve/api/served.hpp"
#include "tests/adapters/http/raw_client.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

using recald::daemon::testing::run;
using recald::testing::RunningServer;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kToken = "0123456789abcdef";

class StatusCommand : public ServedSite {
 protected:
  StatusCommand() { loop_.run_for(std::chrono::hours{2} + std::chrono::seconds{1}); }

  [[nodiscard]] http::Handler handler() const {
    return [this](const http::Request& request) { return answer(served_, request); };
  }
  static std::string url(const RunningServer& server) {
    return "http://127.0.0.1:" + std::to_string(server.port());
  }
  std::string token_file() {
    const auto file = folder_ / "token";
    recald::testing::write_text(file, kToken);
    using std::filesystem::perms;
    std::filesystem::permissions(file, perms::owner_read | perms::owner_write);
    return file.string();
  }
  std::string site_with(const std::string& http) {
    const auto file = folder_ / "served.toml";
    recald::testing::write_text(file, served_site() + http);
    return file.string();
  }
};

TEST_F(StatusCommand, AShortTable) {
  RunningServer server{handler()};
  const auto outcome = run({"status", "--url", url(server)});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("tower: ready"), HasSubstr("cooling"), HasSubstr("up"),
                                 HasSubstr("2024-03-30T14:00:00Z")));
}

TEST_F(StatusCommand, OneObjectForMachines) {
  RunningServer server{handler()};
  const auto outcome = run({"status", "--json", "--url", url(server)});
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["site"]["id"], "tower");
  EXPECT_EQ(json["ready"]["status"], "ready");
  EXPECT_EQ(json["meters"][1]["id"], "cooling");
}

TEST_F(StatusCommand, BySiteFileWithItsToken) {
  RunningServer server{handler(), {.access = {.tokens = {{kToken}}}}};
  const auto outcome =
      run({"status", site_with("[http]\nlisten = \"127.0.0.1:" + std::to_string(server.port()) +
                               "\"\ntoken_file = \"" + token_file() + "\"\n")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("tower: ready"));
}

TEST_F(StatusCommand, BySiteFileWithATokenThatReads) {
  RunningServer server{handler(), {.access = {.tokens = {{kToken, {http::Right::read}}}}}};
  const auto outcome =
      run({"status", site_with("[http]\nlisten = \"127.0.0.1:" + std::to_string(server.port()) +
                               "\"\n[[http.token]]\nfile = \"none\"\nrights = \"push\"\n"
                               "[[http.token]]\nfile = \"" +
                               token_file() + "\"\nrights = [\"read\"]\n")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(StatusCommand, ATokenIsAskedFor) {
  RunningServer server{handler(), {.access = {.tokens = {{kToken}}}}};
  const auto without = run({"status", "--url", url(server)});
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_THAT(without.err, HasSubstr("needs a token; name its file with --token-file"));
  EXPECT_EQ(run({"status", "--url", url(server), "--token-file", token_file()}).exit_code, 0);
}

TEST_F(StatusCommand, ADaemonThatIsNotReadySaysWhy) {
  store_.refuses = true;
  loop_.run_for(std::chrono::hours{1});
  RunningServer server{handler()};
  const auto outcome = run({"status", "--url", url(server)});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("tower: not ready"), HasSubstr("! the store refuses")));
}

TEST_F(StatusCommand, WhatDeservesALookIsShown) {
  devices_[1].exception = [](std::chrono::milliseconds) { return 2; };
  begin();
  loop_.run_for(std::chrono::hours{1});
  RunningServer server{handler()};
  const auto outcome = run({"status", "--url", url(server)});
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("tower: ready"), HasSubstr("- meter 'main' refuses")));
}

TEST_F(StatusCommand, NobodyThere) {
  std::string where;
  {
    RunningServer server{handler()};
    where = url(server);
  }
  const auto outcome = run({"status", "--url", where});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, HasSubstr("nothing answers at " + where));
}

TEST_F(StatusCommand, SomebodyElseThere) {
  RunningServer server{[](const http::Request&) -> http::Response {
    return {.content_type = "text/html", .body = "<h1>A printer</h1>"};
  }};
  const auto outcome = run({"status", "--url", url(server)});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("is not recald (status 200)"));
}

TEST_F(StatusCommand, WhatIsWrongIsSaid) {
  EXPECT_EQ(run({"status"}).exit_code, 2);
  EXPECT_EQ(run({"status", "site.toml", "--url", "http://x"}).exit_code, 2);
  const auto no_url = run({"status", "--url", "tower"});
  EXPECT_EQ(no_url.exit_code, 1);
  EXPECT_THAT(no_url.err, HasSubstr("neither http:// nor https://"));
  const auto unserved = run({"status", site_with("")});
  EXPECT_EQ(unserved.exit_code, 1);
  EXPECT_THAT(unserved.err, HasSubstr("there is no [http]"));
}

}  // namespace
}  // namespace recald::daemon
