#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <thread>

#include "tests/adapters/record/record_fixture.hpp"
#include "tests/support/seed.hpp"

namespace recald::record {
namespace {

using ::testing::HasSubstr;

TEST_F(Record, AnIngesterThatIsKilledWhileItTakesLeavesNothing) {
  ASSERT_TRUE(send(intervals(0, 5)));
  // The insertion stops in the middle of its rows.
  (void)ask(
      "CREATE FUNCTION slow() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN "
      "IF NEW.seq = 8 THEN PERFORM pg_advisory_lock(99); END IF; RETURN NEW; END $$; "
      "CREATE TRIGGER slow BEFORE INSERT ON interval FOR EACH ROW EXECUTE FUNCTION slow()");
  const auto holder = open();
  ASSERT_TRUE(holder->run("SELECT pg_advisory_lock(99)"));
  const pid_t child = ::fork();
  if (child == 0) {
    const auto own = open();
    (void)take(*own, "tower", intervals(5, 5), kNow);
    ::_exit(0);
  }
  const auto waits = [this] {
    return ask(
        "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND "
        "wait_event = 'advisory'");
  };
  EXPECT_TRUE(testing::eventually([&] { return waits() == "1\n"; }));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ASSERT_TRUE(holder->run("SELECT pg_advisory_unlock(99)"));
  EXPECT_TRUE(testing::eventually([&] {
    return ask("SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND "
               "pid <> pg_backend_pid() AND query LIKE '%unnest%' AND state <> 'idle'") == "0\n";
  }));
  EXPECT_EQ(ask("SELECT count(*) FROM interval"), "5\n");
  EXPECT_EQ(watermarks(*connection_)->at(0).second.until.entries, 5);
  (void)ask("DROP TRIGGER slow ON interval");
  EXPECT_EQ(send(intervals(0, 10))->until.entries, 10);
  EXPECT_EQ(ask("SELECT count(*), max(seq) FROM interval"), "10|10\n");
}

TEST_F(Record, IngestersThatAreKilledAnywhereLoseAndRepeatNothing) {
  const testing::Seed seed;
  std::mt19937_64 random{seed.value()};
  std::int64_t known = 0;
  for (int kills = 0; kills < 10; ++kills) {
    const pid_t child = ::fork();
    if (child == 0) {
      const auto own = open();
      for (std::int64_t at = known;; at += 20) (void)take(*own, "tower", intervals(at, 20), kNow);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{20 + random() % 60});
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const auto watermark = send({.outbox = 11});  // waits for what its server's side still does
    ASSERT_TRUE(watermark) << watermark.error().message;
    known = watermark->until.entries;
    EXPECT_EQ(known % 20, 0);
    EXPECT_EQ(
        ask("SELECT count(*), count(DISTINCT seq), coalesce(max(seq), 0) FROM interval"),
        std::to_string(known) + "|" + std::to_string(known) + "|" + std::to_string(known) + "\n");
  }
  EXPECT_GT(known, 0);
}

TEST_F(Record, WhatWasTakenIsThereAfterTheServersDeath) {
  const testing::Seed seed;
  std::mt19937_64 random{seed.value()};
  testing::PostgresServer server{{.is_durable = true}};
  server.start();
  auto opened = postgres::Connection::open(server.url(), "");
  ASSERT_TRUE(opened) << opened.error().message;
  postgres::Connection& connection = **opened;
  ASSERT_TRUE(make_schema(connection));
  ASSERT_TRUE(put_site(connection, described("tower"), "ann"));
  std::atomic<std::int64_t> taken = 0;
  int refusals = 0;
  for (int death = 0; death < 3; ++death) {
    const std::int64_t from = taken;
    const std::int64_t at_batch = from + 500 * std::int64_t(1 + random() % 10);
    std::jthread killer{[&] {
      testing::eventually([&] { return taken >= at_batch; });
      server.kill();
    }};
    for (int batch = 0; batch < 20; ++batch) {
      const auto until = take(connection, "tower", intervals(taken, 500), kNow);
      if (until) {
        taken = until->until.entries;
        continue;
      }
      ++refusals;
      EXPECT_EQ(until.error().code, ErrorCode::io_failed) << until.error().message;
      EXPECT_THAT(until.error().message, HasSubstr("PostgreSQL at 127.0.0.1"));
      break;
    }
    killer.join();
    server.start();
    // The connection comes back by itself, and nothing that was said to be taken is missing.
    const auto back = watermarks(connection);
    ASSERT_TRUE(back) << back.error().message;
    const std::int64_t committed = back->at(0).second.until.entries;
    EXPECT_GE(committed, taken);
    EXPECT_LE(committed, taken + 500);  // committed, but nobody could be told
    EXPECT_EQ(server.ask("SELECT count(*), max(seq) FROM interval"),
              std::to_string(committed) + "|" + std::to_string(committed) + "\n");
  }
  EXPECT_GT(refusals, 0);
}

TEST_F(Record, WhileTheServerIsAwayASentenceSaysSo) {
  testing::PostgresServer server;
  server.start();
  auto opened = postgres::Connection::open(server.url(), "");
  ASSERT_TRUE(opened) << opened.error().message;
  ASSERT_TRUE(make_schema(**opened));
  ASSERT_TRUE(put_site(**opened, described("tower"), "ann"));
  server.stop();
  for (int i = 0; i < 3; ++i) {
    const auto away = take(**opened, "tower", intervals(0, 5), kNow);
    ASSERT_FALSE(away);
    EXPECT_EQ(away.error().code, ErrorCode::io_failed);
    EXPECT_THAT(away.error().message, HasSubstr("cannot be reached: Connection refused"));
  }
  server.start();
  const auto back = take(**opened, "tower", intervals(0, 5), kNow);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->until.entries, 5);
}

}  // namespace
}  // namespace recald::record
