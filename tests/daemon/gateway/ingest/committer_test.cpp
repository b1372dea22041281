/// What is on its way to the store, on a virtual loop, with a store that fills up and is emptied.
#include "daemon/gateway/ingest/committer.hpp"

#include <gmock/gmock.h>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/virtual_loop.hpp"

namespace recald::daemon::committer_test {
namespace {

using metering::Instant;
using recald::testing::FailingStore;
using recald::testing::VirtualLoop;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr seconds kQuarter{900};

class CommitterTest : public ::testing::Test {
 protected:
  CommitterTest() : disk_{open()}, store_{disk_}, loop_{kStart} {
    meter_ = disk_.meter_number("main", kQuarter).value();
  }

  static sqlite::SqliteStore open() {
    auto opened = sqlite::SqliteStore::open(":memory:");
    if (!opened) throw std::runtime_error(opened.error().message);
    return std::move(*opened);
  }
  [[nodiscard]] StoreBatch interval(int quarter) const {
    return {.intervals = {{{meter_, kStart + quarter * kQuarter, 10.0 + quarter}}}};
  }
  [[nodiscard]] StoreBatch sample(int second) const {
    return {.samples = {{meter_, "energy", kStart + seconds{second}, 1.0}}};
  }
  [[nodiscard]] StoreBatch state(double rated_kW) const {
    return {.registers = {{meter_, {.field = "energy", .settings = {.rated_kW = rated_kW}}}}};
  }
  [[nodiscard]] int stored() {
    int count = 0;
    EXPECT_TRUE(disk_
                    .for_each_interval(meter_, {Instant::min(), Instant::max()},
                                       [&](const StoredInterval&) { ++count; })
                    .has_value());
    return count;
  }
  [[nodiscard]] int stored_samples() {
    int count = 0;
    EXPECT_TRUE(disk_.for_each_sample(meter_, "energy", [&](const auto&) { ++count; }).has_value());
    return count;
  }
  Committer committer(const CommitRules& rules = {}) {
    return Committer{loop_, store_, rules, [this](const StoreBatch& batch, const CommitCounts&) {
                       committed_ += batch.intervals.size();
                     }};
  }

