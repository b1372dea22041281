#include "simulators/footprint/means.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numeric>

namespace recald::simulators::means_test {
namespace {

using namespace std::chrono_literals;
using metering::Day;

// In New York clocks jump from 2 to 3 on 13 March 2022 and from 2 back to 1 on 6 November.
metering::LocalCalendar new_york() { return *metering::LocalCalendar::open("America/New_York"); }

Day day_of(int year, unsigned month, unsigned day) {
  return std::chrono::year{year} / std::chrono::month{month} / std::chrono::day{day};
}

constexpr metering::Instant at(Day day, std::chrono::hours hour) {
  return std::chrono::sys_days{day} + hour;
}

/// Four quarters for each hour.
std::vector<double> quarters_of(const std::vector<double>& hours) {
  std::vector<double> quarters;
  for (const double hour : hours) quarters.insert(quarters.end(), 4, hour);
  return quarters;
}

std::vector<double> clock_hours(double offset, const std::vector<int>& skipped,
                                const std::vector<int>& twice) {
  std::vector<double> hours;
  for (int hour = 0; hour < 24; ++hour) {
    if (std::ranges::find(skipped, hour) != skipped.end()) continue;
    hours.push_back(offset + hour);
    if (std::ranges::find(twice, hour) != twice.end()) hours.push_back(offset + hour);
  }
  return hours;
}

std::vector<double> joined(std::vector<double> one, const std::vector<double>& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

const DayGroup kWinterWeekend{HalfYear::winter, PartOfWeek::weekend, {}, {}};

// Saturday shows its hours, Sunday its hours + 100. On Sunday there is no hour 2.
TEST(Means, ASkippedHourIsTheMeanOfTheOtherDays) {
  const auto shown = quarters_of(joined(clock_hours(0, {}, {}), clock_hours(100, {2}, {})));

  const auto mean = mean_day({at(day_of(2022, 3, 12), 5h), shown}, kWinterWeekend, new_york());

  ASSERT_TRUE(mean.has_value());
  for (std::size_t hour = 0; hour < 24; ++hour) {
    SCOPED_TRACE(hour);
    const double by_hand = static_cast<double>(hour) + (hour == 2 ? 0.0 : 50.0);
    EXPECT_DOUBLE_EQ((*mean)[hour], by_hand);
  }
}

// Hour 1 on Sunday comes twice: (1 + 101 + 101) / 3.
TEST(Means, ARepeatedHourCountsTwice) {
  const auto shown = quarters_of(joined(clock_hours(0, {}, {}), clock_hours(100, {}, {1})));

  const auto mean = mean_day({at(day_of(2022, 11, 5), 4h), shown}, kWinterWeekend, new_york());

  ASSERT_TRUE(mean.has_value());
  EXPECT_DOUBLE_EQ((*mean)[0], 50.0);
  EXPECT_DOUBLE_EQ((*mean)[1], 203.0 / 3.0);
  EXPECT_DOUBLE_EQ((*mean)[2], 52.0);
  EXPECT_DOUBLE_EQ((*mean)[23], 73.0);
}

TEST(Means, QuartersOfAnHourAreAveraged) {
  std::vector<double> shown(96, 0.0);
  shown[40] = 1.0;
  shown[43] = 6.0;
  const auto mean = mean_day({at(day_of(2022, 1, 8), 5h), shown}, kWinterWeekend, new_york());
  ASSERT_TRUE(mean.has_value());
  EXPECT_DOUBLE_EQ((*mean)[10], 7.0 / 4.0);
}

TEST(Means, NoDayOfTheGroupNoMean) {
  const std::vector<double> saturday(96, 1.0);
  const IntervalSeries series{at(day_of(2022, 1, 8), 5h), saturday};
  EXPECT_FALSE(mean_day(series, {HalfYear::winter, PartOfWeek::working_days, {}, {}}, new_york()));
  EXPECT_FALSE(mean_day(series, {HalfYear::summer, PartOfWeek::weekend, {}, {}}, new_york()));
  EXPECT_TRUE(mean_day(series, kWinterWeekend, new_york()));
}

TEST(Means, GroupsDivideTheYear) {
  const auto contains = [](HalfYear half, PartOfWeek part, Day day) {
    return DayGroup{half, part, {}, {}}.contains(day);
  };
  const Day thursday = day_of(2022, 3, 31);
  const Day friday = day_of(2022, 4, 1);
  const Day last_friday = day_of(2022, 9, 30);
  const Day saturday = day_of(2022, 10, 1);
  const Day monday = day_of(2022, 10, 3);
  EXPECT_TRUE(contains(HalfYear::winter, PartOfWeek::working_days, thursday));
  EXPECT_TRUE(contains(HalfYear::summer, PartOfWeek::working_days, friday));
  EXPECT_TRUE(contains(HalfYear::summer, PartOfWeek::working_days, last_friday));
  EXPECT_TRUE(contains(HalfYear::winter, PartOfWeek::weekend, saturday));
  EXPECT_TRUE(contains(HalfYear::winter, PartOfWeek::working_days, monday));
  EXPECT_FALSE(contains(HalfYear::winter, PartOfWeek::working_days, saturday));
  EXPECT_FALSE(contains(HalfYear::winter, PartOfWeek::working_days, friday));
}

TEST(Means, FirstAndLastDayBelongToTheGroup) {
  const DayGroup group{HalfYear::winter, PartOfWeek::working_days, day_of(2022, 1, 10),
                       day_of(2022, 1, 12)};
  EXPECT_FALSE(group.contains(day_of(2022, 1, 7)));
  EXPECT_TRUE(group.contains(day_of(2022, 1, 10)));
  EXPECT_TRUE(group.contains(day_of(2022, 1, 12)));
  EXPECT_FALSE(group.contains(day_of(2022, 1, 13)));
}

// 1 kW the whole year: as many kWh as hours, one fewer in March, one more in November.
TEST(Means, MonthsAreThoseOfTheLocalClock) {
  const std::vector<double> shown(8760 * 4, 1.0);

  const MonthlySum sum = monthly_kWh({at(day_of(2022, 1, 1), 5h), shown}, new_york());

  const MonthlySum hours{744, 672, 743, 720, 744, 720, 744, 744, 720, 744, 721, 744};
  for (std::size_t month = 0; month < 12; ++month) {
    EXPECT_DOUBLE_EQ(sum[month], hours[month]) << "month " << month + 1;
  }
}

TEST(Means, YearsAreAddedUp) {
  const std::vector<double> shown(2 * 8760 * 4, 1.0);
  const MonthlySum sum = monthly_kWh({at(day_of(2021, 1, 1), 5h), shown}, new_york());
  EXPECT_DOUBLE_EQ(sum[0], 2 * 744.0);
}

TEST(Means, AWeekHasItsHoursInSequence) {
  std::vector<double> shown(10 * 96);
  std::iota(shown.begin(), shown.end(), 0.0);
  const IntervalSeries series{at(day_of(2022, 3, 6), 5h), shown};

  const auto week = hourly_means(series, day_of(2022, 3, 7), 7, new_york());

  ASSERT_EQ(week.size(), 7 * 24 - 1U) << "clocks change on the Sunday";
  EXPECT_DOUBLE_EQ(week[0], 97.5) << "mean of 96, 97, 98, 99";
  EXPECT_DOUBLE_EQ(week.back(), 97.5 + 4.0 * 166.0);
}

}  // namespace
}  // namespace recald::simulators::means_test
