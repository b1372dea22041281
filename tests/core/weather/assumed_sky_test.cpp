#include "core/weather/assumed_sky.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::weather {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::sys_days;
using std::chrono::year;
using ::testing::ElementsAre;

constexpr Location kBayArea{37.9, -122.3, 15.0};
constexpr int kDay_h = 24;
constexpr std::size_t kHumidity = 1;

/// Dry bulb alone from 1 June 2021 at local midnight on: every other day swings by 14 K about 18
/// °C, the others by 4 K.
WeatherSeries temperatures(int days = 60) {
  WeatherSeries series{sys_days{year{2021} / 6 / 1} + hours{8}, {}};
  for (int h = 0; h < kDay_h * days; ++h) {
    const double half_range_K = h / kDay_h % 2 == 0 ? 7.0 : 2.0;
    const double turn = 2.0 * std::numbers::pi * (h % kDay_h - 3) / kDay_h;
    series.hours.push_back({.dry_bulb_C = 18.0 - half_range_K * std::cos(turn)});
  }
  return series;
}

WeatherSeries assumed(WeatherSeries series, const SkyError& error = {}) {
  assume_sky(series, kBayArea, kAssumable, error);
  return series;
}

/// Mean of the hours that begin on a day of the series.
double sun_of_day_W_m2(const WeatherSeries& series, int day) {
  double sum_W_m2 = 0.0;
  for (int h = kDay_h * day; h < kDay_h * (day + 1); ++h) {
    sum_W_m2 += series.hours[static_cast<std::size_t>(h)].ghi_W_m2 / kDay_h;
  }
  return sum_W_m2;
}

/// Highest irradiance of a cloudless sky within the hour; 0 at night.
double clear_W_m2(metering::Instant start, const Location& location) {
  double highest_W_m2 = 0.0;
  for (minutes past{0}; past <= hours{1}; past += minutes{1}) {
    highest_W_m2 = std::max(highest_W_m2, clear_sky_W_m2(sun_position(start + past, location)));
  }
  return highest_W_m2;
}

TEST(AssumedSky, StaysWithinBounds) {
  for (const double dew_point_K : {-2.0, 0.0, 2.0}) {
    const WeatherSeries series = assumed(temperatures(), {.dew_point_K = dew_point_K});
    for (std::size_t i = 0; i < series.hours.size(); ++i) {
      const WeatherHour& hour = series.hours[i];
      ASSERT_GT(hour.rel_humidity_pct, 0.0);
      ASSERT_LE(hour.rel_humidity_pct, 100.0);
      ASSERT_GE(hour.ghi_W_m2, 0.0);
      ASSERT_LE(hour.ghi_W_m2, clear_W_m2(series.begin + hours{i}, kBayArea)) << i;
      ASSERT_EQ(hour.wind_speed_m_s, 3.0);
    }
  }
}

// A low sun gets less through a cloudless sky than the paper's clear day has.
TEST(AssumedSky, IsNeverAboveACloudlessSky) {
  constexpr Location kArctic{65.0, 20.0, 0.0};
  WeatherSeries series{sys_days{year{2021} / 11 / 1}, {}};
  for (int h = 0; h < kDay_h * 30; ++h) {
    series.hours.push_back({.dry_bulb_C = h % kDay_h == 12 ? 20.0 : 0.0});
  }
  assume_sky(series, kArctic, kAssumable);
  for (std::size_t i = 0; i < series.hours.size(); ++i) {
    const double highest_W_m2 = clear_W_m2(series.begin + hours{i}, kArctic);
    ASSERT_LE(series.hours[i].ghi_W_m2, highest_W_m2) << i;
    if (i % kDay_h == 10) {  // noon
      ASSERT_GT(series.hours[i].ghi_W_m2, 0.95 * highest_W_m2) << i;
    }
  }
}

TEST(AssumedSky, ADayOfWideRangeIsSunny) {
  const WeatherSeries series = assumed(temperatures());
  for (int day = 1; day + 1 < 59; day += 2) {
    ASSERT_LT(sun_of_day_W_m2(series, day), 0.6 * sun_of_day_W_m2(series, day + 1)) << day;
  }
}

