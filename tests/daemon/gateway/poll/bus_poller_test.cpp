/// The schedule of a bus on a virtual clock, against devices that are slow, silent, busy or dead.
#include "daemon/gateway/poll/bus_poller.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <map>

namespace recald::daemon::bus_poller_test {
namespace {

using modbus::ReadFailure;
using modbus::ReadFault;
using modbus::ReadResult;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::Le;
using ::testing::SizeIs;

const WallTime kNoon = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1} + hours{12};

/// What a device does with one read: how long it takes, and what comes of it.
struct Reply {
  milliseconds after{20};
  std::optional<ReadFailure> failure;  ///< None: the registers.
};

Reply silence() { return {milliseconds{1'000'000}, ReadFailure{ReadFault::timeout}}; }
Reply exception(int code) {
  return {milliseconds{20}, ReadFailure{ReadFault::exception, static_cast<std::uint8_t>(code)}};
}

PolledUnit unit(int number, milliseconds period = seconds{60}, int reads = 1) {
  PolledUnit made{.meter = "m" + std::to_string(number),
                  .unit = static_cast<std::uint8_t>(number),
                  .period = period};
  for (int i = 0; i < reads; ++i) {
    made.reads.push_back(
        {modbus::Function::read_holding_registers, static_cast<std::uint16_t>(100 * i), 2, {0}});
  }
  return made;
}

/// One bus with its devices. Time passes only while somebody waits or answers.
class VirtualBus {
 public:
  using Devices = std::function<Reply(const BusOrder&, const Moment&)>;

  struct Made {
    BusOrder order;
    WallTime at;
    bool answered;
  };

  VirtualBus(std::vector<PolledUnit> units, Devices devices, const BusRules& rules = {})
      : poller{std::move(units), rules, Rng{7}}, devices_(std::move(devices)) {}

  void run(milliseconds length) {
    for (const milliseconds end = now.monotonic + length; now.monotonic < end;) {
      const auto order = poller.next(now);
      if (!order) {
        pass(std::min(poller.wait(now), end - now.monotonic));
        continue;
      }
      const WallTime at = now.wall;
      const Reply reply = devices_(*order, now);
      const bool in_time = reply.after <= order->timeout;
      pass(std::min(reply.after, order->timeout));
      ReadResult result = modbus::Words(order->request.count);
      if (reply.failure) result = tl::unexpected(*reply.failure);
      if (!in_time) result = tl::unexpected(ReadFailure{ReadFault::timeout});
      made.push_back({*order, at, result.has_value()});
      poller.answered(*order, result, std::min(reply.after, order->timeout), now);
    }
  }

  void pass(milliseconds length) {
    now.wall += length;
    now.monotonic += length;
  }

  [[nodiscard]] std::vector<milliseconds> lateness(std::size_t index, WallTime since = {}) const {
    std::vector<milliseconds> all;
    for (const Made& one : made) {
      if (one.order.unit == index && !one.order.is_probe && one.at >= since)
        all.push_back(one.at - one.order.due);
    }
    return all;
  }
  [[nodiscard]] int count(std::size_t index, bool probes) const {
    return static_cast<int>(std::ranges::count_if(made, [&](const Made& one) {
      return one.order.unit == index && one.order.is_probe == probes;
    }));
  }

  Moment now{kNoon + milliseconds{12'345}, milliseconds{1'000}};
  BusPoller poller;
  std::vector<Made> made;

