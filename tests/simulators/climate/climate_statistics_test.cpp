#include "simulators/climate/climate_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace recald::simulators::climate_statistics_test {
namespace {

using namespace std::chrono;

Outdoors steady(double air_C) {
  Outdoors outdoors{};
  outdoors.pressure_Pa = kSeaLevel_Pa;
  outdoors.air = {air_C, saturation_humidity_kg_kg(air_C - 6.0, kSeaLevel_Pa)};
  outdoors.wind_speed_m_s = 3.0;
  outdoors.global_horizontal_W_m2 = 150.0;
  return outdoors;
}

// A year of hand-made days: 10 degC by night and 20 by day from May to September, 20 K colder in
// the other months; 2 mm of snow on every tenth day.
TEST(ClimateStatistics, AddsUpAYearOfKnownWeather) {
  const sys_days first = 2021y / January / 1;
  ClimateStatistics statistics(first, 1h);
  for (int day = 0; day < 365; ++day) {
    const unsigned month{year_month_day{first + days{day}}.month()};
    const double base_C = month >= 5 && month <= 9 ? 10.0 : -10.0;
    for (int hour = 0; hour < 24; ++hour) {
      Outdoors now = steady(hour >= 6 && hour < 18 ? base_C + 10.0 : base_C);
      if (day % 10 == 0 && hour < 2) {
        now.precipitation_mm_h = 1.0;
        now.snow_share = 1.0;
      }
      statistics.add(now);
    }
  }
  const Normals year = statistics.result();
  EXPECT_NEAR(year.dry_bulb_C[0], -5.0, 1e-9);
  EXPECT_NEAR(year.dry_bulb_C[6], 15.0, 1e-9);
  EXPECT_NEAR(year.dew_point_C[6], 9.0, 1e-6);
  EXPECT_NEAR(year.daily_range_K[3], 10.0, 1e-9);
  EXPECT_NEAR(year.wind_m_s[11], 3.0, 1e-9);
  EXPECT_NEAR(year.global_kWh_m2_day[4], 3.6, 1e-9);
  EXPECT_NEAR(year.precipitation_mm[0], 4 * 2.0, 1e-9);  // 1, 11, 21 and 31 January
  EXPECT_NEAR(year.wet_days, 37.0, 1e-9);
  EXPECT_NEAR(year.snowfall_mm, 74.0, 1e-9);
  EXPECT_NEAR(year.heating_K_days, 153 * 3.3 + 212 * 23.3, 1e-6);
  EXPECT_EQ(year.cooling_K_days, 0.0);
  EXPECT_EQ(year.annual_minimum_C, -10.0);
  EXPECT_EQ(year.annual_maximum_C, 20.0);
  EXPECT_EQ(year.heating_design_C, -10.0);
  EXPECT_EQ(year.cooling_design_C, 20.0);
}

// Hours of a year in which the temperature rises by 1 mK each: shares are read off the ramp.
TEST(ClimateStatistics, DesignTemperaturesAreExceededByTheirShare) {
  ClimateStatistics statistics(2021y / January / 1, 1h);
  for (int hour = 0; hour < 8760; ++hour) statistics.add(steady(hour / 1000.0));
  const Normals year = statistics.result();
  EXPECT_NEAR(year.cooling_design_C, 8.760 * 0.996, 0.002);
  EXPECT_NEAR(year.heating_design_C, 8.760 * 0.004, 0.002);
}

TEST(ClimateStatistics, AnnualMeanWeighsMonthsByTheirLength) {
  EXPECT_NEAR(annual_mean({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 31.0 / 365.25, 1e-12);
  EXPECT_NEAR(annual_mean({2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2}), 2.0, 1e-12);
}

TEST(ClimateStatistics, TableNamesEveryClimateAndItsCity) {
  const std::string table = climate_table(1, 1);
  for (const ClimateKind kind : kClimateKinds) {
    EXPECT_NE(table.find(name_of(kind)), std::string::npos);
    EXPECT_NE(table.find(comparable_city(kind).name), std::string::npos);
  }
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 22);  // header, rule, 20 quantities
}

}  // namespace
}  // namespace recald::simulators::climate_statistics_test
