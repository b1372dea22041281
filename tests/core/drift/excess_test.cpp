/// What a change adds to a meter, in worlds whose meter without the change is known.
#include "core/drift/watch/excess.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random/rng.hpp"

namespace recald::drift::excess_test {
namespace {

using metering::Day;
using std::chrono::days;
using std::chrono::sys_days;

Day day_at(int index) { return Day{sys_days{std::chrono::year{2020} / 1 / 1} + days{index}}; }

/// What cools, works in summer and takes a share more from a day to another.
struct World {
  std::vector<WatchedDay> all;
  std::vector<double> added_kWh;  ///< (days)

  World(std::uint64_t seed, int count, double share, int from, int to = 1 << 20) {
    Rng rng{seed};
    double weather = 0.0;
    for (int i = 0; i < count; ++i) {
      weather = 0.7 * weather + 2.5 * rng.normal();
      const double t = 11.0 - 12.0 * std::cos(2.0 * std::numbers::pi * i / 365.25) + weather;
      const bool works = std::chrono::weekday{sys_days{day_at(i)}}.c_encoding() % 6 != 0;
      const double usual_kW = (works ? 9.0 : 3.0) + 6.0 * std::max(0.0, t - 12.0);
      const double added_kW = from <= i && i < to ? share * usual_kW : 0.0;
      all.push_back({.date = day_at(i),
                     .month = i / 30,
                     .is_workday = works,
                     .dry_bulb_C = t,
                     .humidity_ratio = 0.008,
                     .modelled_kW = works ? 11.0 : 8.0,
                     .measured_kW = (usual_kW + added_kW) * (1.0 + 0.05 * rng.normal())});
      added_kWh.push_back(24.0 * added_kW);
    }
  }

  [[nodiscard]] double added_between(int from, int to) const {
    double sum = 0.0;
    for (int i = from; i < to; ++i) sum += added_kWh[static_cast<std::size_t>(i)];
    return sum;
  }
};

// A load that lives in summer changes in winter, spring, summer and autumn; a fortnight, four
// months and more than a year are known of it.
TEST(Excess, OfAChangeInAnySeasonFollowsTheMetersOwnYear) {
  for (const int begin : {760, 850, 940, 1030}) {
    const double a_year = World{7, begin + 400, 0.3, begin}.added_between(begin, begin + 365);
    for (const int known : {15, 120, 400}) {
      const World world{7, begin + known, 0.3, begin};
      const std::vector<NoticedChange> noticed{{day_at(begin), 1}};
      const auto excess = excesses_of(world.all, noticed).at(0);
      ASSERT_TRUE(excess && excess->year_kWh);
      const double so_far = world.added_between(begin, begin + known);
      EXPECT_NEAR(excess->so_far_kWh, so_far, 0.25 * so_far) << begin << " " << known;
      EXPECT_NEAR(*excess->year_kWh, a_year, 0.25 * a_year) << begin << " " << known;
    }
  }
}

TEST(Excess, NoticesOfOneChangeHaveTheWholeOfIt) {
  const World world{3, 1200, 0.4, 800};
  const std::vector<NoticedChange> noticed{{day_at(800), 1}, {day_at(900), 1}, {day_at(1000), 1}};
  const auto excesses = excesses_of(world.all, noticed);
  const double whole = world.added_between(800, 1200);
  for (const auto& excess : excesses) {
    ASSERT_TRUE(excess);
    EXPECT_EQ(excess->since, day_at(800));
    EXPECT_NEAR(excess->so_far_kWh, whole, 0.1 * whole);
  }
}

// What was repaired costs nothing any more, and the repair is no saving beyond what it took away.
TEST(Excess, ARepairEndsIt) {
  const World world{5, 1200, 0.4, 700, 950};
  const std::vector<NoticedChange> noticed{{day_at(700), 1}, {day_at(950), -1}};
  const auto excesses = excesses_of(world.all, noticed);
  const double cost = world.added_between(700, 950);
  ASSERT_TRUE(excesses[0] && excesses[1]);
  EXPECT_TRUE(excesses[0]->has_ended);
  EXPECT_FALSE(excesses[0]->year_kWh);
  EXPECT_EQ(excesses[0]->until, day_at(949));
  EXPECT_NEAR(excesses[0]->so_far_kWh, cost, 0.15 * cost);
  EXPECT_FALSE(excesses[1]->has_ended);
  EXPECT_LT(excesses[1]->so_far_kWh, 0.0);
}

// A winter that is somewhat off raises an alarm; it says nothing of summers, and does not take away
// what the years before said of them.
TEST(Excess, AFalseNoticeChangesNothing) {
  World world{8, 1400, 0.4, 1200};
  for (std::size_t i = 1000; i < 1200; ++i) world.all[i].measured_kW *= 0.87;
  const std::vector<NoticedChange> noticed{{day_at(1000), -1}, {day_at(1200), 1}};
  const auto excess = excesses_of(world.all, noticed).at(1);
  const double cost = world.added_between(1200, 1400);
  ASSERT_TRUE(excess);
  EXPECT_NEAR(excess->so_far_kWh, cost, 0.15 * cost);
}

TEST(Excess, UnmeasuredDaysCountInProportion) {
  World world{9, 1000, 0.4, 800};
  const double whole = world.added_between(800, 1000);
  for (std::size_t i = 0; i < world.all.size(); i += 3) {
    world.all[i].measured_kW = std::numeric_limits<double>::quiet_NaN();
  }
  const std::vector<NoticedChange> noticed{{day_at(800), 1}};
  const auto excess = excesses_of(world.all, noticed).at(0);
  ASSERT_TRUE(excess);
  EXPECT_NEAR(excess->so_far_kWh, whole, 0.1 * whole);
}

TEST(Excess, WithoutDaysBeforeOrSinceThereIsNone) {
  const World world{9, 400, 0.4, 100};
  EXPECT_THAT(excesses_of(world.all, std::vector<NoticedChange>{{day_at(0), 1}}),
              ::testing::ElementsAre(std::nullopt));
  EXPECT_THAT(excesses_of(world.all, std::vector<NoticedChange>{{day_at(400), 1}}),
              ::testing::ElementsAre(std::nullopt));
  EXPECT_THAT(excesses_of({}, std::vector<NoticedChange>{{day_at(0), 1}}),
              ::testing::ElementsAre(std::nullopt));
  // A year is not known of 300 days.
  const World short_world{9, 300, 0.4, 200};
  const auto excess =
      excesses_of(short_world.all, std::vector<NoticedChange>{{day_at(200), 1}}).at(0);
  ASSERT_TRUE(excess);
  EXPECT_FALSE(excess->year_kWh);
}

}  // namespace
}  // namespace recald::drift::excess_test
