#include "simulators/building/visits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace recald::simulators::visits_test {
namespace {

struct Followed {
  SlotShares taken{};  ///< Share of the days.
  double visits_a_day = 0.0;
};

/// One place through many days that are all alike.
Followed follow(const VisitDay& day, double before, int days, Rng rng) {
  Followed followed;
  bool taken = rng.uniform() < before;
  for (int i = 0; i < days; ++i) {
    bool goes_on = taken;  // a visit that began yesterday
    taken = day.draw(taken, rng, [&](std::size_t first, std::size_t end) {
      for (std::size_t slot = first; slot < end; ++slot) followed.taken[slot] += 1.0 / days;
      if (!goes_on || first > 0) followed.visits_a_day += 1.0 / days;
      goes_on = false;
    });
  }
  return followed;
}

constexpr HourlyShares kLunchAndDinner{0,    0,    0,    0,    0,    0,    0,    0,
                                       0.02, 0.06, 0.12, 0.34, 0.74, 0.66, 0.32, 0.15,
                                       0.16, 0.34, 0.70, 0.84, 0.76, 0.48, 0.20, 0.03};

TEST(Visits, HourlyMeansAreThoseOfLinesBetweenTheMiddlesOfHours) {
  HourlyShares peak{};
  peak[12] = 0.8;
  const HourlyShares means = hourly_means(peak);
  EXPECT_NEAR(means[12], 0.75 * 0.8, 1e-3);
  EXPECT_NEAR(means[11], 0.125 * 0.8, 1e-3);
  EXPECT_NEAR(means[13], 0.125 * 0.8, 1e-3);
  EXPECT_EQ(means[10], 0.0);
  HourlyShares all{};
  all.fill(0.6);
  for (const double mean : hourly_means(all)) EXPECT_NEAR(mean, 0.6, 1e-12);
}

// The share of days on which a place is taken is the one drawn up, in every slot: 4 standard errors
// of 40,000 days.
TEST(Visits, APlaceIsTakenAsOftenAsDrawnUpInEverySlot) {
  constexpr int days = 40'000;
  const SlotShares drawn = shares_by_slot(kLunchAndDinner);
  const Followed followed = follow(VisitDay(drawn, drawn.back(), 1.1), drawn.back(), days, Rng{5});
  for (std::size_t slot = 0; slot < kSlotsPerDay; ++slot) {
    const double error = std::sqrt(drawn[slot] * (1.0 - drawn[slot]) / days);
    ASSERT_NEAR(followed.taken[slot], drawn[slot], 4.0 * error + 1e-9) << slot;
  }
}

// Where the share stands still, the hours taken over the visits begun are the mean stay.
TEST(Visits, StaysLastAsLongAsTheyShould) {
  for (const double stay_h : {0.5, 1.2, 8.0}) {
    SCOPED_TRACE(stay_h);
    SlotShares half{};
    half.fill(0.5);
    const Followed followed = follow(VisitDay(half, 0.5, stay_h), 0.5, 20'000, Rng{6});
    const double taken_h =
        std::accumulate(followed.taken.begin(), followed.taken.end(), 0.0) / 12.0;
    EXPECT_NEAR(taken_h / followed.visits_a_day, stay_h, 0.03 * stay_h);
  }
}

TEST(Visits, NobodyIsInAClosedBuilding) {
  const Followed followed = follow(VisitDay(SlotShares{}, 0.0, 1.0), 0.0, 1'000, Rng{7});
  for (const double taken : followed.taken) ASSERT_EQ(taken, 0.0);
}

}  // namespace
}  // namespace recald::simulators::visits_test
