/// When units are polled: evenly over the period, and at every boundary.
#include "daemon/gateway/poll/poll_times.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/random/rng.hpp"
#include "tests/support/seed.hpp"

namespace recald::daemon::poll_times_test {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

const WallTime kNoon = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1} + hours{12};

std::vector<WallTime> due_times(const PollTimes& times, WallTime from, milliseconds length) {
  std::vector<WallTime> due;
  for (WallTime t = times.after(from); t <= from + length; t = times.after(t)) due.push_back(t);
  return due;
}

TEST(PollTimes, WithoutAPhaseTheyAreMultiplesAndBoundaries) {
  const PollTimes times{seconds{40}, minutes{15}, 0.0};
  EXPECT_EQ(times.after(kNoon + seconds{860}), kNoon + seconds{880});
  EXPECT_EQ(times.after(kNoon + seconds{880}), kNoon + minutes{15});
  EXPECT_EQ(times.after(kNoon + minutes{15}), kNoon + seconds{920});
}

TEST(PollTimes, APhaseShiftsRegularPollsWithinHalfAPeriod) {
  const PollTimes later{seconds{60}, minutes{15}, 0.25};
  EXPECT_EQ(later.after(kNoon + seconds{1}), kNoon + seconds{75});
  EXPECT_EQ(later.after(kNoon + seconds{75}), kNoon + seconds{135});
  const PollTimes earlier{seconds{60}, minutes{15}, 0.75};
  EXPECT_EQ(earlier.after(kNoon + seconds{1}), kNoon + seconds{45});
}

// Whatever the phase: one poll for each multiple, each boundary read in the second after it, and
// no two polls so far apart that a boundary between them would be an estimate (two periods).
TEST(PollTimes, BoundariesAreKeptAndNoGapIsLong) {
  const recald::testing::Seed seed;
  Rng rng{seed.value(), 0};
  for (const seconds period : {seconds{2}, seconds{10}, seconds{60}, seconds{300}, seconds{900}}) {
    for (const seconds interval : {seconds{300}, seconds{900}, seconds{3600}}) {
      if (interval % period != seconds{0} && period % interval != seconds{0}) continue;
      const PollTimes times{period, interval, rng.uniform(0.0, 1.0)};
      const auto due = due_times(times, kNoon - minutes{5}, hours{6});
      const milliseconds step = std::min(period, interval);
      EXPECT_LE(std::abs(std::ssize(due) - hours{6} / step), 1);
      for (std::size_t i = 1; i < due.size(); ++i) {
        EXPECT_GT(due[i] - due[i - 1], milliseconds{0});
        EXPECT_LE(due[i] - due[i - 1], step * 3 / 2 + seconds{1});
        EXPECT_LT(due[i] - due[i - 1], 2 * period);
      }
      for (WallTime boundary = kNoon; boundary < kNoon + hours{5}; boundary += interval) {
        const auto in_time = std::ranges::count_if(
            due, [&](WallTime t) { return t >= boundary && t < boundary + seconds{1}; });
        EXPECT_EQ(in_time, 1) << period.count() << " of " << interval.count();
      }
    }
  }
}

// The units of one bus have equal distances within a quarter of a period.
TEST(PollTimes, UnitsOfABusFollowEachOther) {
  constexpr std::size_t kUnits = 30;
  std::vector<milliseconds> due;
  for (std::size_t i = 0; i < kUnits; ++i) {
    const PollTimes times{seconds{60}, minutes{15}, poll_phase("plant", i, kUnits)};
    due.push_back(times.after(kNoon + minutes{5}) - kNoon);
  }
  for (std::size_t i = 1; i < kUnits; ++i) {
    const milliseconds apart = (due[i] - due[i - 1] + seconds{60}) % seconds{60};
    EXPECT_NEAR(static_cast<double>(apart.count()), 500.0, 1.0) << i;
  }
}

// A thousand meters on many buses: each tenth of the period has about a tenth of the polls, and
// each tenth of the time after a boundary a tenth of the reads there. Names, not chance, decide.
TEST(PollTimes, AThousandMetersFallEvenly) {
  for (const std::size_t units : {1u, 4u, 20u}) {
    const std::size_t buses = 1'000 / units;
    std::vector<int> regular(10);
    std::vector<int> at_boundary(10);
    for (std::size_t bus = 0; bus < buses; ++bus) {
      for (std::size_t unit = 0; unit < units; ++unit) {
        const auto phase = poll_phase("b" + std::to_string(bus), unit, units);
        const PollTimes times{seconds{10}, minutes{15}, phase};
        const WallTime t = times.after(kNoon + minutes{5});
        ++regular[static_cast<std::size_t>(t.time_since_epoch() % seconds{10} / seconds{1})];
        ++at_boundary[static_cast<std::size_t>(times.boundary_delay() / milliseconds{80})];
      }
    }
    // A tenth holds 100 of independent buses with a standard deviation of at most
    // sqrt(100 * units); without phases all 1 000 would be in one.
    const int most = 100 + 3 * static_cast<int>(10.0 * std::sqrt(units));
    EXPECT_THAT(regular, ::testing::Each(::testing::Lt(most))) << units;
    EXPECT_THAT(at_boundary, ::testing::Each(::testing::Lt(most))) << units;
  }
}

}  // namespace
}  // namespace recald::daemon::poll_times_test
