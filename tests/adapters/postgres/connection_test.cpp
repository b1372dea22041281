#include "adapters/postgres/connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <stop_token>
#include <thread>

#include "tests/support/postgres_server.hpp"

namespace recald::postgres {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// One server for all of them, with a password; each has a database of its own.
class PostgresConnection : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!testing::PostgresServer::can_run()) return;
    server_ = new testing::PostgresServer{{.password = kPassword}};
    server_->start();
  }
  static void TearDownTestSuite() { delete server_; }

  void SetUp() override {
    if (server_ == nullptr) GTEST_SKIP() << "no postgresql-15";
    url_ = server_->new_database();
    connection_ = open();
  }

  [[nodiscard]] std::unique_ptr<Connection> open() const {
    auto opened = Connection::open(url_, kPassword);
    if (!opened) throw std::runtime_error(opened.error().message);
    return std::move(*opened);
  }
  [[nodiscard]] std::string ask(const std::string& statement) const {
    return server_->ask(statement, url_.substr(url_.rfind('/') + 1));
  }
  /// Ends the server's side of a connection.
  void end(Connection& connection) const {
    const auto id = connection.run("SELECT pg_backend_pid()");
    (void)ask("SELECT pg_terminate_backend(" + std::string{id->text(0, 0)} + ", 5000)");
  }

  static constexpr auto kPassword = "s3cret/=?";
  inline static testing::PostgresServer* server_ = nullptr;
  std::string url_;
  std::unique_ptr<Connection> connection_;
};

/// As a disk that hangs, or a machine that is paused: the kernel still acknowledges.
class PausedBackend {
 public:
  explicit PausedBackend(Connection& connection)
      : id_{static_cast<pid_t>(connection.run("SELECT pg_backend_pid()")->integer(0, 0))} {
    ::kill(id_, SIGSTOP);
  }
  ~PausedBackend() { ::kill(id_, SIGCONT); }
  PausedBackend(const PausedBackend&) = delete;
  PausedBackend& operator=(const PausedBackend&) = delete;

 private:
  pid_t id_;
};

// Each kind of call, with what it has to send that fits into no buffer too.
TEST_F(PostgresConnection, AServerThatDoesNotAnswerIsGivenUp) {
  using std::chrono::milliseconds;
  const std::string long_text(20'000'000, 'x');
  const std::vector<std::function<Result<void>(Connection&)>> calls{
      [](Connection& c) -> Result<void> {
        TRY(c.run("SELECT 1"));
        return {};
      },
      [&](Connection& c) -> Result<void> {
        TRY(c.run("SELECT $1::text", {long_text}));
        return {};
      },
      [](Connection& c) { return c.run_all("SELECT 1; SELECT 2"); },
      [](Connection& c) { return c.transaction([] { return Result<void>{}; }); },
      [](Connection& c) {
        return c.for_each("SELECT 1", {}, [](const Rows&) { return Result<void>{}; });
      }};
  for (std::size_t i = 0; i < calls.size(); ++i) {
    auto opened = Connection::open(url_, kPassword, {.answer_max = milliseconds{300}});
    ASSERT_TRUE(opened.has_value());
    const auto begin = std::chrono::steady_clock::now();
    {
      const PausedBackend paused{**opened};
      const auto ended = calls[i](**opened);
      ASSERT_FALSE(ended.has_value()) << i;
      EXPECT_EQ(ended.error().code, ErrorCode::io_failed) << i;
      EXPECT_THAT(ended.error().message, HasSubstr("does not answer")) << i;
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{20}) << i;
    // On another connection; a busy machine may need more than these 300 ms for one answer.
    const auto back = [&] { return (*opened)->run("SELECT 1").has_value(); };
    EXPECT_TRUE(testing::eventually(back)) << i;
  }
}

// Whoever ends waits no minute for it, and what a server that is well has to be told gets through.
TEST_F(PostgresConnection, AStopEndsAWaitSoon) {
  std::stop_source stop;
  auto opened = Connection::open(url_, kPassword, {.stop = stop.get_token()});
  ASSERT_TRUE(opened.has_value());
  {
    const PausedBackend paused{**opened};
    const std::jthread later{[&] {
      std::this_thread::sleep_for(std::chrono::milliseconds{100});
      stop.request_stop();
    }};
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE((*opened)->run("SELECT 1").has_value());
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{20});
  }
  EXPECT_TRUE((*opened)->run("SELECT 1").has_value());
}

