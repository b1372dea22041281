/// Against real servers on this machine: aiosmtpd and Python's web server.
#include "adapters/delivery/delivery.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <thread>

#include "tests/adapters/http/self_signed.hpp"
#include "tests/support/message_sink.hpp"

namespace recald::delivery::delivery_test {
namespace {

using recald::testing::MessageSink;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class Delivery : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!MessageSink::can_run()) GTEST_SKIP() << "the Debian package python3-aiosmtpd is absent";
  }
  void begin(const std::vector<std::string>& more = {}) {
    sink_ = std::make_unique<MessageSink>(RECALD_SOURCE_DIR "/tests/support/message_sink.py", more);
  }
  Result<void> post_to(const std::string& path, const std::string& token = "") {
    return post_json({.url = sink_->web_url(path), .token = token, .trusted_certificate = {}},
                     R"({"a": "ü"})", {});
  }
  static Mail mail() {
    return {.from = "recald@example.org",
            .to = {"ada@example.org", "bob@example.org"},
            .subject = "Größe: a meter is silent, and has been so for a rather long time now",
            .text = "Since noon.\n.\nA line with one dot is above.\n",
            .id = "depot-17",
            .date = {}};
  }

  recald::testing::TemporaryFolder folder_;
  std::unique_ptr<MessageSink> sink_;
};

TEST_F(Delivery, PostsADocument) {
  begin();
  ASSERT_TRUE(post_to("/hook?x=1", "a-token").has_value());
  const auto got = sink_->messages();
  ASSERT_THAT(got, SizeIs(1));
  EXPECT_EQ(got[0]["path"], "/hook?x=1");
  EXPECT_EQ(got[0]["authorization"], "Bearer a-token");
  EXPECT_EQ(got[0]["body"]["a"], "ü");
}

TEST_F(Delivery, PostsAnyBytesWithAUsersPassword) {
  begin();
  const auto answer = post({.url = sink_->web_url("/write?db=a"),
                            .token = {},
                            .user = "ada",
                            .password = "pass: wörd",
                            .trusted_certificate = {},
                            .content_type = "application/x-protobuf",
                            .headers = {"Content-Encoding: snappy"},
                            .body = std::string("\0\xff\n", 3)},
                           {});
  ASSERT_TRUE(answer.has_value()) << answer.error().message;
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->body, "");
  EXPECT_EQ(answer->retry_after.count(), 0);
  const auto got = sink_->messages();
  ASSERT_THAT(got, SizeIs(1));
  EXPECT_EQ(got[0]["body"], "00ff0a");
  EXPECT_EQ(got[0]["authorization"], "Basic YWRhOnBhc3M6IHfDtnJk");
  EXPECT_EQ(got[0]["headers"]["Content-Type"], "application/x-protobuf");
  EXPECT_EQ(got[0]["headers"]["Content-Encoding"], "snappy");
}

TEST_F(Delivery, AnyStatusIsAnAnswer) {
  begin();
  const auto busy = post({.url = sink_->web_url("/busy"),
                          .token = {},
                          .user = {},
                          .password = {},
                          .trusted_certificate = {},
                          .content_type = "text/plain",
                          .headers = {},
                          .body = {}},
                         {});
  ASSERT_TRUE(busy.has_value()) << busy.error().message;
  EXPECT_EQ(busy->status, 429);
  EXPECT_EQ(busy->retry_after, std::chrono::seconds{120});
  EXPECT_THAT(busy->body, AllOf(SizeIs(500), ::testing::StartsWith("too many: ...")));
}

TEST_F(Delivery, ARefusalIsAFailureWithoutTheAddress) {
  begin({"--refuse", "1"});
  const auto refused = post_to("/services/secret");
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message,
              HasSubstr("127.0.0.1 did not take the message: it answered with status 503"));
  EXPECT_THAT(refused.error().message, Not(HasSubstr("secret")));
  EXPECT_TRUE(post_to("/services/secret").has_value());
  const auto moved = post_to("/moved");
  ASSERT_FALSE(moved.has_value());
  EXPECT_THAT(moved.error().message, HasSubstr("status 302"));
  EXPECT_THAT(sink_->messages(), SizeIs(1));
}

