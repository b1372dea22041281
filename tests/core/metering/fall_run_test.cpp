/// Registers that go back again and again, beside those that only jitter. Each case is drawn.
#include "core/metering/registers/fall_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "core/metering/registers/interval_book.hpp"
#include "core/metering/registers/placement.hpp"
#include "month_builder.hpp"

namespace recald::metering::fall_run_test {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::utc;
using Random = std::mt19937_64;

constexpr int kCases = 24;
const Instant kStart = utc(2024, 3, 1);

template <class T>
T one_of(Random& random, std::initializer_list<T> choices) {
  return std::data(choices)[random() % choices.size()];
}
int whole(Random& random, int first, int last) {
  return std::uniform_int_distribution{first, last}(random);
}
double between(Random& random, double low, double high) {
  return std::uniform_real_distribution{low, high}(random);
}

/// A register that is polled; what its intervals are in the end.
struct Polled {
  explicit Polled(Random& random)
      : poll{one_of(random, {seconds{10}, seconds{60}, seconds{300}, seconds{900}})},
        settings{one_of(random, {50.0, 400.0, 4000.0}), one_of(random, {0.001, 0.01, 0.1, 1.0})} {}

  void read(double value_kWh) {
    if (!fallen && value_kWh < last_kWh) fallen = now - poll;
    last_kWh = value_kWh;
    CounterStep step = advance(std::move(state), {now, value_kWh}, settings);
    const BookingRules rules{.sample_gap_max = 2 * poll};
    for (const BookedInterval& one : book_intervals(book, 0, step, rules)) {
      const auto known = intervals.find(one.reading.start);
      const auto placed =
          place(known == intervals.end() ? std::nullopt : std::optional{known->second}, one.reading,
                one.supersedes);
      if (placed == Placement::first || placed == Placement::replaces) {
        intervals[one.reading.start] = one.reading;
      }
    }
    if (step.event == CounterEvent::no_total) ++verdicts;
    state = std::move(step.state);
    now += poll;
  }
  [[nodiscard]] double steps(double value_kWh) const {
    return settings.resolution_kWh * std::floor(value_kWh / settings.resolution_kWh + 1e-9);
  }
  /// The most that one read period explains.
  [[nodiscard]] double one_period_kWh() const { return rise_max_kWh(poll, settings); }
  [[nodiscard]] int count(Validity validity, Instant from = Instant::min()) const {
    return static_cast<int>(std::ranges::count_if(intervals, [&](const auto& one) {
      return one.first >= from && one.second.validity == validity;
    }));
  }

  seconds poll;
  CounterSettings settings;
  CounterState state;
  IntervalBook book;
  std::map<Instant, Reading> intervals;
  Instant now = kStart;
  std::optional<Instant> fallen;  ///< The read before the first fall.
  double last_kWh = 0.0;
  int verdicts = 0;
};

// What was counted since the last read, whatever its size: told once, and no interval is `ok`.
TEST(FallRun, ARegisterThatRestartsAtEachReadIsNoTotal) {
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Polled meter{random};
    const double most_kWh = std::max(2.0 * meter.settings.resolution_kWh,
                                     between(random, 0.0, 0.9) * meter.one_period_kWh());
    for (int i = 0; i < 120; ++i) meter.read(meter.steps(between(random, 0.0, most_kWh)));
    while (meter.now < kStart + hours{6}) {
      meter.read(meter.steps(between(random, 0.0, most_kWh)));
    }
    EXPECT_EQ(meter.verdicts, 1);
    const Instant settled = kStart + 4 * std::max(meter.poll, seconds{900});
    EXPECT_EQ(meter.count(Validity::ok, std::max(settled, *meter.fallen)), 0);
    EXPECT_GT(meter.count(Validity::suspect), 3);
  }
}

// 0, 1, 2, 0 …: the falls are no deeper than jitter is, and it climbs in smaller steps.
TEST(FallRun, ASmallSawtoothIsNoTotalAtAnyLevel) {
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Polled meter{random};
    const double level_kWh = meter.steps(one_of(random, {0.0, 10.0, 5000.0, 2e5}));
    const int reads_a_step = whole(random, 1, 3);
    const int first = whole(random, 0, 2);
    for (int i = 0; i < 1200; ++i) {
      const int place = (first + i / reads_a_step) % 3;
      meter.read(level_kWh + place * meter.settings.resolution_kWh);
    }
    EXPECT_EQ(meter.verdicts, 1);
    EXPECT_EQ(meter.count(Validity::ok, *meter.fallen), 0);
    EXPECT_GT(meter.count(Validity::suspect), 3);
  }
}

double noise_steps(Random& random, int kind) {
  if (kind == 0) return whole(random, -1, 1);
  if (kind == 1) return -(whole(random, 0, 9) == 0);
  return whole(random, -1, 0);
}