  sqlite::SqliteStore disk_;
  FailingStore store_;
  VirtualLoop loop_;
  std::uint32_t meter_ = 0;
  std::size_t committed_ = 0;
};

TEST_F(CommitterTest, IntervalsAreCommittedAtOnce) {
  Committer committer = this->committer();
  committer.add(interval(0));
  EXPECT_EQ(committed_, 0u);
  loop_.run_for(milliseconds{0});
  EXPECT_EQ(committed_, 1u);
  EXPECT_EQ(stored(), 1);
}

TEST_F(CommitterTest, OtherThingsAreGatheredForASecond) {
  Committer committer = this->committer();
  for (int i = 0; i < 10; ++i) {
    committer.add(sample(i));
    loop_.run_for(milliseconds{90});
  }
  EXPECT_EQ(committer.health().commits, 0u);
  loop_.run_for(milliseconds{200});
  EXPECT_EQ(committer.health().commits, 1u);
  loop_.run_for(hours{1});
  EXPECT_EQ(committer.health().commits, 1u);
}

TEST_F(CommitterTest, TheNewestStateOfARegisterIsKept) {
  Committer committer = this->committer();
  committer.add(state(100.0));
  committer.add(state(200.0));
  ASSERT_TRUE(committer.flush().has_value());
  const auto states = disk_.registers(meter_);
  ASSERT_THAT(*states, SizeIs(1));
  EXPECT_EQ(states->at(0).settings.rated_kW, 200.0);
}

// disk_full: it goes on, says so, tries again, and nothing that arrived meanwhile is lost.
TEST_F(CommitterTest, AFullDiskLosesNothingAndHealsByItself) {
  Committer committer = this->committer();
  committer.add(interval(0));
  loop_.run_for(milliseconds{1});
  store_.refuses = true;
  for (int quarter = 1; quarter <= 20; ++quarter) {
    committer.add(interval(quarter));
    loop_.run_for(kQuarter);
    EXPECT_TRUE(committer.health().is_degraded);
  }
  EXPECT_EQ(committer.health().why, "database or disk is full");
  EXPECT_GT(committer.health().failures, 100u);  // every ten seconds
  EXPECT_EQ(committer.waiting_intervals(), 20u);
  EXPECT_EQ(committed_, 1u);
  store_.refuses = false;
  loop_.run_for(seconds{10});
  EXPECT_FALSE(committer.health().is_degraded);
  EXPECT_EQ(committer.health().why, "");
  EXPECT_EQ(committed_, 21u);
  EXPECT_EQ(stored(), 21);
}

TEST_F(CommitterTest, WhatIsKeptIsBoundedAndTheLossIsCounted) {
  Committer committer = this->committer({.intervals_max = 5, .samples_max = 3});
  store_.refuses = true;
  for (int i = 0; i < 12; ++i) {
    committer.add(interval(i));
    committer.add(sample(i));
    loop_.run_for(milliseconds{1});
  }
  EXPECT_EQ(committer.waiting_intervals(), 5u);
  EXPECT_EQ(committer.health().lost_intervals, 7u);
  store_.refuses = false;
  loop_.run_for(seconds{10});
  EXPECT_EQ(stored(), 5);
  EXPECT_EQ((*disk_.interval_extent(meter_))->begin, kStart + 7 * kQuarter);
  EXPECT_EQ(stored_samples(), 3);
}

// A counter that comes back after weeks, or what was kept in memory for days, comes all at once.
TEST_F(CommitterTest, MoreThanIsKeptIsNoLossWhileTheStoreTakesIt) {
  Committer committer = this->committer({.intervals_max = 5, .samples_max = 3});
  StoreBatch many;
  for (int i = 0; i < 8; ++i) many.intervals.push_back(interval(i).intervals.front());
  committer.add(std::move(many));
  for (int i = 8; i < 30; ++i) {
    committer.add(interval(i));
    committer.add(sample(i));
  }
  EXPECT_LE(committer.waiting_intervals(), 5u);
  loop_.run_for(seconds{1});
  EXPECT_EQ(committer.health().lost_intervals, 0u);
  EXPECT_EQ(stored(), 30);
  EXPECT_EQ(stored_samples(), 22);
}

TEST_F(CommitterTest, EveryPartOfABatchArrives) {
  Committer committer = this->committer();
  committer.add({.intervals = {{{meter_, kStart, 10.0}}},
                 .registers = {{meter_, {.field = "energy", .settings = {.rated_kW = 1.0}}}},
                 .samples = {{meter_, "energy", kStart, 1.0}},
                 .events = {{kStart, Severity::info, "kind", "main", "A sentence."}},
                 .reopened = {{meter_, std::chrono::year{2024} / 3}}});
  ASSERT_TRUE(committer.flush().has_value());
  EXPECT_EQ(stored(), 1);
  EXPECT_THAT(*disk_.registers(meter_), SizeIs(1));
  EXPECT_THAT(*disk_.events(10), SizeIs(1));
  EXPECT_THAT(*disk_.reopened(), SizeIs(1));
  EXPECT_EQ(stored_samples(), 1);
}

TEST_F(CommitterTest, MayEndWhileSomethingWaits) {
  {
    Committer committer = this->committer();
    committer.add(interval(0));
  }
  loop_.run_for(seconds{10});
  EXPECT_EQ(stored(), 0);
}

TEST_F(CommitterTest, ConflictsAreCounted) {
  Committer committer = this->committer();
  committer.add(interval(0));
  committer.add({.intervals = {{{meter_, kStart, 99.0}}}});
  ASSERT_TRUE(committer.flush().has_value());
  EXPECT_EQ(committer.health().conflicts, 1u);
}

}  // namespace
}  // namespace recald::daemon::committer_test