// By hand for 15 July: dT = 25 - (11 + 16) / 2 = 11.5 K, dT_mean = (15 * 11.5 + 16 * 6.5) / 31
// = 8.92 K, b = 0.036 exp(-0.154 * 8.92) = 0.00911, transmittance 0.7 (1 - exp(-b * 11.5^2.4))
// = 0.6715. Above the atmosphere 40.86 MJ/m2 that day at 37.9° north (Duffie and Beckman, 4th ed.,
// eq. 1.10.3).
TEST(AssumedSky, TheDaysSumIsThatOfThePaper) {
  const WeatherSeries series = assumed(temperatures());
  EXPECT_NEAR(sun_of_day_W_m2(series, 44) * 0.0864, 0.6715 * 40.86, 0.15);
}

// The day's lowest is 11 °C, its highest 25 °C: 13.1 against 31.7 hPa.
TEST(AssumedSky, DewIsAtTheDaysLowestTemperature) {
  const WeatherSeries series = assumed(temperatures());
  EXPECT_NEAR(series.hours[kDay_h * 10 + 3].rel_humidity_pct, 100.0, 1e-9);
  EXPECT_NEAR(series.hours[kDay_h * 10 + 15].rel_humidity_pct, 100.0 * 13.13 / 31.69, 0.1);
}

TEST(AssumedSky, WhatIsMeasuredStays) {
  WeatherSeries series = temperatures();
  for (WeatherHour& hour : series.hours) hour.wind_speed_m_s = 1.5;
  series.hours[7].ghi_W_m2 = 20.0;  // once is enough
  const auto lacking = never_measured(series);
  EXPECT_THAT(lacking, ElementsAre(kHumidity));
  assume_sky(series, kBayArea, lacking);
  EXPECT_EQ(series.hours[7].ghi_W_m2, 20.0);
  EXPECT_TRUE(std::isnan(series.hours[8].ghi_W_m2));
  EXPECT_EQ(series.hours[8].wind_speed_m_s, 1.5);
  EXPECT_TRUE(std::isfinite(series.hours[8].rel_humidity_pct));
  EXPECT_EQ(series.hours[8].dry_bulb_C, temperatures().hours[8].dry_bulb_C);
}

TEST(AssumedSky, ErrorsMoveWhatTheyAreOf) {
  const WeatherSeries series = assumed(temperatures());
  const WeatherSeries other = assumed(temperatures(), kSkyErrorSd);
  const std::size_t noon = kDay_h * 10 + 12;
  EXPECT_NEAR(other.hours[noon].ghi_W_m2, 1.2 * series.hours[noon].ghi_W_m2, 1e-9);
  EXPECT_NEAR(other.hours[noon].wind_speed_m_s, 1.4 * 3.0, 1e-9);
  // Saturation at 13 and 11 °C: 14.97 and 13.13 hPa.
  EXPECT_NEAR(other.hours[noon].rel_humidity_pct / series.hours[noon].rel_humidity_pct,
              14.97 / 13.13, 0.002);
}

TEST(AssumedSky, NothingIsAssumedWithoutATemperature) {
  WeatherSeries series = temperatures();
  for (int h = kDay_h * 20; h < kDay_h * 22; ++h) {
    series.hours[static_cast<std::size_t>(h)].dry_bulb_C = kAbsent;
  }
  series = assumed(std::move(series));
  EXPECT_TRUE(std::isnan(series.hours[kDay_h * 20 + 12].ghi_W_m2));
  EXPECT_TRUE(std::isnan(series.hours[kDay_h * 20 + 12].rel_humidity_pct));
  EXPECT_TRUE(std::isnan(series.hours[kDay_h * 20 + 12].wind_speed_m_s));
  EXPECT_GT(series.hours[kDay_h * 19 + 12].ghi_W_m2, 0.0);  // the day before has no morrow
  EXPECT_TRUE(never_measured({}).size() == 3);
}

}  // namespace
}  // namespace recald::weather