TEST_F(PostgresConnection, ValuesComeBackAsTheyWent) {
  const std::string awkward = "a\\b\t'\"{},NULL \n\r \xC3\xA9 $1 \x01";
  std::string all_bytes;
  for (int byte = 0; byte < 256; ++byte) all_bytes += static_cast<char>(byte);
  const double odd = 0.1 + 0.2;
  const auto rows = connection_->run(
      "SELECT $1::text, $2::bigint, $3::float8, $4::bytea, $5::text, $6::float8, $7::float8, true",
      {awkward,
       integer(std::numeric_limits<std::int64_t>::min()),
       real(odd),
       bytes(all_bytes),
       {},
       real(std::nan("")),
       real(5e-324)});
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 1);
  EXPECT_EQ(rows->text(0, 0), awkward);
  EXPECT_EQ(rows->integer(0, 1), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(rows->real(0, 2), odd);
  EXPECT_EQ(rows->bytes(0, 3), all_bytes);
  EXPECT_TRUE(rows->is_null(0, 4));
  EXPECT_TRUE(std::isnan(rows->real(0, 5)));
  EXPECT_EQ(rows->real(0, 6), 5e-324);
  EXPECT_TRUE(rows->boolean(0, 7));
}

TEST_F(PostgresConnection, ArraysHoldAnyText) {
  const std::vector<std::string> texts{"",      "NULL",        "a,b",        "{x}",
                                       "\"q\"", "back\\slash", "two\nlines", " spaces "};
  Array names;
  for (const std::string& text : texts) names.add(text);
  Array numbers, reals;
  numbers.add(std::int64_t{1}).add(std::int64_t{-2});
  reals.add(1e300).add(std::nan(""));
  const auto rows = connection_->run("SELECT * FROM unnest($1::text[])", {names.parameter()});
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), static_cast<int>(texts.size()));
  for (int i = 0; i < rows->size(); ++i) {
    EXPECT_EQ(rows->text(i, 0), texts[static_cast<std::size_t>(i)]);
  }
  const auto pairs = connection_->run("SELECT * FROM unnest($1::bigint[], $2::float8[])",
                                      {numbers.parameter(), reals.parameter()});
  ASSERT_TRUE(pairs) << pairs.error().message;
  EXPECT_EQ(pairs->integer(1, 0), -2);
  EXPECT_EQ(pairs->real(0, 1), 1e300);
  EXPECT_TRUE(pairs->is_null(1, 1));
  const auto none = connection_->run("SELECT * FROM unnest($1::text[])", {Array{}.parameter()});
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_EQ(none->size(), 0);
}

TEST_F(PostgresConnection, TimesAreOfUtcAndTheServerKnowsWhoWeAre) {
  const auto rows = connection_->run(
      "SELECT current_setting('timezone'), application_name, "
      "'2024-03-01 12:00'::timestamptz = '2024-03-01T12:00:00Z'::timestamptz "
      "FROM pg_stat_activity WHERE pid = pg_backend_pid()");
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(rows->text(0, 0), "UTC");
  EXPECT_EQ(rows->text(0, 1), "recald");
  EXPECT_TRUE(rows->boolean(0, 2));
}

TEST_F(PostgresConnection, AVanishedPeerIsAnErrorOnBothSides) {
  const auto rows = connection_->run(
      "SELECT current_setting('tcp_user_timeout'), current_setting('tcp_keepalives_idle'), "
      "current_setting('idle_in_transaction_session_timeout')");
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(rows->text(0, 0), "25000");
  EXPECT_EQ(rows->text(0, 1), "10");
  EXPECT_EQ(rows->text(0, 2), "1min");
  // Ours are of the socket, as another program sees it.
  const std::string sockets =
      testing::run_in_shell("ss -tno state established dport = :" + std::to_string(server_->port()))
          .said;
  EXPECT_THAT(sockets, HasSubstr("timer:(keepalive"));
}

