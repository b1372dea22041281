/// A session over a stream in memory that fails at the n-th operation, or ends at the n-th byte.
#include "adapters/http/session.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/_experimental/test/stream.hpp>

namespace recald::http {
namespace {

using boost::beast::test::connect;
using boost::beast::test::fail_count;
using boost::beast::test::stream;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::string kTwoRequests =
    "POST /first HTTP/1.1\r\nHost: a\r\nContent-Type: application/json\r\n"
    "Content-Length: 2\r\n\r\n{}"
    "GET /last HTTP/1.1\r\nHost: a\r\n\r\n";
const std::size_t kFirstLength = kTwoRequests.find("GET /last");

class SessionTest : public ::testing::Test {
 protected:
  /// Lets the session run until it waits for the client or has ended.
  void serve(stream& server, stream& client) {
    Session<stream> session{server, rules_, handler_, turns_};
    context_.restart();
    boost::asio::co_spawn(
        context_, [&]() -> boost::asio::awaitable<void> { co_await session.run(); },
        [&](std::exception_ptr thrown) {
          has_ended_ = true;
          has_thrown_ = thrown != nullptr;
        });
    context_.poll();
    client.close();  // whatever still waits ends with it
    context_.restart();
    context_.poll();
  }

  boost::asio::io_context context_;
  SessionRules rules_;
  Turns turns_{std::chrono::hours{1}};  // no pauses: the loop is only polled
  std::vector<std::string> handled_;
  Handler handler_ = [this](const Request& request) -> Response {
    handled_.push_back(request.path);
    return {.content_type = "text/plain", .body = request.path};
  };
  bool has_ended_ = false;
  bool has_thrown_ = false;
};

// No failure at any operation throws, hangs or has a request handled that did not come whole.
TEST_F(SessionTest, TheNthOperationFailsUntilARunPasses) {
  std::string answered;
  std::size_t n = 0;
  for (; handled_.size() < 2 || !answered.ends_with("/last"); ++n) {
    ASSERT_LT(n, 100u);
    SCOPED_TRACE(n);
    fail_count failing{n};
    stream server{context_, failing};
    stream client = connect(server);
    server.append(kTwoRequests);
    handled_.clear();
    has_ended_ = false;
    serve(server, client);
    EXPECT_TRUE(has_ended_);
    EXPECT_FALSE(has_thrown_);
    ASSERT_LE(handled_.size(), 2u);
    answered = std::string{client.str()};
  }
  EXPECT_GT(n, 3u);  // reads and writes of both requests have failed before
}

TEST_F(SessionTest, ARequestThatIsCutAtAnyByteIsNotHandled) {
  for (std::size_t length = 0; length <= kTwoRequests.size(); ++length) {
    SCOPED_TRACE(length);
    stream server{context_};
    stream client = connect(server);
    server.append(kTwoRequests.substr(0, length));
    client.close();
    handled_.clear();
    has_ended_ = false;
    serve(server, client);
    EXPECT_TRUE(has_ended_);
    EXPECT_FALSE(has_thrown_);
    const std::size_t whole = length == kTwoRequests.size() ? 2 : length >= kFirstLength ? 1 : 0;
    EXPECT_THAT(handled_, SizeIs(whole));
  }
}

TEST_F(SessionTest, ARequestThatDripsIsTheSame) {
  stream server{context_};
  server.read_size(1);
  stream client = connect(server);
  server.append(kTwoRequests);
  serve(server, client);
  EXPECT_THAT(handled_, ::testing::ElementsAre("/first", "/last"));
  EXPECT_THAT(std::string{client.str()}, EndsWith("/last"));
}

TEST_F(SessionTest, NothingIsHandledAfterTheEndHasBegun) {
  rules_.is_stopping = true;
  stream server{context_};
  stream client = connect(server);
  server.append(kTwoRequests);
  serve(server, client);
  EXPECT_TRUE(has_ended_);
  EXPECT_THAT(handled_, SizeIs(0));
}

TEST_F(SessionTest, WhatFollowsARefusalIsNotARequest) {
  stream server{context_};
  stream client = connect(server);
  server.append("GET /%zz HTTP/1.1\r\n\r\n" + kTwoRequests);
  serve(server, client);
  EXPECT_THAT(handled_, SizeIs(0));
  EXPECT_THAT(std::string{client.str()}, HasSubstr("HTTP/1.1 400 "));
}

std::string asked_from(const std::string& origin) {
  return "OPTIONS /first HTTP/1.1\r\nHost: a\r\nOrigin: " + origin +
         "\r\nAccess-Control-Request-Method: GET\r\n\r\n";
}

// A browser asks before it sends what a page of another origin wants to send.
TEST_F(SessionTest, PagesOfOtherOriginsMayAskOnlyIfTheyAreAllowed) {
  rules_.access.tokens = {{"0123456789abcdef"}};
  rules_.origins = {"https://bms.example.org"};
  const auto answer_to = [&](const std::string& request) {
    stream server{context_};
    stream client = connect(server);
    server.append(request);
    serve(server, client);
    return std::string{client.str()};
  };
  const std::string allowed = answer_to(asked_from("https://bms.example.org"));
  EXPECT_THAT(allowed, HasSubstr("HTTP/1.1 204"));
  EXPECT_THAT(allowed, HasSubstr("Access-Control-Allow-Origin: https://bms.example.org"));
  EXPECT_THAT(answer_to(asked_from("https://evil.example.org")),
              ::testing::AllOf(HasSubstr("HTTP/1.1 401"),
                               ::testing::Not(HasSubstr("Access-Control-Allow-Origin"))));
  const std::string get =
      "GET /last HTTP/1.1\r\nHost: a\r\nOrigin: https://bms.example.org\r\n"
      "Authorization: Bearer 0123456789abcdef\r\n\r\n";
  EXPECT_THAT(answer_to(get), HasSubstr("Access-Control-Allow-Origin: https://bms.example.org"));
  // And why it was refused.
  EXPECT_THAT(answer_to("GET /last HTTP/1.1\r\nHost: a\r\nOrigin: https://bms.example.org\r\n\r\n"),
              ::testing::AllOf(HasSubstr("HTTP/1.1 401"),
                               HasSubstr("Access-Control-Allow-Origin: https://bms.example.org")));
  rules_.origins.clear();
  EXPECT_THAT(answer_to(get),
              ::testing::AllOf(HasSubstr("200 OK"), ::testing::Not(HasSubstr("Access-Control"))));
}

}  // namespace
}  // namespace recald::http
