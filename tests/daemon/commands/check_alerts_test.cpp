/// `recald check --alerts` against a real mail server and a real web server.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/daemon/command_line.hpp"
#include "tests/support/message_sink.hpp"

namespace recald::daemon {
namespace {

using recald::daemon::testing::Outcome;
using recald::daemon::testing::run;
using recald::testing::MessageSink;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class CheckAlerts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!MessageSink::can_run()) GTEST_SKIP() << "the Debian package python3-aiosmtpd is absent";
  }
  void write_secret(const std::string& name, const std::string& text) {
    write_text(folder_ / name, text);
    std::filesystem::permissions(
        folder_ / name, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  }
  Outcome check(const std::string& alerts) {
    write_text(folder_ / "site.toml",
               "[site]\nid = \"depot\"\nname = \"The depot\"\ntimezone = \"Europe/Berlin\"\n"
               "[http]\nlisten = \"127.0.0.1:0\"\n"
               "[[meter]]\nid = \"main\"\nsource = \"http\"\nutility = \"electricity\"\n" +
                   alerts);
    return run({"check", (folder_ / "site.toml").string(), "--alerts"});
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(CheckAlerts, ATrialMessageReachesEachDestination) {
  const MessageSink sink{RECALD_SOURCE_DIR "/tests/support/message_sink.py"};
  write_secret("hook-token", "a-token-of-24-characters\n");
  const Outcome outcome =
      check("[alerts]\n[[alerts.mail]]\nserver = \"" + sink.mail_url() +
            "\"\nfrom = \"recald@example.org\"\nto = [\"ada@example.org\", \"bob@example.org\"]\n"
            "[[alerts.webhook]]\nurl = \"" +
            sink.web_url("/hook") + "\"\ntoken_file = \"hook-token\"\n");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("mail to ada@example.org, bob@example.org: a trial"),
                                 HasSubstr("webhook at 127.0.0.1: a trial message was sent")));
  const auto got = sink.messages();
  ASSERT_THAT(got, SizeIs(2));
  EXPECT_EQ(got[0]["authorization"], "Bearer a-token-of-24-characters");
  EXPECT_EQ(got[0]["body"]["site"], "depot");
  EXPECT_EQ(got[1]["subject"], "The depot: a trial");
}

TEST_F(CheckAlerts, WhatDoesNotReachIsNamed) {
  write_text(folder_ / "password", "open to all");
  const Outcome outcome = check(
      "[alerts]\n[[alerts.webhook]]\nurl = \"http://127.0.0.1:9/secret\"\n"
      "[[alerts.mail]]\nserver = \"smtps://127.0.0.1:9\"\nuser = \"u\"\npassword_file = "
      "\"password\"\nfrom = \"a@example.org\"\nto = \"b@example.org\"\n");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("site.toml: webhook at 127.0.0.1: 127.0.0.1 did not "
                                           "take the message"),
                                 HasSubstr("password' can be read by others than its owner"),
                                 Not(HasSubstr("secret"))));
}

TEST_F(CheckAlerts, WithoutAnybodyToTellItSaysSo) {
  const Outcome outcome = check("");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              HasSubstr("site.toml: there is no [alerts], so there is nobody to tell"));
}

}  // namespace
}  // namespace recald::daemon