TEST_F(PostgresConnection, NoSentenceHasThePassword) {
  const auto wrong = Connection::open(url_, "wrong-passw0rd");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::io_failed);
  EXPECT_THAT(wrong.error().message, HasSubstr("password authentication failed"));
  EXPECT_THAT(wrong.error().message, HasSubstr("127.0.0.1:" + std::to_string(server_->port())));
  EXPECT_THAT(wrong.error().message, Not(HasSubstr("wrong-passw0rd")));
  EXPECT_THAT(wrong.error().message, Not(HasSubstr("\\x0A")));
  for (const char* url :
       {"postgresql://recald:hidden%ZZ@127.0.0.1/fleet",
        "postgresql://recald:hidden@127.0.0.1/fleet", "host=127.0.0.1 password=hidden"}) {
    const auto refused = Connection::open(url, "");
    ASSERT_FALSE(refused) << url;
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_value) << url;
    EXPECT_THAT(refused.error().message, Not(HasSubstr("hidden"))) << url;
  }
  const auto nobody = Connection::open("postgresql://recald@127.0.0.1:1/fleet", kPassword);
  ASSERT_FALSE(nobody);
  EXPECT_EQ(nobody.error().code, ErrorCode::io_failed);
  EXPECT_THAT(nobody.error().message,
              HasSubstr("PostgreSQL at 127.0.0.1:1/fleet cannot be reached: Connection refused"));
}

TEST_F(PostgresConnection, AStatementIsRefusedInTheServersWords) {
  const auto rows = connection_->run("SELECT nothing FROM nowhere");
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().code, ErrorCode::malformed);
  EXPECT_THAT(rows.error().message, HasSubstr("relation \"nowhere\" does not exist"));
  const auto cut = connection_->run("SELECT $1::text", {std::string{"a\0b", 3}});
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::malformed);
  EXPECT_TRUE(connection_->run("SELECT 1"));
}

TEST_F(PostgresConnection, ATransactionIsAllOrNothing) {
  ASSERT_TRUE(connection_->run_all("CREATE TABLE t (n int PRIMARY KEY)"));
  const auto refused = connection_->transaction([&]() -> Result<void> {
    (void)connection_->run("INSERT INTO t VALUES (1)");
    return failure(ErrorCode::cancelled, "changed our mind");
  });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::cancelled);
  EXPECT_EQ(ask("SELECT count(*) FROM t"), "0\n");
  // One that forgets that a statement failed has not been committed either.
  EXPECT_FALSE(connection_->transaction([&]() -> Result<void> {
    (void)connection_->run("INSERT INTO t VALUES (2)");
    (void)connection_->run("SELECT 1 / 0");
    return {};
  }));
  EXPECT_EQ(ask("SELECT count(*) FROM t"), "0\n");
  EXPECT_TRUE(connection_->transaction([&]() -> Result<void> {
    const auto put = connection_->run("INSERT INTO t VALUES (3)");
    if (!put) return tl::unexpected(put.error());
    return {};
  }));
  EXPECT_EQ(ask("SELECT n FROM t"), "3\n");
}

TEST_F(PostgresConnection, ADeadlockIsTriedAgain) {
  ASSERT_TRUE(
      connection_->run_all("CREATE TABLE t (n int PRIMARY KEY, v int); "
                           "INSERT INTO t VALUES (1, 0), (2, 0)"));
  const auto other = open();
  std::atomic<int> first_locks = 0;
  const auto cross = [&](Connection& connection, int one, int two) {
    return connection.transaction([&, one, two]() -> Result<void> {
      for (const int n : {one, two}) {
        if (auto put = connection.run("UPDATE t SET v = v + 1 WHERE n = $1", {integer(n)}); !put) {
          return tl::unexpected(put.error());
        }
        if (n != one) continue;
        ++first_locks;
        testing::eventually([&] { return first_locks >= 2; });
      }
      return {};
    });
  };
  std::jthread beside{[&] { EXPECT_TRUE(cross(*other, 2, 1)); }};
  const auto done = cross(*connection_, 1, 2);
  beside.join();
  EXPECT_TRUE(done) << done.error().message;
  EXPECT_GE(first_locks, 3);  // one of the two began again
  EXPECT_EQ(ask("SELECT v FROM t ORDER BY n"), "2\n2\n");
}