 private:
  Devices devices_;
};

VirtualBus::Devices all_answer() {
  return [](const BusOrder&, const Moment&) { return Reply{}; };
}

std::vector<WallTime> times(const VirtualBus& bus, std::size_t index) {
  std::vector<WallTime> all;
  for (const auto& one : bus.made) {
    if (one.order.unit == index) all.push_back(one.at);
  }
  return all;
}

TEST(BusPoller, PollsAtOnceAndThenByTheWallClock) {
  VirtualBus bus{{unit(1)}, all_answer()};
  bus.run(minutes{3});
  EXPECT_THAT(times(bus, 0), ElementsAre(kNoon + milliseconds{12'345}, kNoon + minutes{1},
                                         kNoon + minutes{2}, kNoon + minutes{3}));
}

// 40 s do not divide a quarter of an hour; its end is polled all the same.
TEST(BusPoller, PollsAtEveryIntervalBoundary) {
  VirtualBus bus{{unit(1, seconds{40})}, all_answer()};
  bus.run(minutes{31});
  const auto all = times(bus, 0);
  EXPECT_THAT(all, ::testing::Contains(kNoon + minutes{15}));
  EXPECT_THAT(all, ::testing::Contains(kNoon + minutes{30}));
  EXPECT_THAT(all, ::testing::Contains(kNoon + seconds{880}));
  EXPECT_THAT(all, ::testing::Contains(kNoon + seconds{920}));
}

// A poll is late by what has passed since its own due time, not since the full minute.
TEST(BusPoller, EachUnitIsDueAtItsOwnTime) {
  std::vector<PolledUnit> units{unit(1), unit(2)};
  units[0].phase = 0.25;
  units[1].phase = 0.26;  // 0.6 s later
  VirtualBus bus{units, [](const BusOrder&, const Moment&) { return Reply{milliseconds{900}}; }};
  bus.run(minutes{10});
  bus.made.clear();
  bus.run(minutes{4});
  EXPECT_THAT(times(bus, 0), ElementsAre(kNoon + seconds{615}, kNoon + seconds{675},
                                         kNoon + seconds{735}, kNoon + seconds{795}));
  EXPECT_THAT(bus.lateness(0), Each(milliseconds{0}));
  EXPECT_THAT(bus.lateness(1), SizeIs(4));
  EXPECT_THAT(bus.lateness(1), Each(milliseconds{300}));
}

TEST(BusPoller, BegunAnewAUnitKeepsItsPhase) {
  std::vector<PolledUnit> units{unit(1)};
  units[0].phase = 0.75;
  VirtualBus bus{units, all_answer()};
  bus.run(minutes{2});
  bus.poller.begin_anew();
  bus.made.clear();
  bus.run(minutes{2});
  // At the start within a second: 0.75 of 0.8 s.
  EXPECT_THAT(times(bus, 0), ElementsAre(kNoon + milliseconds{132'345 + 600}, kNoon + seconds{165},
                                         kNoon + seconds{225}));
}

TEST(BusPoller, AllReadsOfAPollInOrder) {
  VirtualBus bus{{unit(1, seconds{60}, 3)}, all_answer()};
  bus.run(seconds{1});
  ASSERT_THAT(bus.made, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(bus.made[i].order.read, i);
}

// gateway_one_unit_dead: after its first poll the living one of 32 is never late, and what the
// dead get is a small share of the bus.
TEST(BusPoller, ThirtyOneDeadCostTheLivingOneNothing) {
  std::vector<PolledUnit> units;
  for (int i = 1; i <= 32; ++i) units.push_back(unit(i, seconds{10}));
  constexpr std::size_t kLiving = 17;
  VirtualBus bus{units, [](const BusOrder& order, const Moment&) {
                   return order.unit == kLiving ? Reply{} : silence();
                 }};
  bus.run(hours{2});
  const auto late = bus.lateness(kLiving, kNoon + minutes{1});
  EXPECT_GE(late.size(), 710u);
  EXPECT_THAT(late, Each(milliseconds{0}));
  milliseconds probing{0};
  for (const auto& one : bus.made) {
    if (one.order.is_probe) probing += one.order.timeout;
  }
  EXPECT_LE(probing, minutes{120} / 20 + seconds{10});
  for (std::size_t i = 0; i < 32; ++i) {
    if (i == kLiving) continue;
    EXPECT_EQ(bus.poller.state(i), UnitState::down);
    EXPECT_GE(bus.count(i, true), 5) << i;
    EXPECT_LE(bus.count(i, false), 3) << i;
  }
}

TEST(BusPoller, AllUnitsDeadComeBackUnaided) {
  std::vector<PolledUnit> units;
  for (int i = 1; i <= 8; ++i) units.push_back(unit(i));
  bool alive = false;
  VirtualBus bus{units,
                 [&](const BusOrder&, const Moment&) { return alive ? Reply{} : silence(); }};
  bus.run(hours{24});
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(bus.poller.state(i), UnitState::down);
  alive = true;
  bus.run(minutes{6});
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(bus.poller.state(i), UnitState::up);
  const WallTime recovered = bus.now.wall;
  bus.run(hours{1});
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_THAT(bus.lateness(i, recovered), SizeIs(Ge(59u)));
    EXPECT_THAT(bus.lateness(i, recovered), Each(Le(milliseconds{8 * 20})));
  }
}

TEST(BusPoller, ProbesOfTheDeadGrowRare) {
  VirtualBus bus{{unit(1)}, [](const BusOrder&, const Moment&) { return silence(); }};
  bus.run(hours{1});
  std::vector<milliseconds> waits;
  std::optional<WallTime> before;
  for (const auto& one : bus.made) {
    if (!one.order.is_probe) continue;
    if (before) waits.push_back(one.at - *before);
    before = one.at;
  }
  ASSERT_GE(waits.size(), 8u);
  EXPECT_LE(waits[0], seconds{20});
  for (std::size_t i = 0; i < waits.size(); ++i) {
    EXPECT_LE(waits[i], seconds{336}) << i;  // 300 s, a tenth more, and the probe itself
    if (i > 5) {
      EXPECT_GE(waits[i], seconds{270}) << i;
    }
  }
}

TEST(BusPoller, ASilentUnitCostsOneTimeOutAPoll) {
  VirtualBus bus{{unit(1, seconds{60}, 4)},
                 [](const BusOrder&, const Moment&) { return silence(); }};
  bus.run(seconds{30});
  EXPECT_THAT(bus.made, SizeIs(1));
  EXPECT_EQ(bus.poller.state(0), UnitState::degraded);
  bus.run(seconds{150});
  EXPECT_EQ(bus.poller.state(0), UnitState::down);
}

TEST(BusPoller, ABusyDeviceIsAskedAgainThreeTimes) {
  for (const int busy : {0x05, 0x06}) {  // acknowledged and under way; busy with another
    VirtualBus bus{{unit(1, seconds{60}, 2)}, [&](const BusOrder& order, const Moment&) {
                     return order.read == 0 ? exception(busy) : Reply{};
                   }};
    bus.run(seconds{40});
    std::vector<std::size_t> reads;
    for (const auto& one : bus.made) reads.push_back(one.order.read);
    EXPECT_THAT(reads, ElementsAre(0, 0, 0, 0, 1)) << busy;
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_EQ(bus.made.at(i).at - bus.made.at(i - 1).at, milliseconds{120}) << busy;
    }
    EXPECT_EQ(bus.poller.state(0), UnitState::degraded) << busy;
  }
}

// Whatever it refuses with, it is asked again, ever more rarely, and its other registers as usual.
TEST(BusPoller, ARefusedReadIsAskedForEver) {
  for (const int code : {0x01, 0x02, 0x03, 0x04, 0x08, 0x63}) {
    SCOPED_TRACE(code);
    VirtualBus bus{{unit(1, seconds{60}, 2)}, [&](const BusOrder& order, const Moment&) {
                     return order.read == 1 ? exception(code) : Reply{};
                   }};
    bus.run(hours{2});
    std::vector<WallTime> asked;
    for (const auto& one : bus.made) {
      if (one.order.read == 1) asked.push_back(one.at);
    }
    ASSERT_THAT(asked, SizeIs(Ge(20u)));
    for (std::size_t i = 1; i < asked.size(); ++i) {
      EXPECT_LE(asked[i] - asked[i - 1], minutes{6}) << i;
      if (i > 6) {
        EXPECT_GE(asked[i] - asked[i - 1], minutes{5}) << i;
      }
    }
    EXPECT_EQ(bus.poller.state(0), UnitState::degraded);
    EXPECT_EQ(bus.made.size() - asked.size(), 121u);
  }
}

TEST(BusPoller, AReadThatIsServedAgainIsOrdinaryAgain) {
  bool refuses = true;
  VirtualBus bus{{unit(1)}, [&](const BusOrder&, const Moment&) {
                   return refuses ? exception(0x02) : Reply{};
                 }};
  bus.run(minutes{10} + seconds{30});
  refuses = false;
  bus.run(minutes{6});
  EXPECT_EQ(bus.poller.state(0), UnitState::up);
  const std::size_t before = bus.made.size();
  bus.run(minutes{10});
  EXPECT_EQ(bus.made.size() - before, 10u);
}

TEST(BusPoller, BegunAnewItTriesAllAgainAtOnce) {
  bool works = false;
  VirtualBus bus{{unit(1), unit(2)}, [&](const BusOrder& order, const Moment&) {
                   if (works) return Reply{};
                   return order.unit == 0 ? exception(0x02) : silence();
                 }};
  bus.run(hours{1} + seconds{1});
  ASSERT_EQ(bus.poller.state(1), UnitState::down);
  works = true;
  bus.poller.begin_anew();
  bus.run(minutes{1});
  EXPECT_EQ(bus.poller.state(0), UnitState::up);
  EXPECT_EQ(bus.poller.state(1), UnitState::up);
}

TEST(BusPoller, AGatewayMayAnswerForADeadUnit) {
  for (const int code : {0x0A, 0x0B}) {  // no path to it; no answer from it
    VirtualBus bus{{unit(1), unit(2)}, [&](const BusOrder& order, const Moment&) {
                     return order.unit == 0 ? exception(code) : Reply{};
                   }};
    bus.run(minutes{10});
    EXPECT_EQ(bus.poller.state(0), UnitState::down) << code;
    EXPECT_EQ(bus.poller.state(1), UnitState::up) << code;
    EXPECT_THAT(bus.lateness(1), SizeIs(Ge(10u))) << code;  // the bus does not rest
    EXPECT_THAT(bus.lateness(1), Each(Le(milliseconds{100}))) << code;
  }
}

// endpoint_reboot: refused for five minutes, then back.
TEST(BusPoller, ABusWithoutConnectionRests) {
  bool refuses = true;
  VirtualBus bus{
      {unit(1, seconds{10}), unit(2, seconds{10})}, [&](const BusOrder&, const Moment&) {
        return refuses ? Reply{milliseconds{1}, ReadFailure{ReadFault::refused}} : Reply{};
      }};
  bus.run(minutes{5});
  EXPECT_THAT(bus.made, SizeIs(Le(14u)));  // 1, 2, 4 … 60 s apart
  EXPECT_THAT(bus.made, SizeIs(Ge(8u)));
  refuses = false;
  bus.run(minutes{7});
  EXPECT_EQ(bus.poller.state(0), UnitState::up);
  EXPECT_EQ(bus.poller.state(1), UnitState::up);
}

// What it has learned of devices that were exchanged since is not true of the new ones.
TEST(BusPoller, BegunAnewItKnowsNothingOfItsUnits) {
  bool answers = true;
  VirtualBus bus{{unit(1), unit(2)}, [&](const BusOrder& order, const Moment&) {
                   return order.unit == 0 || answers ? Reply{} : silence();
                 }};
  bus.run(minutes{20});
  answers = false;
  bus.run(minutes{10});
  ASSERT_EQ(bus.made.back().order.timeout, LearnedTimeout::kMin);
  ASSERT_EQ(bus.poller.state(1), UnitState::down);
  bus.poller.begin_anew();
  EXPECT_EQ(bus.poller.state(1), UnitState::up);
  bus.made.clear();
  bus.run(seconds{5});
  ASSERT_THAT(bus.made, SizeIs(2));
  for (const auto& one : bus.made) {
    EXPECT_FALSE(one.order.is_probe);
    EXPECT_EQ(one.order.timeout, LearnedTimeout::kUnknown);
  }
}

// The adapter is plugged in again, and somebody reloads: nobody waits for the end of the rest.
TEST(BusPoller, BegunAnewItConnectsAgainAtOnce) {
  bool refuses = true;
  VirtualBus bus{
      {unit(1, seconds{10})}, [&](const BusOrder&, const Moment&) {
        return refuses ? Reply{milliseconds{1}, ReadFailure{ReadFault::refused}} : Reply{};
      }};
  const std::size_t rested = 8;  // 1, 2, 4 … 60 s
  while (bus.made.size() < rested) bus.run(seconds{1});
  refuses = false;
  bus.poller.begin_anew();
  bus.run(seconds{2});
  ASSERT_THAT(bus.made, SizeIs(Ge(rested + 1)));
  EXPECT_TRUE(bus.made[rested].answered);
}

TEST(BusPoller, ADeviceThatClosesOnceDoesNotSilenceItsNeighbours) {
  VirtualBus bus{
      {unit(1, seconds{10}), unit(2, seconds{10})}, [](const BusOrder& order, const Moment&) {
        return order.unit == 0 ? Reply{milliseconds{1}, ReadFailure{ReadFault::closed}} : Reply{};
      }};
  bus.run(minutes{5});
  EXPECT_THAT(bus.lateness(1), SizeIs(Ge(30u)));
  EXPECT_THAT(bus.lateness(1), Each(Le(milliseconds{1})));
}

TEST(BusPoller, ADeviceThatAlwaysClosesIsGivenRest) {
  VirtualBus bus{{unit(1, seconds{10}), unit(2, seconds{10})}, [](const BusOrder&, const Moment&) {
                   return Reply{milliseconds{1}, ReadFailure{ReadFault::closed}};
                 }};
  bus.run(minutes{5});
  EXPECT_THAT(bus.made, SizeIs(Le(14u)));  // 1, 2, 4 … 60 s apart
}

TEST(BusPoller, AUnitThatIsBackIsPolledAtOnce) {
  bool alive = false;
  PolledUnit rarely = unit(1, hours{1}, 2);
  rarely.interval = hours{1};
  VirtualBus bus{{rarely},
                 [&](const BusOrder&, const Moment&) { return alive ? Reply{} : silence(); }};
  bus.run(minutes{121});  // three polls: at the start, and at two full hours
  ASSERT_EQ(bus.poller.state(0), UnitState::down);
  alive = true;
  bus.made.clear();
  bus.run(minutes{6});
  ASSERT_GE(bus.made.size(), 3u);
  EXPECT_TRUE(bus.made[0].order.is_probe);
  EXPECT_FALSE(bus.made[1].order.is_probe);
  EXPECT_EQ(bus.made[1].at - bus.made[0].at, milliseconds{20});
}

// Ten devices of two seconds each cannot be polled every ten seconds: each gets its share, none a
// burst, and what was left out is counted.
TEST(BusPoller, AnOverloadedBusSkipsPollsAndNeverQueues) {
  std::vector<PolledUnit> units;
  for (int i = 1; i <= 10; ++i) {
    units.push_back(unit(i, seconds{10}));
    units.back().timeout = seconds{5};
  }
  VirtualBus bus{units, [](const BusOrder&, const Moment&) { return Reply{seconds{2}}; }};
  bus.run(minutes{15});  // until each has answered once
  bus.made.clear();
  bus.run(minutes{20});
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_GE(bus.count(i, false), 55) << i;
    EXPECT_LE(bus.count(i, false), 65) << i;
    EXPECT_GE(bus.poller.skipped(i), 50u) << i;
    EXPECT_THAT(bus.lateness(i), Each(Le(seconds{20}))) << i;
  }
}

// Reads of one poll have one due time, however long the poll takes: by it they are summed.
TEST(BusPoller, TheReadsOfAPollBelongTogether) {
  std::vector<PolledUnit> units{unit(1, seconds{10}, 3), unit(2, seconds{10}, 3)};
  for (PolledUnit& polled : units) polled.timeout = seconds{20};
  VirtualBus bus{units, [](const BusOrder&, const Moment&) { return Reply{seconds{7}}; }};
  bus.run(minutes{30});
  std::map<std::pair<std::size_t, WallTime>, std::vector<std::size_t>> reads;
  for (const auto& one : bus.made) reads[{one.order.unit, one.order.due}].push_back(one.order.read);
  ASSERT_GE(reads.size(), 20u);
  int whole = 0;
  for (const auto& [poll, read] : reads) {
    whole += static_cast<int>(read == std::vector<std::size_t>{0, 1, 2});
  }
  EXPECT_GE(whole, static_cast<int>(reads.size()) - 1);  // the last one may be under way
}

TEST(BusPoller, ASlowDeviceIsLearned) {
  std::vector<PolledUnit> units{unit(1, seconds{10})};
  VirtualBus bus{units, [](const BusOrder&, const Moment&) { return Reply{milliseconds{600}}; }};
  bus.run(minutes{10});
  EXPECT_TRUE(std::ranges::all_of(bus.made, &VirtualBus::Made::answered));
  EXPECT_EQ(bus.made.back().order.timeout, milliseconds{2400});
}

TEST(BusPoller, AClockSetBackDoesNotStopThePolls) {
  VirtualBus bus{{unit(1), unit(2)}, all_answer()};
  bus.run(minutes{10});
  const std::size_t before = bus.made.size();
  bus.now.wall -= minutes{20};
  bus.run(minutes{10});
  EXPECT_EQ(bus.made.size() - before, 20u);
}

// step_forward_2h: no burst for the polls that never were.
TEST(BusPoller, AClockSetForwardMakesNoBurst) {
  VirtualBus bus{{unit(1), unit(2)}, all_answer()};
  bus.run(minutes{10});
  const std::size_t before = bus.made.size();
  bus.now.wall += hours{2};
  bus.run(minutes{10});
  EXPECT_EQ(bus.made.size() - before, 20u);
  EXPECT_EQ(bus.poller.skipped(0), 0u);
}

TEST(BusPoller, APauseAfterEachAnswerIsKept) {
  VirtualBus bus{{unit(1, seconds{60}, 3)}, all_answer(), {.request_gap = milliseconds{25}}};
  bus.run(seconds{10});
  ASSERT_THAT(bus.made, SizeIs(3));
  EXPECT_EQ(bus.made[1].at - bus.made[0].at, milliseconds{45});
  EXPECT_EQ(bus.made[2].at - bus.made[1].at, milliseconds{45});
}

// Between polls nobody wakes up more than once a second, whatever state the units are in.
TEST(BusPoller, WaitsAreLong) {
  std::vector<PolledUnit> units;
  for (int i = 1; i <= 16; ++i) units.push_back(unit(i, seconds{10}));
  VirtualBus bus{units, [](const BusOrder& order, const Moment&) {
                   return order.unit < 2 ? Reply{} : silence();
                 }};
  bus.run(minutes{30});
  int wakes = 0;
  for (const Moment end{{}, bus.now.monotonic + minutes{10}}; bus.now.monotonic < end.monotonic;) {
    if (const auto order = bus.poller.next(bus.now)) {
      const bool alive = order->unit < 2;
      bus.pass(alive ? milliseconds{20} : order->timeout);
      ReadResult result = modbus::Words(2);
      if (!alive) result = tl::unexpected(ReadFailure{ReadFault::timeout});
      bus.poller.answered(*order, result, milliseconds{20}, bus.now);
    } else {
      bus.pass(bus.poller.wait(bus.now));
      ++wakes;
    }
  }
  EXPECT_LE(wakes, 900);
}

TEST(LearnedTimeout, FollowsTheSlowestAnswersWithinItsLimits) {
  LearnedTimeout learned;
  EXPECT_EQ(learned.timeout(), LearnedTimeout::kUnknown);
  for (int i = 0; i < 200; ++i) learned.answered(milliseconds{10});
  EXPECT_EQ(learned.timeout(), LearnedTimeout::kMin);
  learned.answered(milliseconds{400});
  EXPECT_EQ(learned.timeout(), LearnedTimeout::kMin);  // one of 128 is no rule
  learned.answered(milliseconds{400});
  EXPECT_EQ(learned.timeout(), milliseconds{1600});
  for (int i = 0; i < 10; ++i) learned.answered(milliseconds{3000});
  EXPECT_EQ(learned.timeout(), LearnedTimeout::kMax);
}

TEST(LearnedTimeout, AMissWidensItUntilTheNextAnswer) {
  LearnedTimeout learned;
  for (int i = 0; i < 20; ++i) learned.answered(milliseconds{100});
  EXPECT_EQ(learned.timeout(), milliseconds{400});
  learned.missed();
  EXPECT_EQ(learned.timeout(), milliseconds{800});
  for (int i = 0; i < 20; ++i) learned.missed();
  EXPECT_EQ(learned.timeout(), LearnedTimeout::kMax);
  learned.answered(milliseconds{100});
  EXPECT_EQ(learned.timeout(), milliseconds{400});
  EXPECT_EQ(LearnedTimeout{milliseconds{750}}.timeout(), milliseconds{750});
}

TEST(UnitHealth, FallsByMissesAndRisesByOneAnswer) {
  Rng rng{1};
  UnitHealth health{{.down_after = 3}};
  EXPECT_EQ(health.state(), UnitState::up);
  health.missed(milliseconds{0}, rng);
  EXPECT_EQ(health.state(), UnitState::degraded);
  health.missed(milliseconds{0}, rng);
  health.missed(milliseconds{0}, rng);
  EXPECT_EQ(health.state(), UnitState::down);
  EXPECT_GE(health.next_probe(), milliseconds{4'500});
  EXPECT_LE(health.next_probe(), milliseconds{5'500});
  health.answered();
  EXPECT_EQ(health.state(), UnitState::up);
  EXPECT_EQ(health.misses(), 0);
}

/// Two fields with registers between them, and what is read instead.
PolledUnit unit_with_a_gap() {
  PolledUnit made = unit(1);
  made.reads = {{modbus::Function::read_holding_registers, 0, 12, {0, 1}},
                {modbus::Function::read_holding_registers, 0, 2, {0}},
                {modbus::Function::read_holding_registers, 10, 2, {1}}};
  made.reads[0].may_split = true;
  made.reads[1].instead_of = made.reads[2].instead_of = 0;
  return made;
}

// A device that lacks registers between two fields: from the refusal on its fields are read one by
// one, in the same poll already, and the read that was refused never again until all begins anew.
TEST(BusPoller, ARefusedReadOfSeveralFieldsIsSplit) {
  for (const int code : {2, 3}) {
    VirtualBus bus{{unit_with_a_gap()}, [&](const BusOrder& order, const Moment&) {
                     return order.request.count > 2 ? exception(code) : Reply{};
                   }};
    const auto count_of = [&](std::size_t read) {
      return std::ranges::count_if(bus.made,
                                   [&](const auto& one) { return one.order.read == read; });
    };
    bus.run(minutes{10});
    EXPECT_EQ(count_of(0), 1);
    EXPECT_EQ(count_of(1), count_of(2));
    EXPECT_GE(count_of(1), 10);
    EXPECT_EQ(bus.made[0].order.due, bus.made[2].order.due);
    EXPECT_EQ(bus.poller.state(0), UnitState::up);
    bus.poller.begin_anew();
    bus.run(minutes{1});
    EXPECT_EQ(count_of(0), 2);
  }
}

// What answers is not split, and a device that is busy or has no such function is not helped by it.
TEST(BusPoller, OtherRefusalsSplitNothing) {
  for (const int code : {0, 1, 6, 11}) {
    VirtualBus bus{{unit_with_a_gap()}, [&](const BusOrder&, const Moment&) {
                     return code == 0 ? Reply{} : exception(code);
                   }};
    bus.run(minutes{10});
    EXPECT_TRUE(std::ranges::all_of(bus.made, [](const auto& one) { return one.order.read == 0; }));
  }
}

}  // namespace
}  // namespace recald::daemon::bus_poller_test
