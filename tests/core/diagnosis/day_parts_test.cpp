#include "core/diagnosis/evidence/day_parts.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/sample_building.hpp"

namespace recald::diagnosis::day_parts_test {
namespace {

TEST(DayParts, EveryHourStandsInExactlyOnePart) {
  const auto drivers = testing::sample_drivers(testing::sample_building(), 12);
  const DayParts day_parts = make_day_parts(drivers);
  ASSERT_EQ(day_parts.parts.size(), 365u * 6u);
  int next = 0;
  for (const DayPart& part : day_parts.parts) {
    ASSERT_EQ(part.first_hour, next);
    next += part.hours;
  }
  EXPECT_EQ(next, std::ssize(drivers.hours));
}

TEST(DayParts, ClockChangesShortenAndLengthenOnePart) {
  const auto drivers = testing::sample_drivers(testing::sample_building(), 12);
  int short_parts = 0;
  int long_parts = 0;
  for (const DayPart& part : make_day_parts(drivers).parts) {
    short_parts += part.hours == 3;
    long_parts += part.hours == 5;
  }
  EXPECT_EQ(short_parts, 1);  // 14 March 2021, 00-04 h
  EXPECT_EQ(long_parts, 1);   // 7 November 2021
}

TEST(DayParts, ThreeMeasuredHoursOfFourAreEnough) {
  const auto drivers = testing::sample_drivers(testing::sample_building(), 1);
  const DayParts day_parts = make_day_parts(drivers);
  Eigen::ArrayXXd hourly = Eigen::ArrayXXd::Constant(std::ssize(drivers.hours), 1, 6.0);
  hourly(0, 0) = 2.0;
  hourly(1, 0) = std::numeric_limits<double>::quiet_NaN();
  hourly(4, 0) = hourly(5, 0) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::ArrayXXd means = measured_parts(day_parts, hourly);
  EXPECT_DOUBLE_EQ(means(0, 0), 14.0 / 3.0);
  EXPECT_TRUE(std::isnan(means(1, 0)));
  EXPECT_DOUBLE_EQ(means(2, 0), 6.0);
}

TEST(SplitMonths, TheLastMonthsAreShownWithAWinterAndASummerOne) {
  const auto months = testing::months_of_2021_22(24);
  const std::vector<Role> roles = split_months(months, {});
  for (std::size_t i = 21; i < 24; ++i) EXPECT_EQ(roles[i], Role::show);
  bool winter = false;
  bool summer = false;
  std::array<int, 4> count{};
  for (std::size_t i = 0; i < months.size(); ++i) {
    const auto m = static_cast<unsigned>(months[i].month());
    ++count[static_cast<std::size_t>(roles[i])];
    if (roles[i] != Role::show) continue;
    winter |= m == 12 || m <= 2;
    summer |= m >= 6 && m <= 8;
  }
  EXPECT_TRUE(winter);
  EXPECT_TRUE(summer);
  EXPECT_EQ(count[static_cast<std::size_t>(Role::select)], 5);
  EXPECT_GE(count[static_cast<std::size_t>(Role::fit)], 12);
}

TEST(SplitMonths, AFewMonthsAreAllNeededForTheFit) {
  for (const Role role : split_months(testing::months_of_2021_22(5), {}))
    EXPECT_EQ(role, Role::fit);
}

// What is fitted must not stand beside what is held: the noise remembers days.
TEST(PartRoles, AWeekLiesBetweenFittedAndHeldParts) {
  const auto drivers = testing::sample_drivers(testing::sample_building(), 24);
  const DayParts day_parts = make_day_parts(drivers);
  const auto month_roles = split_months(drivers.months, {});
  const std::vector<Role> roles = part_roles(day_parts, month_roles, 7);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i] != Role::fit) continue;
    for (std::size_t j = 0; j < roles.size(); j += 6) {
      if (roles[j] != Role::show && roles[j] != Role::select) continue;
      ASSERT_GT(std::abs(day_parts.parts[i].day_index - day_parts.parts[j].day_index), 6)
          << i << " beside " << j;
    }
  }
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (month_roles[static_cast<std::size_t>(day_parts.parts[i].month)] == Role::show) {
      ASSERT_EQ(roles[i], Role::show);
    }
  }
}

}  // namespace
}  // namespace recald::diagnosis::day_parts_test
