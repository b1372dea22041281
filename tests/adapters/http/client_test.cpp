/// Client and server together, with and without TLS.
#include "adapters/http/client.hpp"

#include <gmock/gmock.h>

#include "tests/adapters/http/raw_client.hpp"
#include "tests/adapters/http/self_signed.hpp"
#include "tests/support/scripted_device.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::http {
namespace {

using namespace std::chrono_literals;
using recald::testing::Bytes;
using recald::testing::Piece;
using recald::testing::RawClient;
using recald::testing::RunningServer;
using recald::testing::ScriptedServer;
using recald::testing::TemporaryFolder;
using recald::testing::write_self_signed;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Response say_path(const Request& request) {
  return {.content_type = "text/plain",
          .body = request.path + "|" + std::string{request.header("host")}};
}

Url url_of(std::uint16_t port, bool is_tls = false) {
  return {.is_tls = is_tls, .host = "127.0.0.1", .port = port, .path = "/a"};
}

TEST(Client, GetsAnAnswer) {
  RunningServer server{say_path};
  const auto response = get(url_of(server.port()));
  ASSERT_TRUE(response.has_value()) << response.error().message;
  EXPECT_EQ(response->status, 200);
  EXPECT_EQ(response->content_type, "text/plain");
  EXPECT_EQ(response->body, "/a|127.0.0.1:" + std::to_string(server.port()));
}

TEST(Client, SendsItsToken) {
  RunningServer server{say_path, {.access = {.tokens = {{"0123456789abcdef"}}}}};
  EXPECT_EQ(get(url_of(server.port()), {.token = "0123456789abcdef"})->status, 200);
  EXPECT_EQ(get(url_of(server.port()))->status, 401);
}

TEST(Client, NobodyThere) {
  std::uint16_t port = 0;
  {
    RunningServer server{say_path};
    port = server.port();
  }
  const auto response = get(url_of(port));
  ASSERT_FALSE(response.has_value());
  EXPECT_EQ(response.error().code, ErrorCode::not_found);
  EXPECT_THAT(response.error().message, HasSubstr("nothing answers at http://127.0.0.1:"));
}

TEST(Client, WhoNeverAnswersIsGivenUp) {
  ScriptedServer server{[](const Bytes&, int) { return std::vector<Piece>{}; }};
  const auto response = get(url_of(server.port()), {.timeout = 100ms});
  ASSERT_FALSE(response.has_value());
  EXPECT_EQ(response.error().code, ErrorCode::io_failed);
}

TEST(Client, WhatIsNoHttpIsTold) {
  ScriptedServer server{[](const Bytes&, int) {
    return std::vector<Piece>{{0ms, {'S', 'S', 'H', '-', '2', '\r', '\n'}}};
  }};
  const auto response = get(url_of(server.port()));
  ASSERT_FALSE(response.has_value());
  EXPECT_EQ(response.error().code, ErrorCode::io_failed);
}

class TlsTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  http::TlsFiles files_ = write_self_signed(folder_.path(), "tower");
};

TEST_F(TlsTest, ACertificateThatIsTrusted) {
  RunningServer server{say_path, {.tls = files_}};
  const auto response =
      get(url_of(server.port(), true), {.trusted_certificate = files_.certificate});
  ASSERT_TRUE(response.has_value()) << response.error().message;
  EXPECT_EQ(response->status, 200);
}

TEST_F(TlsTest, AnotherCertificateIsNot) {
  RunningServer server{say_path, {.tls = files_}};
  const auto other = write_self_signed(folder_.path(), "other");
  const auto response =
      get(url_of(server.port(), true), {.trusted_certificate = other.certificate});
  ASSERT_FALSE(response.has_value());
  EXPECT_THAT(response.error().message, HasSubstr("certificate problem"));
  EXPECT_FALSE(get(url_of(server.port(), true)).has_value());  // nor does the system know it
}

// Certificates end and are renewed by others; nobody restarts a gateway for it.
TEST_F(TlsTest, WhoComesAfterARenewalGetsTheNewCertificate) {
  RunningServer server{say_path, {.tls = files_}};
  const auto renewed = write_self_signed(folder_.path(), "renewed");
  const auto answers = [&](const http::TlsFiles& trusted) {
    return get(url_of(server.port(), true), {.trusted_certificate = trusted.certificate})
        .has_value();
  };
  EXPECT_TRUE(answers(files_));
  EXPECT_FALSE(answers(renewed));
  auto tls = read_tls(renewed);
  ASSERT_TRUE(tls.has_value()) << tls.error().message;
  server.on_loop([&](Server& running) { running.set_tls(std::move(*tls)); });
  EXPECT_TRUE(answers(renewed));
  EXPECT_FALSE(answers(files_));
}

TEST_F(TlsTest, RefusalsArriveToo) {
  RunningServer server{say_path, {.access = {.tokens = {{"0123456789abcdef"}}}, .tls = files_}};
  const auto response =
      get(url_of(server.port(), true), {.trusted_certificate = files_.certificate});
  ASSERT_TRUE(response.has_value()) << response.error().message;
  EXPECT_EQ(response->status, 401);
}

TEST_F(TlsTest, WhoSpeaksPlainHttpIsCutOff) {
  RunningServer server{say_path, {.tls = files_}};
  RawClient client{server.port()};
  client.send("GET /a HTTP/1.1\r\n\r\n");
  EXPECT_THAT(client.everything(), ::testing::Not(HasSubstr("HTTP/1.1")));
}

// A ClientHello that offers TLS 1.1 at most, as an old device would send it.
TEST_F(TlsTest, OldVersionsAreRefused) {
  RunningServer server{say_path, {.tls = files_}};
  RawClient client{server.port()};
  std::string hello("\x16\x03\x01\x00\x2F\x01\x00\x00\x2B\x03\x02", 11);  // record, hello, 1.1
  hello += std::string(32, 'r') + std::string("\0\0\x04\xC0\x0A\xC0\x09\x01\0", 9);
  client.send(hello);
  const std::string answer = client.everything();
  ASSERT_GE(answer.size(), 7u);
  EXPECT_EQ(answer[0], '\x15');  // an alert,
  EXPECT_EQ(answer[6], '\x46');  // protocol_version
}

TEST_F(TlsTest, AKeyOfAnotherCertificateIsNoticed) {
  const auto other = write_self_signed(folder_.path(), "other");
  boost::asio::io_context context;
  const auto server = Server::listen(
      context, {.port = 0, .tls = TlsFiles{files_.certificate, other.key}}, say_path);
  ASSERT_FALSE(server.has_value());
  EXPECT_THAT(server.error().message, HasSubstr("other.key' cannot be used"));
}

}  // namespace
}  // namespace recald::http
