/// A meter watched by the day, in worlds of its own: curved load, noise that lasts for days, months
/// that are off for no reason that anybody knows.
#include "core/drift/watch/daily_watch.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random/rng.hpp"

namespace recald::drift::daily_watch_test {
namespace {

using metering::Day;
using std::chrono::days;
using std::chrono::sys_days;

constexpr int kLearning = 12;
constexpr int kMonths = 60;

sys_days first_day() { return sys_days{std::chrono::year{2020} / 1 / 1}; }

/// @param step, from  What is used more from a day on, as a share.
std::vector<WatchedDay> world(std::uint64_t seed, double step = 0.0, int from = 0) {
  Rng rng{seed};
  std::vector<WatchedDay> all;
  double weather = 0.0;
  double noise = 0.0;
  double month_off = 0.0;
  unsigned last_month = 0;
  int month = -1;
  for (int i = 0; month < kMonths; ++i) {
    const Day date{first_day() + days{i}};
    if (static_cast<unsigned>(date.month()) != last_month) {
      last_month = static_cast<unsigned>(date.month());
      month_off = 0.02 * rng.normal();
      if (++month == kMonths) break;
    }
    weather = 0.7 * weather + 2.5 * rng.normal();
    const double t = 11.0 - 12.0 * std::cos(2.0 * std::numbers::pi * i / 365.25) + weather;
    const bool works = std::chrono::weekday{sys_days{date}}.c_encoding() % 6 != 0;
    noise = 0.4 * noise + 0.04 * rng.normal();
    // What cools is a parabola, which the regression can only meet with straight pieces.
    const double load = (works ? 60.0 : 25.0) + 0.12 * std::pow(std::max(0.0, t - 8.0), 2.0);
    const double factor = i >= from ? 1.0 + step : 1.0;
    all.push_back({.date = date,
                   .month = month,
                   .is_workday = works,
                   .dry_bulb_C = t,
                   .humidity_ratio = 0.008,
                   .modelled_kW = works ? 55.0 : 30.0,
                   .measured_kW = factor * load * (1.0 + noise + month_off)});
  }
  return all;
}

std::vector<DailyAlarm> alarms_of(std::vector<WatchedDay> all, const DailyWatchOptions& options) {
  DailyWatch watch{std::move(all), kLearning, options};
  EXPECT_TRUE(watch.is_able());
  std::vector<DailyAlarm> alarms;
  for (int month = kLearning; month < kMonths; ++month) {
    if (auto alarm = watch.evaluate(month)) alarms.push_back(*alarm);
  }
  return alarms;
}

// 100 worlds of four years each.
TEST(DailyWatch, QuietMetersKeepToTheStatedRate) {
  const DailyWatchOptions options;
  int alarms = 0;
  constexpr int kWorlds = 100;
  for (int seed = 0; seed < kWorlds; ++seed) {
    alarms +=
        static_cast<int>(alarms_of(world(100 + static_cast<std::uint64_t>(seed)), options).size());
  }
  RecordProperty("alarms", alarms);
  EXPECT_LE(alarms, kWorlds * (kMonths - kLearning) * 30.44 / options.days_between_false_alarms);
}

TEST(DailyWatch, AStepIsFoundWithinSixWeeksAndDatedToDays) {
  constexpr int kFrom = 31 + 28 + 31 + 366 + 365 + 10;  // 10 April of the third year
  int dated = 0;
  int alone = 0;
  for (const double step : {0.15, -0.15}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const auto alarms = alarms_of(world(seed, step, kFrom), {});
      ASSERT_FALSE(alarms.empty()) << seed;
      const sys_days change = first_day() + days{kFrom};
      const DailyAlarm& first = alarms.front();
      EXPECT_GE(sys_days{first.raised}, change) << seed;
      EXPECT_LE(sys_days{first.raised}, change + days{45}) << seed;
      EXPECT_LE(first.since_earliest, first.since);
      EXPECT_LE(first.since, first.since_latest);
      EXPECT_EQ(first.direction, step > 0.0 ? 1 : -1) << seed;
      EXPECT_NEAR(first.excess, step, 0.06) << seed;
      dated += sys_days{first.since_earliest} <= change && change <= sys_days{first.since_latest};
      alone += alarms.size() == 1;
    }
  }
  EXPECT_GE(dated, 16);  // intervals of 90 %, 20 of them
  // The new level is learnt: it is one change and no series of them.
  EXPECT_GE(alone, 18);
}

TEST(DailyWatch, AFewOddDaysAreNoChange) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto all = world(seed);
    for (std::size_t i = 800; i < 804; ++i) all[i].measured_kW *= 0.2;  // a storm
    const auto without = alarms_of(world(seed), {});
    EXPECT_EQ(alarms_of(std::move(all), {}).size(), without.size()) << seed;
  }
}

TEST(DailyWatch, DaysWithoutReadingsAreNoDays) {
  auto all = world(3, 0.3, 800);
  for (std::size_t i = 0; i < all.size(); i += 3) {
    all[i].measured_kW = std::numeric_limits<double>::quiet_NaN();
  }
  EXPECT_EQ(alarms_of(std::move(all), {}).size(), 1U);
}

TEST(DailyWatch, TooLittleToLearnFromIsNotWatched) {
  auto all = world(4);
  for (std::size_t i = 100; i < 366; ++i) {
    all[i].measured_kW = std::numeric_limits<double>::quiet_NaN();
  }
  DailyWatch watch{std::move(all), kLearning, {}};
  EXPECT_FALSE(watch.is_able());
  EXPECT_EQ(watch.evaluate(kLearning), std::nullopt);
}

// Whoever knows of a change says so: it raises nothing then.
TEST(DailyWatch, ABuildingThatBeganAnewIsLearntAnew) {
  constexpr int kFrom = 366 + 365 + 90;  // 1 April of the third year, month 27
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    DailyWatch watch{world(seed, 0.5, kFrom), kLearning, {}};
    for (int month = kLearning; month < kMonths; ++month) {
      if (month == 27) watch.begin_at(Day{first_day() + days{kFrom}}, 0.3);
      EXPECT_FALSE(watch.evaluate(month).has_value()) << seed << ' ' << month;
    }
  }
}

TEST(DailyReference, MeetsWhatItWasTaught) {
  std::vector<WatchedDay> first = world(5);
  first.resize(366);
  const DailyReference reference{first, 60.0, DailyReference::vague()};
  int inside = 0;
  for (const WatchedDay& day : first) {
    const auto expected = reference.expect(day);
    inside += std::abs(day.measured_kW - expected.mean_kW) < 1.645 * expected.sd_kW ? 1 : 0;
  }
  EXPECT_NEAR(inside, 0.9 * 366, 15);
  // 20 K above all that it has seen: less is known.
  WatchedDay hot = first[200];
  const double usual = reference.expect(hot).sd_kW;
  hot.dry_bulb_C = 45.0;
  EXPECT_GT(reference.expect(hot).sd_kW, 1.2 * usual);
}

}  // namespace
}  // namespace recald::drift::daily_watch_test
