/// The server on real sockets, against clients of every kind.
#include "adapters/http/server.hpp"

#include <gmock/gmock.h>

#include <atomic>

#include "adapters/http/client.hpp"
#include "tests/adapters/http/raw_client.hpp"
#include "tests/adapters/http/self_signed.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::http {
namespace {

using namespace std::chrono_literals;
using recald::testing::RawClient;
using recald::testing::RunningServer;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// Says what it was asked.
class ServerTest : public ::testing::Test {
 protected:
  Handler echo() {
    return [this](const Request& request) -> Response {
      ++handled_;
      if (request.path == "/throws") throw std::runtime_error("on purpose");
      std::string text = request.path;
      for (const auto& [name, value] : request.query) text += " " + name + "=" + value;
      return {.content_type = "text/plain", .body = text + "|" + request.body};
    };
  }

  std::atomic<int> handled_{0};
};

constexpr const char* kPostHead =
    "POST /r HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";

TEST_F(ServerTest, AnswersOneRequestAfterTheOther) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send("GET /a%20b?x=1&y=%2B HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(client.answer(), AllOf(StartsWith("HTTP/1.1 200 OK\r\n"), EndsWith("/a b x=1 y=+|")));
  client.send(std::string{kPostHead} + "Content-Length: 4\r\n\r\n{  }");
  EXPECT_THAT(client.answer(), EndsWith("\r\n\r\n/r|{  }"));
  EXPECT_EQ(handled_, 2);
}

TEST_F(ServerTest, RequestsMayComeTogether) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send(
      "GET /1 HTTP/1.1\r\nHost: localhost\r\n\r\nGET /2 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(client.answer(), EndsWith("\r\n\r\n/1|"));
  EXPECT_THAT(client.answer(), EndsWith("\r\n\r\n/2|"));
}

TEST_F(ServerTest, EachMethodArrivesAsItself) {
  RunningServer server{[](const Request& request) -> Response {
    return {.content_type = "text/plain", .body = std::to_string(static_cast<int>(request.method))};
  }};
  const auto arrived_as = [&](const std::string& method) {
    RawClient client{server.port()};
    client.send(method + " /jobs/7 HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::string answer = client.answer();
    return std::stoi(answer.substr(answer.rfind('\n') + 1));
  };
  EXPECT_EQ(arrived_as("GET"), static_cast<int>(Method::get));
  EXPECT_EQ(arrived_as("DELETE"), static_cast<int>(Method::remove));
  EXPECT_EQ(arrived_as("PUT"), static_cast<int>(Method::other));
}

TEST_F(ServerTest, AHeadIsAnswerWithoutBody) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send("HEAD /abc HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(client.everything(), AllOf(HasSubstr("Content-Length: 5\r\n"), EndsWith("\r\n\r\n")));
}

TEST_F(ServerTest, WhoAsksForTheEndGetsIt) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send("GET /a HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(client.everything(), AllOf(HasSubstr("Connection: close"), EndsWith("/a|")));
}

TEST_F(ServerTest, WhatIsNoRequestIsTold) {
  RunningServer server{echo()};
  for (const char* wrong :
       {"\x16\x03\x01 GET\r\n\r\n", "GET /a%zz HTTP/1.1\r\nHost: localhost\r\n\r\n",
        "GET /a HTTP/9.9\r\n\r\n", "GET /a HTTP/1.1\r\nbad header\r\n\r\n",
        "POST /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: x\r\n\r\n"}) {
    RawClient client{server.port()};
    client.send(wrong);
    EXPECT_THAT(client.everything(),
                AllOf(StartsWith("HTTP/1.1 400 "), HasSubstr("{\"error\":{\"code\":\"malformed\"")))
        << wrong;
  }
  EXPECT_EQ(handled_, 0);
}

TEST_F(ServerTest, ABodyOverTheLimitIsRefusedBeforeItComes) {
  RunningServer server{echo(), {.body_max = 1000}};
  RawClient told{server.port()};
  told.send(std::string{kPostHead} + "Content-Length: 1001\r\n\r\n");  // and none of it
  EXPECT_THAT(told.answer(), AllOf(StartsWith("HTTP/1.1 413 "), HasSubstr("too_large")));
  RawClient chunked{server.port()};
  chunked.send(std::string{kPostHead} + "Transfer-Encoding: chunked\r\n\r\n3E9\r\n" +
               std::string(1001, ' ') + "\r\n0\r\n\r\n");
  EXPECT_THAT(chunked.answer(), StartsWith("HTTP/1.1 413 "));
  EXPECT_EQ(handled_, 0);
  RawClient just_so{server.port()};
  just_so.send(std::string{kPostHead} + "Content-Length: 1000\r\n\r\n" + std::string(1000, ' '));
  EXPECT_THAT(just_so.answer(), StartsWith("HTTP/1.1 200 "));
}

// The client is still sending when the answer is on its way: a reset would take it back.
TEST_F(ServerTest, WhoSendsTooMuchCanReadWhy) {
  RunningServer server{echo(), {.body_max = 1024 * 1024}};
  RawClient client{server.port()};
  client.send(std::string{kPostHead} + "Content-Length: 1500000\r\n\r\n");
  client.send(std::string(1'500'000, ' '));
  EXPECT_THAT(client.everything(), AllOf(StartsWith("HTTP/1.1 413 "), HasSubstr("too_large")));
}

TEST_F(ServerTest, AHeaderOverTheLimitIsRefused) {
  RunningServer server{echo(), {.header_max = 1000}};
  RawClient client{server.port()};
  client.send("GET /a HTTP/1.1\r\nHost: localhost\r\nCookie: " + std::string(1000, 'a') +
              "\r\n\r\n");
  EXPECT_THAT(client.everything(), StartsWith("HTTP/1.1 431 "));
  EXPECT_EQ(handled_, 0);
}

TEST_F(ServerTest, WhoAsksWhetherToGoOnIsTold) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send(std::string{kPostHead} + "Content-Length: 2\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_THAT(client.answer(), StartsWith("HTTP/1.1 100 Continue\r\n"));
  client.send("{}");
  EXPECT_THAT(client.answer(), EndsWith("\r\n\r\n/r|{}"));
}

TEST_F(ServerTest, WhoIsSlowIsCutOff) {
  RunningServer server{echo(), {.slow_client = 50ms}};
  for (const char* part :
       {"", "GET /a HTT",
        "POST /r HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        "Content-Length: 9\r\n\r\n{"}) {
    RawClient client{server.port()};
    client.send(part);
    EXPECT_THAT(client.everything(), IsEmpty()) << part;
  }
  EXPECT_EQ(handled_, 0);
}

TEST_F(ServerTest, SoManyConnectionsAndNoMore) {
  RunningServer server{echo(), {.connections_max = 2}};
  const std::string half =
      std::string{kPostHead} + "Content-Length: 2\r\n" + "Expect: 100-continue\r\n\r\n";
  RawClient first{server.port()};
  auto second = std::make_unique<RawClient>(server.port());
  first.send(half);
  second->send(half);
  EXPECT_THAT(first.answer(), StartsWith("HTTP/1.1 100 "));
  EXPECT_THAT(second->answer(), StartsWith("HTTP/1.1 100 "));
  RawClient third{server.port()};
  EXPECT_THAT(third.answer(), AllOf(StartsWith("HTTP/1.1 503 "), HasSubstr("Retry-After: 1\r\n")));
  first.send("{}");  // whoever is being served stays
  EXPECT_THAT(first.answer(), StartsWith("HTTP/1.1 200 "));
  second.reset();
  EXPECT_TRUE(recald::testing::eventually([&] {
    RawClient next{server.port()};
    next.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
    return next.answer().starts_with("HTTP/1.1 200 ");
  }));
}

// A proxy or a browser keeps connections open and asks nothing; a supervisor's probe must get in.
TEST_F(ServerTest, IdleConnectionsDoNotShutOutAProbe) {
  RunningServer server{echo(), {.connections_max = 64}};
  const char* request = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 64; ++i) idle.push_back(std::make_unique<RawClient>(server.port()));
  for (const int asked : {0, 1}) {  // these have been answered since, so they wait less long
    idle[asked]->send(request);
    EXPECT_THAT(idle[asked]->answer(), StartsWith("HTTP/1.1 200 "));
  }
  RawClient probe{server.port()};
  probe.send(request);
  EXPECT_THAT(probe.answer(), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(idle[2]->everything(), IsEmpty());  // the one that had waited longest
  for (const int asked : {0, 1, 3}) {
    idle[asked]->send(request);
    EXPECT_THAT(idle[asked]->answer(), StartsWith("HTTP/1.1 200 ")) << asked;
  }
}

TEST_F(ServerTest, SilentTlsClientsDoNotShutOutAProbe) {
  const recald::testing::TemporaryFolder folder;
  const auto tls = recald::testing::write_self_signed(folder.path(), "tower");
  RunningServer server{echo(), {.tls = TlsFiles{tls.certificate, tls.key}, .connections_max = 4}};
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 8; ++i) silent.push_back(std::make_unique<RawClient>(server.port()));
  const auto probe = get({.is_tls = true, .port = server.port(), .path = "/healthz"},
                         {.trusted_certificate = tls.certificate});
  ASSERT_TRUE(probe.has_value()) << probe.error().message;
  EXPECT_EQ(probe->status, 200);
}

// 64 clients that had their refusal and stay, or send half a body, or do not receive.
TEST_F(ServerTest, ClientsThatStayInAnyStateShutNobodyOut) {
  const std::string big(4'000'000, 'x');
  const Handler handler = [&](const Request& request) {
    return request.path == "/healthz" ? Response{.body = "ok"} : Response{.body = big};
  };
  for (const char* what :
       {"GET /%zz HTTP/1.1\r\nHost: localhost\r\n\r\n", "GET /a HTTP/1.1\r\nHost: ",
        "POST /a HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json"
        "\r\nContent-Length: 1000\r\n\r\n{",
        "GET /big HTTP/1.1\r\nHost: localhost\r\n\r\n"}) {
    RunningServer server{handler, {.connections_max = 8}};
    std::vector<std::unique_ptr<RawClient>> staying;
    for (int i = 0; i < 8; ++i) {
      staying.push_back(std::make_unique<RawClient>(server.port()));
      staying.back()->send(what);
    }
    const auto is_well = [&] {
      const auto probe = get({.port = server.port(), .path = "/healthz"}, {});
      return probe.has_value() && probe->status == 200;
    };
    // Who sends or receives is left alone for a second.
    EXPECT_TRUE(recald::testing::eventually(is_well)) << what;
    EXPECT_TRUE(is_well() && is_well()) << what;
  }
}

// Each page takes a while, and there is always another client that asks for one.
TEST_F(ServerTest, SlowAnswersDoNotKeepAProbeWaiting) {
  std::atomic<int> pages{0};
  const Handler handler = [&](const Request& request) {
    if (request.path == "/healthz") return Response{.body = "ok"};
    std::this_thread::sleep_for(std::chrono::milliseconds{40});
    ++pages;
    return Response{.body = "page"};
  };
  RunningServer server{handler, {.prompt_paths = {"/healthz"}}};
  std::atomic<bool> is_over{false};
  std::vector<std::jthread> readers;
  for (int i = 0; i < 40; ++i) {
    readers.emplace_back([&] {
      while (!is_over) (void)get({.port = server.port(), .path = "/page"}, {});
    });
  }
  ASSERT_TRUE(recald::testing::eventually([&] { return pages > 2; }));
  const int before = pages;
  int probes = 0;
  while (pages < before + 25) {
    const auto probe = get({.port = server.port(), .path = "/healthz"}, {});
    ASSERT_TRUE(probe.has_value()) << probe.error().message;
    ++probes;
  }
  is_over = true;
  EXPECT_GT(probes, 25);  // in a queue with the pages it would be one in forty of them
}

// What a browser sends once the name of somebody's page points to this machine.
TEST_F(ServerTest, OnLoopbackItIsAskedByItsNamesAlone) {
  RunningServer server{echo(), {.access = {.names = {"tower.example.org"}}}};
  const auto status_of = [&](const std::string& head) {
    RawClient client{server.port()};
    client.send("GET /a HTTP/1.1\r\n" + head + "\r\n");
    return client.answer().substr(9, 3);
  };
  for (const char* ours : {"localhost", "LocalHost:8080", "127.0.0.1", "127.1.2.3:1", "[::1]:8080",
                           "tower.example.org", "Tower.Example.Org.:443", "a.localhost"}) {
    EXPECT_EQ(status_of(std::string{"Host: "} + ours + "\r\n"), "200") << ours;
  }
  for (const char* other : {"evil.example", "localhost.evil.example:8080", "127.0.0.1.evil.example",
                            "10.0.0.1", "tower.example.org.evil.example", "[2001:db8::1]", "127.1",
                            "2130706433", "x.tower.example.org"}) {
    EXPECT_EQ(status_of(std::string{"Host: "} + other + "\r\n"), "421") << other;
  }
  EXPECT_EQ(status_of(""), "400");
  EXPECT_EQ(status_of("Host: localhost\r\nHost: localhost\r\n"), "400");
}

// With a proxy in front that reads it otherwise, the body would be a request of its own.
TEST_F(ServerTest, WhatCanBeReadAsTwoRequestsIsReadAsNone) {
  RunningServer server{echo()};
  const std::string post =
      "POST /r HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  const std::string hidden = "GET /hidden HTTP/1.1\r\nHost: localhost\r\n\r\n";
  for (const char* wrong :
       {"Transfer-Encoding: gzip\r\n", "Transfer-Encoding: xchunked\r\n",
        "Transfer-Encoding: gzip, chunked\r\n", "Transfer-Encoding: chunked, gzip\r\n",
        "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n",
        "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", "Transfer-Encoding:\r\n chunked\r\n",
        "X-Folded: a\r\n b\r\n", "X-Folded: a\r\n\tb\r\n",
        "Content-Length: 5\r\nContent-Length: 6\r\n"}) {
    RawClient client{server.port()};
    client.send(post + wrong + "\r\n" + hidden);
    const std::string answer = client.answer();
    EXPECT_THAT(answer, AllOf(StartsWith("HTTP/1.1 400 "), HasSubstr("Connection: close")))
        << wrong;
    EXPECT_THAT(answer, ::testing::Not(HasSubstr("HTTP/1.1 200"))) << wrong;
  }
  EXPECT_EQ(handled_, 0);
  RawClient chunked{server.port()};
  chunked.send(post + "Transfer-Encoding: Chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n");
  EXPECT_THAT(chunked.answer(), StartsWith("HTTP/1.1 200 "));
}

TEST_F(ServerTest, ATokenMayHaveFewerRights) {
  const std::string all = "all-0123456789abcdef", reads = "read-0123456789abcdef",
                    pushes = "push-0123456789abcdef", both = "both-0123456789abcdef";
  RunningServer server{echo(),
                       {.access = {.tokens = {{all},
                                              {reads, {Right::read}},
                                              {pushes, {Right::push}},
                                              {both, {Right::read, Right::push}}},
                                   .push_paths = {"/readings"}}}};
  const auto status_of = [&](const std::string& line, const std::string& token) {
    RawClient client{server.port()};
    client.send(line + " HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " + token +
                "\r\nContent-Type: application/json\r\nContent-Length: 2\r\n\r\n{}");
    return client.answer().substr(9, 3);
  };
  const auto statuses = [&](const std::string& line) {
    std::string found;
    for (const auto& token : {all, reads, pushes, both}) found += status_of(line, token) + " ";
    return found;
  };
  EXPECT_EQ(statuses("GET /a"), "200 200 403 200 ");
  EXPECT_EQ(statuses("POST /readings"), "200 403 200 200 ");
  EXPECT_EQ(statuses("POST /model"), "200 403 403 403 ");
  EXPECT_EQ(statuses("DELETE /jobs/1"), "200 403 403 403 ");
  EXPECT_EQ(status_of("GET /a", "none-0123456789abcdef"), "401");
}

TEST_F(ServerTest, TheTokenIsAskedForBeforeTheBody) {
  RunningServer server{echo(),
                       {.access = {.tokens = {{"0123456789abcdef"}}, .open_paths = {"/healthz"}}}};
  RawClient without{server.port()};
  without.send(std::string{kPostHead} + "Content-Length: 1000\r\n\r\n");
  EXPECT_THAT(without.answer(),
              AllOf(StartsWith("HTTP/1.1 401 "), HasSubstr("WWW-Authenticate: Bearer"),
                    HasSubstr("WWW-Authenticate: Basic"), HasSubstr("token_file")));
  EXPECT_EQ(handled_, 0);
  RawClient with{server.port()};
  with.send("GET /a HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer 0123456789abcdef\r\n\r\n");
  EXPECT_THAT(with.answer(), StartsWith("HTTP/1.1 200 "));
  RawClient open{server.port()};
  open.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(open.answer(), StartsWith("HTTP/1.1 200 "));
  server.on_loop([](Server& running) { running.set_tokens({{"fedcba9876543210"}}); });
  with.send("GET /a HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer 0123456789abcdef\r\n\r\n");
  EXPECT_THAT(with.answer(), StartsWith("HTTP/1.1 401 "));
}

// A web page of any origin can make a browser send a form to a loopback address, but not as JSON.
TEST_F(ServerTest, APostCallsItselfJson) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send(
      "POST /r HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/plain\r\nContent-Length: "
      "2\r\n\r\n{}");
  EXPECT_THAT(client.answer(), StartsWith("HTTP/1.1 415 "));
  EXPECT_EQ(handled_, 0);
}

TEST_F(ServerTest, AHandlerThatThrowsIsSurvived) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send("GET /throws HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(client.answer(), AllOf(StartsWith("HTTP/1.1 500 "), Not(HasSubstr("on purpose"))));
  client.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(client.answer(), StartsWith("HTTP/1.1 200 "));
}

TEST_F(ServerTest, StopEndsConnectionsToo) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(client.answer(), StartsWith("HTTP/1.1 200 "));
  server.on_loop([](Server& running) { running.stop(); });
  EXPECT_THAT(client.everything(), IsEmpty());
  EXPECT_THROW(RawClient{server.port()}, std::runtime_error);
}

TEST_F(ServerTest, HeadersThatAWholeAnswerHas) {
  RunningServer server{echo()};
  RawClient client{server.port()};
  client.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string first = client.answer();
  EXPECT_THAT(first, HasSubstr("Content-Security-Policy: default-src 'self'"));
  const std::size_t tag = first.find("W/\"");
  ASSERT_NE(tag, std::string::npos) << first;
  client.send("GET /a HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: " +
              first.substr(tag, first.find('\r', tag) - tag) + "\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(client.everything(),
              AllOf(StartsWith("HTTP/1.1 304 Not Modified\r\n"), EndsWith("\r\n\r\n")));
}

class ListenTest : public ::testing::Test {
 protected:
  std::string why_not(const ServerOptions& options) {
    const auto server =
        Server::listen(context_, options, [](const Request&) { return Response{}; });
    return server ? "it listens" : server.error().message;
  }
  boost::asio::io_context context_{1};
};

TEST_F(ListenTest, OthersNeedATokenAndTls) {
  EXPECT_THAT(why_not({.address = "0.0.0.0", .port = 0}), HasSubstr("a token and TLS are needed"));
  EXPECT_THAT(
      why_not({.address = "0.0.0.0", .port = 0, .access = {.tokens = {{"0123456789abcdef"}}}}),
      HasSubstr("a token and TLS are needed"));
  EXPECT_THAT(why_not({.address = "::", .port = 0}), HasSubstr("a token and TLS are needed"));
  EXPECT_EQ(why_not({.address = "127.0.0.2", .port = 0}), "it listens");
}

TEST_F(ListenTest, WhatIsWrongIsSaid) {
  EXPECT_THAT(why_not({.address = "tower"}), HasSubstr("'tower' is no numeric address"));
  EXPECT_THAT(why_not({.port = 0, .tls = TlsFiles{"/nowhere.pem", "/nowhere.key"}}),
              HasSubstr("certificate '/nowhere.pem' cannot be used"));
  const auto first =
      Server::listen(context_, {.port = 0}, [](const Request&) { return Response{}; });
  ASSERT_TRUE(first.has_value());
  EXPECT_THAT(why_not({.port = (*first)->port()}), HasSubstr("in use"));
}

}  // namespace
}  // namespace recald::http