// A total that is read a step too high or too low, under a load, a small one or none, for a week.
TEST(FallRun, ATotalMayJitter) {
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Polled meter{random};
    const int kind = whole(random, 0, 2);
    const double r_kWh = meter.settings.resolution_kWh;
    const double load_kW = one_of(random, {0.0, 0.2 * r_kWh, 3.0 * r_kWh, 0.01, 0.3}) *
                           one_of(random, {1.0, std::min(meter.settings.rated_kW, 20.0)});
    const double begin_kWh = meter.one_period_kWh() + between(random, 1.0, 1e5);
    const double used_kW = std::min(load_kW, meter.settings.rated_kW);
    while (meter.now < kStart + hours{24 * 7}) {
      const double h = in_hours(meter.now - kStart);
      meter.read(meter.steps(begin_kWh + used_kW * h) + r_kWh * noise_steps(random, kind));
    }
    EXPECT_EQ(meter.verdicts, 0);
    EXPECT_EQ(meter.count(Validity::missing), 0);
    double sum_kWh = 0.0;
    for (const auto& [start, reading] : meter.intervals) sum_kWh += reading.mean_kW * 0.25;
    EXPECT_NEAR(sum_kWh, used_kW * 7 * 24, 5.0 * r_kWh + 0.5 * used_kW);
  }
}

// A meter that was just installed: it jitters within what one read period explains, and gets on.
TEST(FallRun, ANewTotalMayJitter) {
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Polled meter{random};
    const double r_kWh = meter.settings.resolution_kWh;
    const double load_kW =
        std::min(0.5 * meter.settings.rated_kW, between(random, 4.0, 40.0) * r_kWh);
    while (meter.now < kStart + hours{24 * 2}) {
      const double kWh = 5 * r_kWh + load_kW * in_hours(meter.now - kStart);
      meter.read(meter.steps(kWh) + r_kWh * noise_steps(random, whole(random, 0, 2)));
    }
    EXPECT_EQ(meter.verdicts, 0);
    EXPECT_EQ(meter.count(Validity::missing), 0);
  }
}

// Its highest read is below what a load could have counted since the last, and nothing counts yet.
TEST(FallRun, ANewTotalWithoutALoadMayJitterToo) {
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Polled meter{random};
    const double r_kWh = meter.settings.resolution_kWh;
    const double begin_kWh =
        std::max(5 * r_kWh, between(random, 0.1, 0.9) * meter.one_period_kWh());
    const double load_kW = between(random, 0.01, 0.3) * meter.settings.rated_kW;
    while (meter.now < kStart + hours{24 * 4}) {
      const auto loaded = std::max(meter.now - kStart - hours{24}, seconds{0});
      const double kWh = begin_kWh + load_kW * in_hours(std::chrono::floor<seconds>(loaded));
      meter.read(meter.steps(kWh) + r_kWh * noise_steps(random, whole(random, 1, 2)));
    }
    EXPECT_EQ(meter.verdicts, 0);
    EXPECT_EQ(meter.count(Validity::missing), 0);
  }
}

// Nights of a solar plant, days without a load, a reset each day, an exchange each day.
TEST(FallRun, StandingAndResetsAreNoFallsAgainAndAgain) {
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Polled meter{random};
    const bool is_reset_daily = whole(random, 0, 1) == 1;
    const double by_day_kW = whole(random, 0, 1) * 0.3 * meter.settings.rated_kW;
    double kWh = one_of(random, {0.0, 0.3 * meter.one_period_kWh(), 7000.0});
    while (meter.now < kStart + hours{24 * 20}) {
      const auto time_of_day = (meter.now - kStart) % hours{24};
      if (time_of_day > hours{8} && time_of_day < hours{16}) {
        kWh += by_day_kW * in_hours(meter.poll);
      }
      if (is_reset_daily && time_of_day == seconds{0}) kWh = 0.0;
      meter.read(meter.steps(kWh));
    }
    EXPECT_EQ(meter.verdicts, 0);
  }
}

// The map is mended, or the device: the total counts again.
TEST(FallRun, ATotalInItsPlaceIsCounted) {
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Polled meter{random};
    for (int i = 0; i < 600 || meter.now < kStart + hours{2}; ++i) {
      meter.read((i % 3) * meter.settings.resolution_kWh);
    }
    ASSERT_EQ(meter.verdicts, 1);
    const Instant mended = meter.now;
    const double load_kW = 0.3 * meter.settings.rated_kW;
    while (meter.now < mended + hours{24}) {
      meter.read(meter.steps(9000.0 + load_kW * in_hours(meter.now - mended)));
    }
    const Instant settled = mended + hours{2};
    EXPECT_EQ(meter.verdicts, 1);
    EXPECT_EQ(meter.count(Validity::missing, settled), 0);
    EXPECT_GT(meter.count(Validity::ok, settled), 80);
  }
}

}  // namespace
}  // namespace recald::metering::fall_run_test
