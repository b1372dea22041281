/// The whole of ingestion on a virtual clock: buses, counters, a real store, months. What the
/// devices counted is known, so every kilowatt-hour is accounted for.
#include "daemon/gateway/run/gateway.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <ostream>

#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon::gateway_test {
namespace {

using metering::Instant;
using metering::Validity;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using testing::main_kWh;
using ::testing::Not;
using ::testing::SizeIs;

const Instant kStart = testing::kRigStart;

class GatewayTest : public ::testing::Test, protected testing::RigInMemory {
 protected:
  GatewayTest() : RigInMemory{kStart} {}

  void begin() { RigInMemory::begin(site_); }

  int count(const std::string& id, Validity validity) {
    const auto readings = stored(id, {Instant::min(), Instant::max()});
    return static_cast<int>(std::ranges::count(readings, validity, &metering::Reading::validity));
  }
  [[nodiscard]] metering::TimeSpan march() const {
    return calendar_.month_span(std::chrono::year{2024} / 3);
  }
  [[nodiscard]] double true_kWh(const metering::TimeSpan& span) const {
    return main_kWh(span.end - kStart) - main_kWh(span.begin - kStart);
  }
  [[nodiscard]] std::vector<metering::MonthlyFigure> months_of(const std::string& id) const {
    std::vector<metering::MonthlyFigure> figures;
    for (const ClosedMonth& month : closed_) {
      if (month.meter == id) figures.push_back(month.figure);
    }
    return figures;
  }

  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  SiteConfig site_ = load(testing::two_meter_site("watermark = \"2h\"\n"));
};

// Two registers of 0.1 kWh bound an energy, so a sum is known to within that.
constexpr double kTick = 0.1 + 1e-6;

TEST_F(GatewayTest, AMonthFromRegistersToFigures) {
  begin();
  loop_.run_for(days{36} + seconds{1});
  EXPECT_NEAR(stored_kWh("main", march()), true_kWh(march()), kTick);
  const auto figures = months_of("main");
  ASSERT_THAT(figures, SizeIs(2));
  EXPECT_EQ(metering::to_string(figures[1].month), "2024-03");
  EXPECT_NEAR(figures[1].daily_average_kWh, true_kWh(march()) / 31.0, kTick);
  EXPECT_EQ(figures[1].coverage, 1.0);
  EXPECT_EQ(figures[1].slots, 31 * 96 - 4);
  EXPECT_NEAR(figures[1].peak->kW, 90.0, 0.5);
  EXPECT_THAT(months_of("cooling"), SizeIs(2));
  const GatewayStatus status = gateway_->status();
  EXPECT_TRUE(status.clock_ok);
  EXPECT_FALSE(status.store.is_degraded);
  ASSERT_THAT(status.meters, SizeIs(2));
  EXPECT_EQ(status.meters[0].id, "main");
  EXPECT_EQ(status.meters[0].poll->state, UnitState::up);
  EXPECT_EQ(status.meters[0].last_interval->start, kStart + days{36} - minutes{15});
  EXPECT_NEAR(*status.meters[0].live.register_kWh, main_kWh(days{36}), 2.0);
  EXPECT_EQ(gateway_->meter_status("cooling")->live.register_kWh,
            status.meters[1].live.register_kWh);
  EXPECT_FALSE(gateway_->meter_status("lift").has_value());
}

// The monthly energy of a month with outages is that of a month without.
TEST_F(GatewayTest, OutagesCostNoEnergy) {
  devices_[1].is_silent = [](milliseconds t) {
    return (t > days{5} && t < days{5} + hours{6}) || (t > days{12} && t < days{12} + minutes{40});
  };
  begin();
  loop_.run_for(days{36});
  EXPECT_NEAR(stored_kWh("main", march()), true_kWh(march()), kTick);
  EXPECT_NEAR(months_of("main").at(1).daily_average_kWh, true_kWh(march()) / 31.0, kTick);
  EXPECT_GE(count("main", Validity::scaled), 24 + 2);
  EXPECT_LE(count("main", Validity::scaled), 24 + 2 + 26);  // until a probe finds it again
  EXPECT_EQ(count("cooling", Validity::scaled), 0);         // its neighbour lost nothing
}

// The register reads 0 for ten days around the end of March, with a restart in between, and comes
// back. Both months get the energy that it counted, and no interval of the outage is measured.
TEST_F(GatewayTest, ARegisterAtZeroForDaysIsAnOutage) {
  const milliseconds end = march().end - kStart;
  const auto truth = devices_[1].energy_kWh;
  const auto is_zero = [=](milliseconds t) { return t > end - days{5} && t < end + days{5}; };
  devices_[1].energy_kWh = [=](milliseconds t) { return is_zero(t) ? 0.0 : truth(t); };
  begin();
  loop_.run_for(end + days{1});
  begin();
  loop_.run_for(days{34});
  const metering::TimeSpan april{march().end, march().end + days{30}};
  const metering::TimeSpan both{march().begin, april.end};
  EXPECT_NEAR(stored_kWh("main", both), true_kWh(both), kTick);
  const auto outage = stored("main", {march().end - days{5} + minutes{15}, march().end + days{5}});
  EXPECT_EQ(std::ranges::count(outage, Validity::scaled, &metering::Reading::validity),
            std::ssize(outage));
  const auto figures = months_of("main");
  for (const auto& [month, month_days, span] :
       {std::tuple{"2024-03", 31, march()}, std::tuple{"2024-04", 30, april}}) {
    const auto last = std::find_if(figures.rbegin(), figures.rend(), [&](const auto& figure) {
      return metering::to_string(figure.month) == month;
    });
    ASSERT_NE(last, figures.rend());
    EXPECT_NEAR(last->daily_average_kWh, true_kWh(span) / month_days, 1.0);
    EXPECT_TRUE(last->usable) << last->unusable_because;
  }
}

// Killed without a word every few hours at odd minutes, and back after some: no interval is lost or
// doubled, and the energy is that of a run without.
TEST_F(GatewayTest, KillsCostNoEnergy) {
  begin();
  for (int kill = 0; kill < 200; ++kill) {
    loop_.run_for(hours{4} + minutes{7} + seconds{13 * kill % 60});
    gateway_.reset();
    loop_.run_for(seconds{20 + 7 * kill});
    begin();
  }
  loop_.run_for(days{1});
  EXPECT_NEAR(stored_kWh("main", march()), true_kWh(march()), kTick);
  EXPECT_EQ(count("main", Validity::missing), 0);
  ASSERT_THAT(months_of("main"), SizeIs(2));
  EXPECT_NEAR(months_of("main").at(1).daily_average_kWh, true_kWh(march()) / 31.0, kTick);
}

TEST_F(GatewayTest, AFullDiskForHoursCostsNothing) {
  begin();
  loop_.run_for(days{3});
  store_.refuses = true;
  loop_.run_for(hours{20});
  EXPECT_TRUE(gateway_->status().store.is_degraded);
  store_.refuses = false;
  loop_.run_for(days{33});
  EXPECT_FALSE(gateway_->status().store.is_degraded);
  EXPECT_EQ(gateway_->status().store.lost_intervals, 0u);
  EXPECT_NEAR(stored_kWh("main", march()), true_kWh(march()), kTick);
  EXPECT_EQ(count("main", Validity::ok), 36 * 96 + 20 * 4 - 1);  // the last one is under way
}

// A device that was silent over the end of a month comes back after the month was closed: the month
// is closed again, exact, as revision 1.
TEST_F(GatewayTest, LateAfterClose) {
  const milliseconds end = march().end - kStart;
  devices_[1].is_silent = [=](milliseconds t) { return t > end - hours{5} && t < end + hours{3}; };
  begin();
  loop_.run_for(end + days{1});
  const auto figures = months_of("main");
  ASSERT_THAT(figures, SizeIs(3));
  EXPECT_EQ(figures[1].revision, 0);
  EXPECT_LT(figures[1].coverage, 1.0);
  EXPECT_EQ(figures[2].month, figures[1].month);
  EXPECT_EQ(figures[2].revision, 1);
  // The hole reaches into April; the usual day says how it was shared (evenly it would be 0.7 off).
  EXPECT_NEAR(figures[2].daily_average_kWh, true_kWh(march()) / 31.0, 0.4);
  const auto late = std::ranges::count(stored("main", march()), true, &metering::Reading::late);
  EXPECT_GE(late, 20);
  EXPECT_THAT(*disk_.reopened(), SizeIs(0));
}

// The same, with a restart just before the device comes back: what is closed and how the load
// usually runs is known again.
TEST_F(GatewayTest, LateAfterCloseAndRestart) {
  const milliseconds end = march().end - kStart;
  devices_[1].is_silent = [=](milliseconds t) { return t > end - hours{5} && t < end + hours{3}; };
  begin();
  loop_.run_for(end + hours{2} + minutes{30});
  begin();
  loop_.run_for(hours{17});
  const auto figures = months_of("main");
  ASSERT_THAT(figures, SizeIs(3));
  EXPECT_EQ(figures[2].revision, 1);
  EXPECT_NEAR(figures[2].daily_average_kWh, true_kWh(march()) / 31.0, 0.4);
}

/// When a clock without a battery wakes up.
class DeadClock : public GatewayTest, public ::testing::WithParamInterface<Instant> {};

INSTANTIATE_TEST_SUITE_P(Years, DeadClock,
                         ::testing::Values(Instant{},
                                           std::chrono::sys_days{std::chrono::year{1980} / 1 / 6},
                                           std::chrono::sys_days{std::chrono::year{2000} / 1 / 1},
                                           std::chrono::sys_days{std::chrono::year{2106} / 2 / 7}),
                         [](const auto& made) {
                           return "of_" + metering::to_string(made.param).substr(0, 4);
                         });

// clock_1970_then_sync: a gateway without a clock battery wakes up in 1970, 2000 or wherever its
// clock begins. What it reads is kept and stamped when the time is known.
TEST_P(DeadClock, ThenSync) {
  const milliseconds off = loop_.now().wall - GetParam();
  loop_.set_wall_clock(-off);
  begin();
  loop_.run_for(hours{3});
  EXPECT_FALSE(gateway_->status().clock_ok);
  EXPECT_EQ(count("main", Validity::ok), 0);
  loop_.set_wall_clock(off);
  loop_.run_for(hours{3});
  EXPECT_TRUE(gateway_->status().clock_ok);
  EXPECT_GE(count("main", Validity::ok), 23);
  EXPECT_NEAR(stored_kWh("main", {kStart, kStart + hours{6}}),
              main_kWh(hours{6}) - main_kWh(minutes{0}), 25.0);
  EXPECT_EQ(count("main", Validity::missing), 0);
}

// Booted with a clock that looks right and is five hours ahead, until a time server is heard:
// nothing bears a wrong stamp.
TEST_F(GatewayTest, AClockThatIsAboutToBeSetIsNotBelieved) {
  bool is_settling = true;
  clock_->is_settling = [&] { return is_settling; };
  loop_.set_wall_clock(hours{5});
  begin();
  loop_.run_for(minutes{8});
  EXPECT_FALSE(gateway_->status().clock_ok);
  loop_.set_wall_clock(-hours{5});
  is_settling = false;
  loop_.run_for(hours{3} - minutes{8});
  EXPECT_TRUE(gateway_->status().clock_ok);
  EXPECT_GE(count("main", Validity::ok), 11);
  EXPECT_EQ(count("main", Validity::missing), 0);
  EXPECT_NEAR(stored_kWh("main", {kStart, kStart + hours{3}}),
              main_kWh(hours{3} - minutes{15}) - main_kWh(minutes{0}), 1.0);
  is_settling = true;  // a clock that loses its server still runs
  loop_.run_for(hours{1});
  EXPECT_TRUE(gateway_->status().clock_ok);
}

// Switched on again with a clock that is months behind what it has recorded, as from a clock chip
// that starts with its firmware's date: nothing is stamped a second time.
TEST_F(GatewayTest, AClockBehindTheStoreIsHeldUntilATimeServerIsHeard) {
  begin();
  loop_.run_for(days{40});
  const int before = count("main", Validity::ok);
  bool is_heard = false;
  clock_->is_synchronised = [&] { return is_heard; };
  loop_.set_wall_clock(-days{30});
  begin();
  loop_.run_for(hours{2});
  EXPECT_THAT(gateway_->clock_doubt(),
              ::testing::HasSubstr("the store has readings until 2024-04-"));
  EXPECT_EQ(count("main", Validity::ok), before);
  is_heard = true;  // and it agrees with the clock: the store was wrong
  loop_.run_for(hours{2});
  EXPECT_EQ(gateway_->clock_doubt(), "");
}

TEST_F(GatewayTest, StepBack20Min) {
  begin();
  loop_.run_for(hours{3} + minutes{5});
  loop_.set_wall_clock(-minutes{20});
  loop_.run_for(hours{3});
  // 2:45 to 3:15 is doubted; all else is what it was, and nothing is there twice.
  EXPECT_EQ(count("main", Validity::ok) + count("main", Validity::missing),
            static_cast<int>((hours{5} + minutes{45}) / minutes{15}) - 1);
  EXPECT_LE(count("main", Validity::missing), 2);
  const auto events = disk_.events(10);
  EXPECT_THAT(*events, Contains(Field(&StoreEvent::kind, "clock_set")));
}

TEST_F(GatewayTest, StepForward2H) {
  begin();
  loop_.run_for(hours{3} + minutes{5});
  loop_.set_wall_clock(hours{2});
  loop_.run_for(hours{3});
  EXPECT_GE(count("main", Validity::missing), 8);
  EXPECT_LE(count("main", Validity::missing), 10);
  EXPECT_EQ(count("main", Validity::scaled), 0);
  const auto events = disk_.events(10);
  EXPECT_THAT(*events, Not(Contains(Field(&StoreEvent::kind, "counter_jump"))));
}

TEST_F(GatewayTest, ADeadMeterIsSeenAndItsNeighbourIsNot) {
  devices_[1].is_silent = [](milliseconds) { return true; };
  begin();
  loop_.run_for(hours{6});
  const GatewayStatus status = gateway_->status();
  EXPECT_EQ(status.meters[0].poll->state, UnitState::down);
  EXPECT_FALSE(status.meters[0].last_interval.has_value());
  EXPECT_EQ(status.meters[1].poll->state, UnitState::up);
  // Its first poll waited for a time-out, and the last interval is under way.
  EXPECT_EQ(count("cooling", Validity::ok), 24 - 2);
}

// A gateway in the field answers "illegal data address" while it starts.
TEST_F(GatewayTest, RegistersRefusedForAWhileCostNoEnergy) {
  // Between two polls: this unit is due a quarter of a minute after the full one.
  devices_[1].exception = [](milliseconds t) {
    return t > minutes{100} + seconds{20} && t < minutes{101} ? 0x02 : 0;
  };
  devices_[2].exception = [](milliseconds t) { return t > hours{3} && t < hours{5} ? 0x04 : 0; };
  begin();
  loop_.run_for(minutes{100} + seconds{30});
  EXPECT_EQ(gateway_->status().meters[0].poll->state, UnitState::up);  // not asked meanwhile
  loop_.run_for(hours{4} - minutes{100});
  const GatewayStatus status = gateway_->status();
  EXPECT_EQ(status.meters[1].poll->state, UnitState::degraded);
  EXPECT_THAT(status.meters[1].poll->refused,
              ElementsAre(Field(&RefusedRegisters::exception, 0x04)));
  loop_.run_for(hours{4});
  EXPECT_THAT(gateway_->status().meters[1].poll->refused, SizeIs(0));
  EXPECT_NEAR(stored_kWh("cooling", {kStart, kStart + hours{7}}), 700.0, kTick);
  EXPECT_EQ(count("main", Validity::scaled), 0);
  const auto events = disk_.events(10);
  EXPECT_THAT(*events, Contains(Field(&StoreEvent::kind, "registers_refused")).Times(1));
  EXPECT_THAT(*events, Contains(Field(&StoreEvent::kind, "registers_answer")).Times(1));
}

struct Unserved {
  const char* name;
  int exception;
  const char* event;
  friend void PrintTo(const Unserved& unserved, std::ostream* out) { *out << unserved.name; }
};
class UnservedForHours : public GatewayTest, public ::testing::WithParamInterface<Unserved> {};

// Now and then a device is busy, and a gateway misses one. For minutes on end people are told, once
// and then counted.
TEST_P(UnservedForHours, IsToldOnceAndThenCounted) {
  const auto is_unserved = [](milliseconds t) {
    return (t > minutes{30} && t < minutes{33}) || (t > hours{1} && t < hours{3}) ||
           (t > hours{5} && t < hours{6});
  };
  devices_[2].exception = [=](milliseconds t) { return is_unserved(t) ? GetParam().exception : 0; };
  const auto told = [&] {
    auto events = disk_.events(100).value();
    std::erase_if(events, [](const StoreEvent& one) { return one.kind != GetParam().event; });
    return events;
  };
  begin();
  loop_.run_for(minutes{50});
  EXPECT_THAT(told(), SizeIs(0));
  loop_.run_for(minutes{70});
  const GatewayStatus status = gateway_->status();
  EXPECT_NE(status.meters[1].poll->state, UnitState::up);
  ASSERT_THAT(status.meters[1].poll->refused, SizeIs(1));
  EXPECT_EQ(status.meters[1].poll->refused[0].exception, GetParam().exception);
  EXPECT_GE(status.meters[1].poll->refused[0].since, kStart + hours{1});
  ASSERT_THAT(told(), SizeIs(1));
  EXPECT_EQ(told()[0].subject, "cooling");
  EXPECT_EQ(told()[0].count, 1);
  loop_.run_for(hours{2} + minutes{30});
  EXPECT_EQ(gateway_->status().meters[1].poll->state, UnitState::up);
  EXPECT_THAT(gateway_->status().meters[1].poll->refused, SizeIs(0));
  EXPECT_THAT(disk_.events(100).value(),
              Contains(Field(&StoreEvent::kind, "registers_answer")).Times(1));
  loop_.run_for(hours{2});
  ASSERT_THAT(told(), SizeIs(1));
  EXPECT_EQ(told()[0].count, 2);
  EXPECT_NEAR(stored_kWh("cooling", {kStart, kStart + hours{6}}), 600.0, kTick);
}

INSTANTIATE_TEST_SUITE_P(Exceptions, UnservedForHours,
                         ::testing::Values(Unserved{"acknowledged_0x05", 0x05, "device_busy"},
                                           Unserved{"busy_0x06", 0x06, "device_busy"},
                                           Unserved{"no_path_0x0A", 0x0A, "device_unreachable"},
                                           Unserved{"no_response_0x0B", 0x0B,
                                                    "device_unreachable"}),
                         [](const auto& given) { return given.param.name; });

// A device that refuses and answers in turn must not fill the list of events.
TEST_F(GatewayTest, RegistersRefusedAgainAndAgainAreToldOnceAnHour) {
  devices_[2].exception = [](milliseconds t) { return t / minutes{12} % 2 == 1 ? 0x02 : 0; };
  begin();
  loop_.run_for(hours{3});  // it begins to refuse seven times: after 12 minutes, 36, 60, 84 …
  const auto events = disk_.events(100).value();
  EXPECT_THAT(events, Contains(Field(&StoreEvent::kind, "registers_refused")).Times(3));
  EXPECT_THAT(events, Contains(Field(&StoreEvent::kind, "registers_answer")).Times(3));
}

// A page of the store that went bad where a counter's state is: that counter pays, nobody else.
TEST_F(GatewayTest, AStateThatCannotBeReadBeginsThatCounterAnew) {
  begin();
  loop_.run_for(hours{2});
  ASSERT_TRUE(disk_.database()
                  .execute("UPDATE register SET state = '{]', sum = NULL WHERE meter = 0")
                  .has_value());
  begin();
  loop_.run_for(hours{2} + minutes{1});
  const auto events = disk_.events(10).value();
  ASSERT_THAT(events, Contains(Field(&StoreEvent::kind, "counter_state_lost")).Times(1));
  EXPECT_EQ(events.back().subject, "main");
  EXPECT_EQ(count("cooling", Validity::ok), 16);
  EXPECT_GE(count("main", Validity::ok), 13);
  EXPECT_NEAR(stored_kWh("cooling", {kStart, kStart + hours{3}}), 300.0, kTick);
}

TEST_F(GatewayTest, AStateThatIsGoneIsToldOf) {
  begin();
  loop_.run_for(hours{2});
  ASSERT_TRUE(disk_.database().execute("DELETE FROM register WHERE meter = 0").has_value());
  begin();
  loop_.run_for(hours{2});
  begin();  // it has one again
  const auto events = disk_.events(10).value();
  ASSERT_THAT(events, Contains(Field(&StoreEvent::kind, "counter_state_lost")).Times(1));
  EXPECT_EQ(events.back().subject, "main");
  EXPECT_THAT(events.back().text, ::testing::HasSubstr("is no longer in the store"));
}

// Readings from before the first poll, as an import brings them, have no state and never had one.
TEST_F(GatewayTest, AMeterThatWasNeverPolledHasLostNothing) {
  const std::uint32_t main = disk_.meter_number("main", seconds{900}).value();
  ASSERT_TRUE(disk_.commit({.intervals = {{{main, kStart - days{1}, 1.0}}}}).has_value());
  begin();
  loop_.run_for(hours{1});
  EXPECT_THAT(disk_.events(10).value(),
              ::testing::Not(Contains(Field(&StoreEvent::kind, "counter_state_lost"))));
}

TEST_F(GatewayTest, AStoreThatCannotBeReadAtTheStartIsToldAtOnce) {
  store_.refuses = true;
  const auto opened = open(site_);
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::io_failed);
}

}  // namespace
}  // namespace recald::daemon::gateway_test