TEST_F(PostgresConnection, ALongAnswerComesRowByRow) {
  std::int64_t sum = 0;
  const auto done = connection_->for_each("SELECT generate_series(1, $1::int)", {integer(100'000)},
                                          [&](const Rows& row) -> Result<void> {
                                            EXPECT_EQ(row.size(), 1);
                                            sum += row.integer(0, 0);
                                            return {};
                                          });
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(sum, 5'000'050'000);
  int visits = 0;
  const auto ended = connection_->for_each("SELECT generate_series(1, 1000000000)", {},
                                           [&](const Rows&) -> Result<void> {
                                             ++visits;
                                             return failure(ErrorCode::cancelled, "enough");
                                           });
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::cancelled);
  EXPECT_EQ(visits, 1);
  EXPECT_FALSE(connection_->for_each("SELECT 1 / (3 - generate_series(1, 5))", {},
                                     [](const Rows&) -> Result<void> { return {}; }));
  EXPECT_TRUE(connection_->run("SELECT 1"));
}

TEST_F(PostgresConnection, BeginsAgainAfterTheServerEndedIt) {
  end(*connection_);
  const auto idle = connection_->run("SELECT 1");  // nothing was lost, and nobody need know
  EXPECT_TRUE(idle) << idle.error().message;
  const auto within = connection_->transaction([&]() -> Result<void> {
    end(*connection_);
    auto rows = connection_->run("SELECT 1");
    if (rows) return {};
    EXPECT_EQ(rows.error().code, ErrorCode::io_failed);
    rows = connection_->run("SELECT 1");  // not in a connection of its own
    EXPECT_FALSE(rows);
    return tl::unexpected(rows.error());
  });
  ASSERT_FALSE(within);
  EXPECT_EQ(within.error().code, ErrorCode::io_failed);
  EXPECT_THAT(within.error().message, HasSubstr("the connection is lost"));
  EXPECT_TRUE(connection_->run("SELECT 1"));
}

TEST_F(PostgresConnection, IsAwayAndComesBackWithTheServer) {
  server_->stop();
  const auto away = connection_->run("SELECT 1");
  ASSERT_FALSE(away);
  EXPECT_EQ(away.error().code, ErrorCode::io_failed);
  EXPECT_THAT(away.error().message, HasSubstr("cannot be reached: Connection refused"));
  server_->start();
  const auto back = connection_->run("SELECT 1");
  EXPECT_TRUE(back) << back.error().message;
}

TEST_F(PostgresConnection, WaitsUntilItIsNotified) {
  using std::chrono::seconds;
  const auto other = open();
  auto came = connection_->wait_for("news", seconds{60}, {});
  ASSERT_TRUE(came) << came.error().message;
  EXPECT_TRUE(*came);  // what came before is not known
  came = connection_->wait_for("news", std::chrono::milliseconds{50}, {});
  ASSERT_TRUE(came);
  EXPECT_FALSE(*came);
  std::jthread later{[&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{100});
    (void)other->run("SELECT pg_notify('news', '')");
  }};
  came = connection_->wait_for("news", seconds{600}, {});
  ASSERT_TRUE(came);
  EXPECT_TRUE(*came);
  later.join();
  // What arrives beside another statement is not lost, nor what waits for somebody else.
  ASSERT_TRUE(connection_->wait_for("other", seconds{0}, {}));
  (void)other->run("SELECT pg_notify('news', ''), pg_notify('other', '')");
  ASSERT_TRUE(connection_->run("SELECT 1"));
  came = connection_->wait_for("other", seconds{600}, {});
  EXPECT_TRUE(came && *came);
  came = connection_->wait_for("news", seconds{600}, {});
  EXPECT_TRUE(came && *came);
}

TEST_F(PostgresConnection, AWaitEndsWhenItIsToldToStop) {
  ASSERT_TRUE(connection_->wait_for("news", std::chrono::seconds{1}, {}));
  std::stop_source stop;
  std::jthread later{[&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
    stop.request_stop();
  }};
  // Would be the test's time out.
  const auto came = connection_->wait_for("news", std::chrono::hours{24}, stop.get_token());
  ASSERT_TRUE(came) << came.error().message;
  EXPECT_FALSE(*came);
}

TEST_F(PostgresConnection, AWaitEndsWithTheServer) {
  ASSERT_TRUE(connection_->wait_for("news", std::chrono::seconds{1}, {}));
  std::jthread later{[&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
    server_->kill();
  }};
  const auto came = connection_->wait_for("news", std::chrono::hours{24}, {});
  later.join();
  ASSERT_FALSE(came);
  EXPECT_EQ(came.error().code, ErrorCode::io_failed);
  EXPECT_THAT(came.error().message, HasSubstr("the connection is lost"));
  server_->start();
  const auto back = connection_->wait_for("news", std::chrono::hours{24}, {});
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(*back);
}

}  // namespace
}  // namespace recald::postgres
