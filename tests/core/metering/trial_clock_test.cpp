#include "core/metering/registers/trial_clock.hpp"

#include <gtest/gtest.h>

namespace recald::metering::trial_clock_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(TrialClock, TwoProgramsThatReadTheSameTextAgreeOnTheTime) {
  const auto clock = parse_trial_clock("2026-01-30T00:00:00Z@1769900000x600");
  ASSERT_TRUE(clock.has_value()) << clock.error().message;
  const TrialClock::Milliseconds real{seconds{1769900000} + milliseconds{2'500}};
  EXPECT_EQ(to_string(std::chrono::floor<seconds>(clock->simulated(real))), "2026-01-30T00:25:00Z");
}

TEST(TrialClock, BeforeItsAnchorItShowsAnEarlierTime) {
  const auto clock = parse_trial_clock("2026-01-30T00:00:00Z@1769900000x60");
  ASSERT_TRUE(clock.has_value());
  const TrialClock::Milliseconds real{seconds{1769899999}};
  EXPECT_EQ(to_string(std::chrono::floor<seconds>(clock->simulated(real))), "2026-01-29T23:59:00Z");
}

// A poll that is due at a boundary must see the boundary's time when it wakes.
TEST(TrialClock, NobodyWakesBeforeTheInstantThatIsWaitedFor) {
  for (const double speed : {0.5, 1.0, 7.0, 600.0, 29'999.0}) {
    const TrialClock clock{.start = Instant{}, .anchor = Instant{}, .speed = speed};
    for (const milliseconds wait : {milliseconds{1}, milliseconds{900'000}}) {
      const double real_ns = static_cast<double>(clock.real_wait(wait).count());
      EXPECT_GE(real_ns * speed, static_cast<double>(wait.count()) * 1e6) << speed;
      EXPECT_LT(real_ns * speed, static_cast<double>(wait.count()) * 1e6 + 2.0 * speed) << speed;
    }
  }
}

TEST(TrialClock, EveryOtherTextIsRefusedAndTheFormIsShown) {
  for (const char* text :
       {"", "600", "2026-01-30T00:00:00Z", "2026-01-30T00:00:00Z@1769900000", "@x",
        "2026-01-30T00:00:00Z@1769900000x", "2026-01-30T00:00:00Z@1769900000x0",
        "2026-01-30T00:00:00Z@1769900000x-1", "2026-01-30T00:00:00Z@1769900000xnan",
        "2026-01-30T00:00:00Z@1769900000x1e9", "2026-02-30T00:00:00Z@1769900000x1",
        "2026-01-30T24:00:00Z@1769900000x1", "2026-01-30 00:00:00Z@1769900000x1",
        "2026-01-30T00:00:00@1769900000x1", "2026-01-30T00:00:00Z@17x69900000x1",
        "2026-01-30T00:00:00Z@-5x1", "2026-01-30T00:00:00Z@1769900000x1 "}) {
    const auto clock = parse_trial_clock(text);
    ASSERT_FALSE(clock.has_value()) << text;
    EXPECT_EQ(clock.error().code, ErrorCode::malformed);
    EXPECT_NE(clock.error().message.find("START@ANCHORxSPEED"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace recald::metering::trial_clock_test
