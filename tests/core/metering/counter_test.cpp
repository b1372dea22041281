#include "core/metering/registers/counter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "month_builder.hpp"

namespace recald::metering::counter_test {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;
using testing::utc;

const Instant kStart = utc(2016, 3, 1);

// 400 kW rated: at most 8.2 kWh a minute with r = 0.1 kWh; wraps at a million.
constexpr CounterSettings kSettings{400.0, 0.1, 1e6};

/// A register read at minutes, one sample after another.
struct Trace {
  CounterState state;
  std::vector<CounterBooking> bookings;
  CounterEvent event = CounterEvent::none;
  CounterSettings settings = kSettings;

  /// Energy booked by this sample, kWh; NaN spans count as nothing.
  double read(int minute, double value_kWh) {
    CounterStep step = advance(std::move(state), {kStart + minutes{minute}, value_kWh}, settings);
    state = std::move(step.state);
    event = step.event;
    double booked_kWh = 0.0;
    for (const CounterBooking& booking : step.bookings) {
      if (!std::isnan(booking.energy_kWh)) booked_kWh += booking.energy_kWh;
      bookings.push_back(booking);
    }
    return booked_kWh;
  }
  [[nodiscard]] bool at(CounterPhase phase, double baseline_kWh, int minute) const {
    return state.phase == phase && std::abs(state.baseline.value_kWh - baseline_kWh) < 1e-6 &&
           state.baseline.time == kStart + minutes{minute};
  }
};

// The trace of the state table, minute by minute: jitter, a zero that bounces, a roll-over behind
// failed reads, two days of silence, a reset. 9051 kWh in all.
TEST(Counter, TraceOfTheStateTable) {
  Trace trace;
  constexpr double near = 1e-6;
  double total_kWh = 0.0;
  EXPECT_EQ(trace.read(0, 999'960.0), 0.0);
  EXPECT_TRUE(trace.at(CounterPhase::run, 999'960.0, 0));
  EXPECT_NEAR(total_kWh += trace.read(1, 999'964.0), 4.0, near);
  EXPECT_EQ(trace.read(2, 999'963.9), 0.0);
  EXPECT_TRUE(trace.at(CounterPhase::run, 999'964.0, 2));
  EXPECT_EQ(trace.read(3, 0.0), 0.0);
  EXPECT_TRUE(trace.at(CounterPhase::low, 999'964.0, 2));
  EXPECT_NEAR(total_kWh += trace.read(4, 999'976.0), 16.0, near);
  EXPECT_EQ(trace.event, CounterEvent::bounce);
  EXPECT_TRUE(trace.at(CounterPhase::run, 999'976.0, 4));
  for (int minute = 5; minute < 9; ++minute) {
    EXPECT_EQ(trace.read(minute, testing::kBlank), 0.0);
    EXPECT_TRUE(trace.at(CounterPhase::run, 999'976.0, 4));
  }
  EXPECT_NEAR(total_kWh += trace.read(9, 3.0), 43.0, near);
  EXPECT_EQ(trace.bookings.back().reasons, Reason::rollover);
  EXPECT_TRUE(trace.at(CounterPhase::run, 3.0, 9));
  EXPECT_NEAR(total_kWh += trace.read(2889, 9003.0), 9043.0, near);
  EXPECT_EQ(trace.read(2890, 0.0), 0.0);
  EXPECT_TRUE(trace.at(CounterPhase::low, 9003.0, 2889));
  EXPECT_EQ(trace.read(2891, 4.0), 0.0);
  EXPECT_EQ(trace.state.pending->samples, 2);
  EXPECT_NEAR(total_kWh += trace.read(2892, 8.0), 9051.0, near);
  EXPECT_EQ(trace.event, CounterEvent::reset);
  EXPECT_TRUE(trace.at(CounterPhase::run, 8.0, 2892));
  const CounterBooking& unbooked = trace.bookings[trace.bookings.size() - 2];
  EXPECT_EQ(unbooked.validity, Validity::missing);
  EXPECT_EQ(unbooked.reasons, Reason::reset);
  EXPECT_EQ(unbooked.span, (TimeSpan{kStart + minutes{2889}, kStart + minutes{2890}}));
}

TEST(Counter, ARollOverOfA32BitRegister) {
  Trace trace;
  trace.settings = {400.0, 0.01, 4294967296.0 * 0.01};
  (void)trace.read(0, 42'949'670.0);
  EXPECT_NEAR(trace.read(1, 1.5), 42'949'672.96 - 42'949'670.0 + 1.5, 1e-6);
  EXPECT_EQ(trace.bookings.back().reasons, Reason::rollover);
}

// counter_zero_bounce: 0 for two reads, then the old line; all of its energy is booked once.
TEST(Counter, ZeroBounce) {
  Trace trace;
  (void)trace.read(0, 5000.0);
  EXPECT_EQ(trace.read(1, 0.0), 0.0);
  EXPECT_EQ(trace.read(2, 0.0), 0.0);
  EXPECT_NEAR(trace.read(3, 5012.0), 12.0, 1e-9);
  EXPECT_EQ(trace.event, CounterEvent::bounce);
}

// counter_minus_one_tick: the last digit goes back by one and on again.
TEST(Counter, MinusOneTick) {
  Trace trace;
  (void)trace.read(0, 5000.0);
  EXPECT_EQ(trace.read(1, 4999.9), 0.0);
  EXPECT_EQ(trace.event, CounterEvent::none);
  EXPECT_NEAR(trace.read(2, 5001.0), 1.0, 1e-9);
}

// counter_true_reset: it stays low and counts from there; confirmed by the third sample, and what
// it counted before that is not lost.
TEST(Counter, TrueReset) {
  Trace trace;
  (void)trace.read(0, 5000.0);
  EXPECT_EQ(trace.read(1, 0.0), 0.0);
  EXPECT_EQ(trace.read(2, 4.0), 0.0);
  EXPECT_NEAR(trace.read(3, 8.0), 8.0, 1e-9);
  EXPECT_EQ(trace.event, CounterEvent::reset);
}

// rollover_decimal: a register of six digits.
TEST(Counter, RolloverDecimal) {
  Trace trace;
  (void)trace.read(0, 999'998.5);
  EXPECT_NEAR(trace.read(1, 2.0), 3.5, 1e-9);
  EXPECT_EQ(trace.bookings.back().reasons, Reason::rollover);
}

// rollover_1e12: a 64-bit float in Wh that overflows at 1.0e12, as the PAC3200's does. Its step
// there is 0.0001 Wh, so nothing is lost in the difference.
TEST(Counter, Rollover1e12) {
  Trace trace;
  trace.settings = {400.0, 1e-7, 1e9};
  (void)trace.read(0, 1e9 - 1.25);
  EXPECT_NEAR(trace.read(1, 2.75), 4.0, 1e-6);
  EXPECT_EQ(trace.bookings.back().reasons, Reason::rollover);
}

TEST(Counter, AJumpIsNeverBooked) {
  Trace trace;
  (void)trace.read(0, 100.0);
  EXPECT_EQ(trace.read(1, 53'800.0), 0.0);
  EXPECT_EQ(trace.state.phase, CounterPhase::high);
  EXPECT_EQ(trace.read(2, 53'804.0), 0.0);
  EXPECT_NEAR(trace.read(3, 53'808.0), 8.0, 1e-9);
  EXPECT_EQ(trace.event, CounterEvent::jump);
}

// A gateway serves another register for five minutes, then the old one again: what was booked on
// the false line is superseded by the true difference.
TEST(Counter, TheOldLineIsRestored) {
  Trace trace;
  (void)trace.read(0, 5000.0);
  for (int minute = 1; minute <= 5; ++minute) (void)trace.read(minute, 10.0 + minute);
  EXPECT_TRUE(trace.at(CounterPhase::run, 15.0, 5));
  for (int minute = 6; minute <= 8; ++minute) (void)trace.read(minute, 5000.0 + 4.0 * minute);
  EXPECT_EQ(trace.event, CounterEvent::restored);
  const CounterBooking& difference = trace.bookings[trace.bookings.size() - 2];
  EXPECT_TRUE(difference.supersedes);
  EXPECT_EQ(difference.validity, Validity::scaled);
  EXPECT_NEAR(difference.energy_kWh, 24.0, 1e-9);
  EXPECT_NEAR(trace.bookings.back().energy_kWh, 8.0, 1e-9);  // measured since it is back
  EXPECT_TRUE(trace.at(CounterPhase::run, 5032.0, 8));
}

TEST(Counter, TheOldLineExpiresAfterAWeekOfCounting) {
  Trace trace;
  (void)trace.read(0, 50'000.0);
  for (int minute = 1; minute <= 3; ++minute) (void)trace.read(minute, 10.0 + minute);
  const int later = 8 * 24 * 60;
  (void)trace.read(later, 500.0);
  for (int minute = 1; minute <= 3; ++minute) {
    (void)trace.read(later + minute, 50'500.0 + minute);
  }
  EXPECT_EQ(trace.event, CounterEvent::jump);
}

TEST(Counter, WrapsThatCannotBeCountedAreMissing) {
  Trace trace;
  trace.settings.modulus_kWh = 1000.0;
  (void)trace.read(0, 10.0);
  EXPECT_EQ(trace.read(200, 20.0), 0.0);  // 1600 kWh were possible in 200 minutes
  EXPECT_EQ(trace.bookings.back().reasons, Reason::wrap);
  EXPECT_TRUE(trace.at(CounterPhase::run, 20.0, 200));
}

TEST(Counter, NonsenseForAnHourIsErratic) {
  Trace trace;
  (void)trace.read(0, 50'000.0);
  bool erratic = false;
  for (int minute = 1; minute <= 12; ++minute) {
    (void)trace.read(minute, minute % 2 == 0 ? 10.0 + 997.0 * minute : 900'000.0 - 991.0 * minute);
    erratic = erratic || trace.event == CounterEvent::erratic;
  }
  EXPECT_TRUE(erratic);
  EXPECT_TRUE(trace.bookings.empty());
}

// Three samples say the same, but within seconds: a gateway that answers from a stale cache does so
// too. What they say is believed once it has been said for two minutes.
TEST(Counter, AResetTakesTwoMinutes) {
  CounterState state;
  const auto read = [&](seconds after, double value_kWh) {
    CounterStep step = advance(std::move(state), {kStart + after, value_kWh}, kSettings);
    state = std::move(step.state);
    return step.event;
  };
  (void)read(seconds{0}, 5000.0);
  for (int second = 10; second < 130; second += 10) {
    EXPECT_EQ(read(seconds{second}, 0.01 * second), CounterEvent::none) << second;
  }
  EXPECT_EQ(read(seconds{130}, 1.3), CounterEvent::reset);
}

// Two samples do not make a reset, however far apart.
TEST(Counter, AResetTakesThreeSamples) {
  Trace trace;
  (void)trace.read(0, 5000.0);
  (void)trace.read(1, 0.0);
  (void)trace.read(10, 0.5);
  EXPECT_EQ(trace.event, CounterEvent::none);
  EXPECT_NEAR(trace.read(11, 5012.0), 12.0, 1e-9);
  EXPECT_EQ(trace.event, CounterEvent::bounce);
}

// A load may draw a fifth more than its rating for a while, not a half more.
TEST(Counter, ARiseBeyondTheRatingIsDoubted) {
  for (const double times_rated : {1.15, 1.5}) {
    Trace trace;
    (void)trace.read(0, 5000.0);
    const double rise_kWh = times_rated * 400.0;
    EXPECT_NEAR(trace.read(60, 5000.0 + rise_kWh), times_rated < 1.2 ? rise_kWh : 0.0, 1e-9);
    EXPECT_EQ(trace.state.phase, times_rated < 1.2 ? CounterPhase::run : CounterPhase::high);
  }
}

// After an hour without a reading a register of 1000 kWh may have wrapped from 950 to 10 kWh. From
// 500 to 10 kWh it has been reset: the load cannot be told from nothing by what it might draw.
TEST(Counter, ARegisterWrapsOnlyNearItsEnd) {
  for (const double from_kWh : {950.0, 500.0}) {
    Trace trace;
    trace.settings.modulus_kWh = 1000.0;
    (void)trace.read(0, from_kWh);
    const bool wraps = from_kWh > 900.0;
    EXPECT_NEAR(trace.read(65, 10.0), wraps ? 60.0 : 0.0, 1e-9);
    EXPECT_EQ(trace.state.phase, wraps ? CounterPhase::run : CounterPhase::low);
  }
}

// Nine contradictions within an hour are a bad line; the tenth is told.
TEST(Counter, TheTenthContradictionIsErratic) {
  Trace trace;
  (void)trace.read(0, 50'000.0);
  for (int minute = 1; minute <= 11; ++minute) {
    (void)trace.read(minute, minute % 2 == 0 ? 10.0 + 997.0 * minute : 900'000.0 - 991.0 * minute);
    EXPECT_EQ(trace.event, minute == 11 ? CounterEvent::erratic : CounterEvent::none) << minute;
  }
}

TEST(Counter, AnExchangedMeterStartsAnew) {
  Trace trace;
  (void)trace.read(0, 50'000.0);
  CounterStep step = swap_meter(std::move(trace.state));
  EXPECT_EQ(step.event, CounterEvent::swapped);
  trace.state = std::move(step.state);
  EXPECT_EQ(trace.read(1, 7.0), 0.0);
  EXPECT_TRUE(trace.at(CounterPhase::run, 7.0, 1));
}

}  // namespace
}  // namespace recald::metering::counter_test