// A machine behind a proxy, and a program on it that passes messages on.
TEST_F(Delivery, TheProxyIsNotForThisMachine) {
  begin();
  ASSERT_EQ(::setenv("http_proxy", "http://127.0.0.1:9", 1), 0);
  const auto sent = post_to("/hook");
  ASSERT_EQ(::unsetenv("http_proxy"), 0);
  EXPECT_TRUE(sent.has_value()) << sent.error().message;
}

TEST_F(Delivery, WithoutAServerItSaysSo) {
  const auto sent =
      post_json({.url = "http://127.0.0.1:9/", .token = {}, .trusted_certificate = {}}, "{}", {});
  ASSERT_FALSE(sent.has_value());
  EXPECT_EQ(sent.error().code, ErrorCode::io_failed);
  EXPECT_THAT(sent.error().message, HasSubstr("Couldn't connect to server"));
}

TEST_F(Delivery, EndsWhenItIsToldTo) {
  begin();
  std::stop_source stop;
  std::jthread stopper{[&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    stop.request_stop();
  }};
  const auto sent =
      post_json({.url = sink_->web_url("/slow"), .token = {}, .trusted_certificate = {}}, "{}",
                stop.get_token());
  ASSERT_FALSE(sent.has_value());
  EXPECT_EQ(sent.error().code, ErrorCode::cancelled);
}

TEST_F(Delivery, MailsAreReadAsTheyWereMeant) {
  begin();
  const MailServer server{.url = sink_->mail_url(),
                          .user = {},
                          .password = {},
                          .encrypts = false,
                          .trusted_certificate = {}};
  const auto sent = send_mail(server, mail(), {});
  ASSERT_TRUE(sent.has_value()) << sent.error().message;
  const auto got = sink_->messages();
  ASSERT_THAT(got, SizeIs(1));
  EXPECT_EQ(got[0]["from"], "recald@example.org");
  EXPECT_THAT(got[0]["to"], ElementsAre("ada@example.org", "bob@example.org"));
  EXPECT_EQ(got[0]["subject"], mail().subject);
  EXPECT_EQ(got[0]["id"], "<depot-17@example.org>");
  EXPECT_EQ(got[0]["text"], mail().text);
}

TEST_F(Delivery, NothingIsSentPlainWhereEncryptionIsAskedFor) {
  begin();
  const auto sent = send_mail({.url = sink_->mail_url(),
                               .user = {},
                               .password = {},
                               .encrypts = true,
                               .trusted_certificate = {}},
                              mail(), {});
  ASSERT_FALSE(sent.has_value());
  EXPECT_THAT(sink_->messages(), IsEmpty());
}

TEST_F(Delivery, AServerWithTlsAndAPassword) {
  const auto pem = recald::testing::write_self_signed(folder_.path(), "localhost");
  begin({"--tls", pem.certificate.string(), pem.key.string(), "--auth", "ada", "pass: wörd"});
  MailServer server{.url = sink_->mail_url("localhost"),
                    .user = "ada",
                    .password = "pass: wörd",
                    .encrypts = true,
                    .trusted_certificate = {}};
  const auto untrusted = send_mail(server, mail(), {});
  ASSERT_FALSE(untrusted.has_value());
  EXPECT_THAT(untrusted.error().message, HasSubstr("certificate"));
  server.trusted_certificate = pem.certificate;
  const auto sent = send_mail(server, mail(), {});
  ASSERT_TRUE(sent.has_value()) << sent.error().message;
  EXPECT_THAT(sink_->messages(), SizeIs(1));
  server.password = "another";
  const auto refused = send_mail(server, mail(), {});
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message, HasSubstr("Login denied"));
  EXPECT_THAT(sink_->messages(), SizeIs(1));
}

}  // namespace
}  // namespace recald::delivery::delivery_test
