#include "core/profile/load_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/absent.hpp"

namespace recald::profile::load_shape_test {
namespace {

using metering::Day;
using model::DayType;
using std::chrono::sys_days;
using std::chrono::year;

/// Days from Monday, 4 January 2021 on, each hour whole.
template <class Load>
std::vector<model::HourlyLoad> hours_of(int days, Load load_kW) {
  std::vector<model::HourlyLoad> loads;
  for (int day = 0; day < days; ++day) {
    const Day date{sys_days{year{2021} / 1 / 4} + std::chrono::days{day}};
    for (int hour = 0; hour < 24; ++hour) {
      loads.push_back({date, hour, load_kW(day, hour), 1.0, false});
    }
  }
  return loads;
}

TEST(LoadShape, IsTheMeanOfEachHourByKindOfDay) {
  const auto loads =
      hours_of(14, [](int day, int hour) { return (day % 7 >= 5 ? 10.0 : 40.0) + hour + day / 7; });
  const LoadShape shape = load_shape(loads, {});
  EXPECT_DOUBLE_EQ(shape.mean_kW.at(DayType::workday, 3), 43.5);
  EXPECT_DOUBLE_EQ(shape.mean_kW.at(DayType::saturday, 3), 13.5);
  EXPECT_DOUBLE_EQ(shape.mean_kW.at(DayType::sunday_or_holiday, 23), 33.5);
  EXPECT_EQ(shape.days, (std::array<int, 3>{10, 2, 2}));
}

TEST(LoadShape, AHolidayIsASunday) {
  const auto loads = hours_of(7, [](int day, int) { return day == 2 ? 8.0 : 40.0; });
  const LoadShape shape = load_shape(loads, {year{2021} / 1 / 6});
  EXPECT_DOUBLE_EQ(shape.mean_kW.at(DayType::workday, 12), 40.0);
  EXPECT_DOUBLE_EQ(shape.mean_kW.at(DayType::sunday_or_holiday, 12), 24.0);
}

TEST(LoadShape, TheBaseIsWhatNearlyAllHoursExceed) {
  // A tenth of the hours at 5 kW, so the twentieth lies among them; the rest at 25 kW.
  const auto loads = hours_of(10, [](int day, int) { return day == 0 ? 5.0 : 25.0; });
  const LoadShape shape = load_shape(loads, {});
  EXPECT_DOUBLE_EQ(shape.base_kW, 5.0);
  EXPECT_DOUBLE_EQ(shape.base_share, 5.0 / 23.0);
}

TEST(LoadShape, HoursThatAreNotBelievedDoNotCount) {
  auto loads = hours_of(8, [](int, int) { return 20.0; });
  for (std::size_t i = 0; i < 24; ++i) {
    loads[i] = {loads[i].date, loads[i].hour, 900.0, 1.0, true};
    loads[24 + i] = {loads[24 + i].date, loads[24 + i].hour, kAbsent, 0.0, false};
  }
  loads[48].ok_share = 0.25;
  loads[48].mean_kW = 700.0;
  const LoadShape shape = load_shape(loads, {});
  EXPECT_EQ(shape.days[0], 4);  // Wednesday to Friday, and the second Monday
  EXPECT_DOUBLE_EQ(shape.mean_kW.at(DayType::workday, 0), 20.0);
}

TEST(LoadShape, AFewDaysHaveNoBase) {
  const LoadShape shape = load_shape(hours_of(6, [](int, int) { return 20.0; }), {});
  EXPECT_TRUE(std::isnan(shape.base_kW));
  EXPECT_TRUE(std::isnan(shape.mean_kW.at(DayType::sunday_or_holiday, 0)));
}

TEST(LoadShape, AMeterThatCountsBackwardsHasNoShareOfBase) {
  const auto loads = hours_of(10, [](int, int hour) { return hour == 12 ? -30.0 : 25.0; });
  const LoadShape shape = load_shape(loads, {});
  EXPECT_TRUE(std::isfinite(shape.base_kW));
  EXPECT_TRUE(std::isnan(shape.base_share));
}

}  // namespace
}  // namespace recald::profile::load_shape_test
