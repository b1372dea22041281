#include "simulators/building/people.hpp"

#include <gtest/gtest.h>

#include "simulators/building/calendar.hpp"

namespace recald::simulators::people_test {
namespace {

using namespace std::chrono;

Truth with_density(double density_person_m2) {
  Truth truth = draw_truth({}, 1);
  truth.occupancy_density_person_m2 = density_person_m2;
  return truth;
}

constexpr std::size_t kZones = 18;

void begin(People& people, metering::Day day, double attendance = 1.0) {
  const Calendar calendar(Use::laboratory);
  people.begin_day(day, calendar.kind_of(day), calendar.season_attendance(day), attendance);
}

int in_building(const People& people, int minute) {
  int sum = 0;
  for (std::size_t zone = 0; zone < kZones; ++zone) sum += people.present(zone, minute);
  return sum;
}

TEST(People, AsManyAsTheDensitySays) {
  const People people(with_density(0.05), Rng{1});
  EXPECT_EQ(people.assigned(), 390);
  int assigned = 0;
  for (std::size_t zone = 0; zone < kZones; ++zone) assigned += people.assigned(zone);
  EXPECT_EQ(assigned, 390);
  EXPECT_EQ(People(with_density(0.0), Rng{1}).assigned(), 0);
}

TEST(People, WorkAtDayAndSleepAtNight) {
  People people(with_density(0.05), Rng{2});
  double noonish = 0.0;
  for (int day = 0; day < 28; ++day) {
    begin(people, sys_days{2021y / February / 1} + days{day});
    EXPECT_LE(in_building(people, 4 * 60), 5);
    EXPECT_LE(in_building(people, 10 * 60), 390);
    const bool weekend = day % 7 >= 5;
    if (weekend) {
      EXPECT_LT(in_building(people, 10 * 60 + 30), 60);
    } else {
      noonish += in_building(people, 10 * 60 + 30) / 20.0;
    }
  }
  EXPECT_NEAR(noonish / 390.0, 0.78, 0.07);  // the share that the site file's schedule quotes
}

TEST(People, HolidaysAreLikeSundays) {
  People people(with_density(0.05), Rng{3});
  begin(people, 2021y / November / 25);
  EXPECT_LT(in_building(people, 11 * 60), 60);
}

TEST(People, SameSeedSameDay) {
  People one(with_density(0.04), Rng{4});
  People two(with_density(0.04), Rng{4});
  People other(with_density(0.04), Rng{5});
  int differences = 0;
  for (int day = 0; day < 5; ++day) {
    const metering::Day date{sys_days{2021y / February / 1} + days{day}};
    begin(one, date);
    begin(two, date);
    begin(other, date);
    for (int minute = 0; minute < 1440; minute += 5) {
      ASSERT_EQ(in_building(one, minute), in_building(two, minute));
      differences += in_building(one, minute) != in_building(other, minute) ? 1 : 0;
    }
  }
  EXPECT_GT(differences, 100);
}

TEST(People, WhoIsKeptAwayLeavesEverybodyElseAsTheyWere) {
  People all(with_density(0.05), Rng{6});
  People some(with_density(0.05), Rng{6});
  double present = 0.0;
  double kept = 0.0;
  for (int day = 0; day < 20; ++day) {
    const metering::Day date{sys_days{2021y / February / 1} + days{day}};
    begin(all, date);
    begin(some, date, day < 10 ? 0.6 : 1.0);
    for (int minute = 0; minute < 1440; minute += 5) {
      for (std::size_t zone = 0; zone < kZones; ++zone) {
        ASSERT_LE(some.present(zone, minute), all.present(zone, minute));
        if (day < 10) continue;
        ASSERT_EQ(some.present(zone, minute), all.present(zone, minute));
      }
      if (day >= 10) continue;
      present += in_building(all, minute);
      kept += in_building(some, minute);
    }
  }
  EXPECT_NEAR(kept / present, 0.6, 0.03);
}

}  // namespace
}  // namespace recald::simulators::people_test
