#include "simulators/building/people.hpp"

#include <gtest/gtest.h>

namespace recald::simulators {
namespace {

using namespace std::chrono;

int in_building(const People& people, int minute) {
  int sum = 0;
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) sum += people.present(zone, minute);
  return sum;
}

TEST(People, AsManyAsTheDensitySays) {
  const People people(0.05, Rng{1});
  EXPECT_EQ(people.assigned(), 390);
  int assigned = 0;
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) assigned += people.assigned(zone);
  EXPECT_EQ(assigned, 390);
  EXPECT_EQ(People(0.0, Rng{1}).assigned(), 0);
}

TEST(People, WorkAtDayAndSleepAtNight) {
  People people(0.05, Rng{2});
  double noonish = 0.0;
  for (int day = 0; day < 28; ++day) {
    people.begin_day(sys_days{2021y / February / 1} + days{day});
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
  People people(0.05, Rng{3});
  people.begin_day(2021y / November / 25);
  EXPECT_LT(in_building(people, 11 * 60), 60);
}

TEST(People, SameSeedSameDay) {
  People one(0.04, Rng{4});
  People two(0.04, Rng{4});
  People other(0.04, Rng{5});
  int differences = 0;
  for (int day = 0; day < 5; ++day) {
    const metering::Day date{sys_days{2021y / February / 1} + days{day}};
    one.begin_day(date);
    two.begin_day(date);
    other.begin_day(date);
    for (int minute = 0; minute < 1440; minute += 5) {
      ASSERT_EQ(in_building(one, minute), in_building(two, minute));
      differences += in_building(one, minute) != in_building(other, minute) ? 1 : 0;
    }
  }
  EXPECT_GT(differences, 100);
}

}  // namespace
}  // namespace recald::simulators
