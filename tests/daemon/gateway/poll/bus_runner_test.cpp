/// A bus runner on a virtual loop.
#include "daemon/gateway/poll/bus_runner.hpp"

#include <gmock/gmock.h>

#include "tests/support/virtual_loop.hpp"

namespace recald::daemon::bus_runner_test {
namespace {

using recald::testing::VirtualLoop;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::SizeIs;

const WallTime kNoon =
    std::chrono::sys_days{std::chrono::year{2024} / 3 / 1} + std::chrono::hours{12};

/// Answers after a while, or with a failure.
class TestBus final : public Bus {
 public:
  TestBus(Loop& loop, milliseconds after, int& reads) : loop_(loop), after_(after), reads_(reads) {}

  void read(const modbus::ReadRequest& request, milliseconds timeout, Done done) override {
    ++reads_;
    const bool in_time = after_ <= timeout;
    const milliseconds duration = std::min(after_, timeout);
    loop_.after(duration, [=] {
      if (in_time) {
        done(modbus::Words(request.count), duration);
      } else {
        done(tl::unexpected(modbus::ReadFailure{modbus::ReadFault::timeout}), duration);
      }
    });
  }

 private:
  Loop& loop_;
  milliseconds after_;
  int& reads_;
};

BusPoller poller() {
  return BusPoller{
      {{.meter = "main", .reads = {{modbus::Function::read_holding_registers, 0, 2, {0}}}}},
      {},
      Rng{1}};
}

TEST(BusRunner, WhateverItsListenerThrowsItGoesOn) {
  VirtualLoop loop{kNoon};
  int reads = 0;
  BusRunner runner{loop, std::make_unique<TestBus>(loop, milliseconds{30}, reads), poller(),
                   [](const PolledRead&) { throw std::runtime_error("unforeseen"); }};
  runner.start();
  for (int thrown = 1; thrown <= 5; ++thrown) {
    EXPECT_THROW(loop.run_for(minutes{2}), std::runtime_error);
    EXPECT_EQ(reads, thrown);
  }
}

TEST(BusRunner, HandsOnEveryReadWithItsTimes) {
  VirtualLoop loop{kNoon};
  int reads = 0;
  std::vector<PolledRead> told;
  BusRunner runner{loop, std::make_unique<TestBus>(loop, milliseconds{30}, reads), poller(),
                   [&](const PolledRead& read) { told.push_back(read); }};
  runner.start();
  loop.run_for(minutes{3} + seconds{1});
  ASSERT_THAT(told, SizeIs(4));
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].order.due, kNoon + i * minutes{1});
    EXPECT_EQ(told[i].lateness, milliseconds{0});
    EXPECT_EQ(told[i].duration, milliseconds{30});
    EXPECT_EQ(told[i].at.wall, kNoon + i * minutes{1} + milliseconds{30});
    EXPECT_EQ(told[i].result->size(), 2u);
  }
}

// Another connection, with the old one ended first; what was under way on that is not told.
TEST(BusRunner, BegunAnewItReadsOnAnotherBus) {
  VirtualLoop loop{kNoon};
  int before = 0;
  int after = 0;
  std::vector<PolledRead> told;
  BusRunner runner{loop, std::make_unique<TestBus>(loop, milliseconds{30}, before), poller(),
                   [&](const PolledRead& read) { told.push_back(read); }};
  runner.start();
  loop.run_for(minutes{1} + milliseconds{10});
  ASSERT_EQ(before, 2);
  runner.begin_anew([&] { return std::make_unique<TestBus>(loop, milliseconds{40}, after); });
  loop.run_for(seconds{1});
  EXPECT_EQ(after, 1);
  ASSERT_THAT(told, SizeIs(2));
  EXPECT_EQ(told[1].duration, milliseconds{40});
  loop.run_for(minutes{2});
  EXPECT_EQ(before, 2);
  EXPECT_EQ(after, 3);
  EXPECT_EQ(runner.counters().duration.count(), 4u);
}

// A poll of two reads is as late as its first one; probes of a dead unit are not late at all.
TEST(BusRunner, CountsRequestsAndPolls) {
  VirtualLoop loop{kNoon};
  int reads = 0;
  BusPoller two_reads{{{.meter = "main",
                        .reads = {{modbus::Function::read_holding_registers, 0, 2, {0}},
                                  {modbus::Function::read_holding_registers, 100, 2, {1}}}}},
                      {},
                      Rng{1}};
  BusRunner runner{loop, std::make_unique<TestBus>(loop, milliseconds{30}, reads),
                   std::move(two_reads), [](const PolledRead&) {}};
  runner.start();
  loop.run_for(minutes{3} + seconds{1});
  const BusCounters& counters = runner.counters();
  EXPECT_EQ(counters.requests.at(0)[static_cast<std::size_t>(RequestResult::ok)], 8u);
  EXPECT_EQ(counters.duration.count(), 8u);
  EXPECT_EQ(counters.lateness.count(), 4u);
  EXPECT_EQ(counters.lateness.sum_s(), 0.0);
}

TEST(BusRunner, CountsSilenceAsSuch) {
  VirtualLoop loop{kNoon};
  int reads = 0;
  BusRunner runner{loop, std::make_unique<TestBus>(loop, seconds{9}, reads), poller(),
                   [](const PolledRead&) {}};
  runner.start();
  loop.run_for(minutes{30});
  const auto asked = static_cast<std::uint64_t>(reads);
  const std::uint64_t silent =
      runner.counters().requests.at(0)[static_cast<std::size_t>(RequestResult::timeout)];
  EXPECT_GE(silent + 1, asked);  // one may be under way
  EXPECT_GT(silent, runner.counters().lateness.count());
}

TEST(BusRunner, GoesOnAfterFailures) {
  VirtualLoop loop{kNoon};
  int reads = 0;
  std::vector<PolledRead> told;
  BusRunner runner{loop, std::make_unique<TestBus>(loop, seconds{9}, reads), poller(),
                   [&](const PolledRead& read) { told.push_back(read); }};
  runner.start();
  loop.run_for(minutes{30});
  EXPECT_GE(told.size(), 6u);
  EXPECT_FALSE(told.back().result.has_value());
  EXPECT_EQ(runner.poller().state(0), UnitState::down);
}

// A reload may end a bus while a read is under way, or from within the telling of one.
TEST(BusRunner, MayEndAtAnyTime) {
  VirtualLoop loop{kNoon};
  int reads = 0;
  int told = 0;
  auto runner =
      std::make_unique<BusRunner>(loop, std::make_unique<TestBus>(loop, milliseconds{30}, reads),
                                  poller(), [&](const PolledRead&) { ++told; });
  runner->start();
  loop.run_for(milliseconds{10});
  EXPECT_EQ(reads, 1);
  runner.reset();
  loop.run_for(minutes{10});
  EXPECT_EQ(told, 0);

  runner =
      std::make_unique<BusRunner>(loop, std::make_unique<TestBus>(loop, milliseconds{30}, reads),
                                  poller(), [&](const PolledRead&) {
                                    ++told;
                                    runner.reset();
                                  });
  runner->start();
  loop.run_for(minutes{10});
  EXPECT_EQ(told, 1);
  EXPECT_EQ(reads, 2);
}

}  // namespace
}  // namespace recald::daemon::bus_runner_test
