// What makes weather hang together: the causes that `weather.hpp` names, looked for in what comes
// out of each climate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include "simulators/climate/weather.hpp"
#include "tests/simulators/climate/run_years.hpp"

namespace recald::simulators::weather_causes_test {
namespace {

using namespace std::chrono;

constexpr double kDegree = 3.14159265358979 / 180.0;

double dew_of(const Outdoors& outdoors) {
  return dew_point_C(vapour_pressure_Pa(outdoors.air.humidity_kg_kg, outdoors.pressure_Pa));
}

struct Day {
  unsigned month = 0;
  double air_C = 0.0;
  double dew_C = 0.0;
  double range_K = 0.0;
  double global_W_m2 = 0.0;
  double wind_east = 0.0;
  double wind_north = 0.0;
};

std::vector<Day> days_of(ClimateKind kind, int years, std::uint64_t seed) {
  std::vector<Day> result;
  double lowest_C = 0.0;
  double highest_C = 0.0;
  int steps = 0;
  run_years(kind, years, seed, 15min, [&](unsigned month, int, const Outdoors& now) {
    if (steps == 0) {
      result.push_back({.month = month});
      lowest_C = highest_C = now.air.temperature_C;
    }
    Day& today = result.back();
    today.air_C += now.air.temperature_C / 96.0;
    today.dew_C += dew_of(now) / 96.0;
    today.global_W_m2 += now.global_horizontal_W_m2 / 96.0;
    today.wind_east += now.wind_speed_m_s * std::sin(now.wind_from_deg * kDegree) / 96.0;
    today.wind_north += now.wind_speed_m_s * std::cos(now.wind_from_deg * kDegree) / 96.0;
    lowest_C = std::min(lowest_C, now.air.temperature_C);
    highest_C = std::max(highest_C, now.air.temperature_C);
    today.range_K = highest_C - lowest_C;
    steps = (steps + 1) % 96;
  });
  return result;
}

std::vector<Day> only(const std::vector<Day>& all, std::initializer_list<unsigned> months) {
  std::vector<Day> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&](const Day& day) {
    return std::find(months.begin(), months.end(), day.month) != months.end();
  });
  return some;
}

double correlation(const std::vector<Day>& days, double Day::*x, double Day::*y) {
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const Day& day : days) {
    mean_x += day.*x / static_cast<double>(days.size());
    mean_y += day.*y / static_cast<double>(days.size());
  }
  double xy = 0.0;
  double xx = 0.0;
  double yy = 0.0;
  for (const Day& day : days) {
    xy += (day.*x - mean_x) * (day.*y - mean_y);
    xx += (day.*x - mean_x) * (day.*x - mean_x);
    yy += (day.*y - mean_y) * (day.*y - mean_y);
  }
  return xy / std::sqrt(xx * yy);
}

// In winter moist air is warm air; clear days range wider than overcast ones. Measured at Atlanta
// and Chicago: 0.8 to 0.99 (January), 0.5 to 0.8 (July).
TEST(WeatherCauses, MoistWinterDaysAreWarmAndClearDaysRangeWide) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    const std::vector<Day> all = days_of(kind, 6, 3);
    const double warm_and_moist = correlation(only(all, {12, 1, 2}), &Day::dew_C, &Day::air_C);
    EXPECT_GT(warm_and_moist, kind == ClimateKind::hot_dry ? 0.1 : 0.5);
    EXPECT_GT(correlation(only(all, {7}), &Day::global_W_m2, &Day::range_K), 0.4);
    EXPECT_GT(correlation(only(all, {4}), &Day::global_W_m2, &Day::range_K), 0.1);
  }
}

// The sharpest falls of a winter are fronts: drier air follows, and the wind behind them.
TEST(WeatherCauses, FrontsCoolDryAndTurnTheWind) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    const std::vector<Day> winter = only(days_of(kind, 8, 4), {12, 1, 2});
    std::vector<std::size_t> order(winter.size() - 1);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto fall_K = [&](std::size_t day) { return winter[day].air_C - winter[day + 1].air_C; };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return fall_K(a) > fall_K(b); });
    double drying_K = 0.0;
    double towards_front_wind_m_s = 0.0;
    const double from = climate_of(kind, {}).wind.behind_front_from_deg * kDegree;
    for (std::size_t rank = 0; rank < 25; ++rank) {
      const Day& before = winter[order[rank]];
      const Day& after = winter[order[rank] + 1];
      drying_K += (before.dew_C - after.dew_C) / 25.0;
      towards_front_wind_m_s +=
          (after.wind_east * std::sin(from) + after.wind_north * std::cos(from)) / 25.0;
    }
    EXPECT_GT(fall_K(order[24]), 2.0);
    EXPECT_GT(drying_K, 0.8);
    EXPECT_GT(towards_front_wind_m_s, 1.0);
  }
}

TEST(WeatherCauses, MonsoonEndsTheDryHeatOfPhoenix) {
  double june_dew_C = 0.0;
  double july_dew_C = 0.0;
  double june_range_K = 0.0;
  double august_range_K = 0.0;
  for (const Day& day : days_of(ClimateKind::hot_dry, 6, 1)) {
    if (day.month == 6) june_dew_C += day.dew_C / 180.0;
    if (day.month == 7) july_dew_C += day.dew_C / 186.0;
    if (day.month == 6) june_range_K += day.range_K / 180.0;
    if (day.month == 8) august_range_K += day.range_K / 186.0;
  }
  EXPECT_GT(july_dew_C, june_dew_C + 6.0);
  EXPECT_LT(august_range_K, june_range_K - 0.5);
}

// The same sun three and a half hours before and after noon: only low cloud tells them apart.
TEST(WeatherCauses, MorningStratusBurnsOffInTheMarineClimateAlone) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    double morning = 0.0;
    double afternoon = 0.0;
    run_years(kind, 8, 2, 15min, [&](unsigned month, int hour, const Outdoors& now) {
      if (month != 7) return;
      if (hour == 8) morning += now.global_horizontal_W_m2;
      if (hour == 15) afternoon += now.global_horizontal_W_m2;
    });
    if (kind == ClimateKind::marine) {
      EXPECT_LT(morning / afternoon, 0.90);
    } else {
      EXPECT_GT(morning / afternoon, 0.93);
    }
  }
}

TEST(WeatherCauses, ValleyWindOfPhoenixTurnsWithTheSun) {
  double night_east = 0.0;
  double day_east = 0.0;
  run_years(ClimateKind::hot_dry, 4, 1, 15min, [&](unsigned month, int hour, const Outdoors& now) {
    if (month != 7) return;
    const double east = now.wind_speed_m_s * std::sin(now.wind_from_deg * kDegree);
    if (hour == 3) night_east += east;
    if (hour == 15) day_east += east;
  });
  EXPECT_GT(night_east, 0.0);  // from the east by night, from the west by day
  EXPECT_LT(day_east, 0.0);
}

TEST(WeatherCauses, SnowFallsAndLiesOnlyWhereItIsCold) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    double covered_days = 0.0;
    double rain_hours = 0.0;
    run_years(kind, 6, 1, 15min, [&](unsigned month, int, const Outdoors& now) {
      ASSERT_TRUE(now.snow_share == 0.0 || now.precipitation_mm_h > 0.0);
      if (now.snow_share > 0.0) {
        ASSERT_LT(wet_bulb_C(now.air, now.pressure_Pa), 1.6);
      }
      ASSERT_TRUE((now.ground_reflectance == 0.2) == (now.snow_cover_mm == 0.0));
      if (month >= 7 && month <= 8) {
        ASSERT_EQ(now.snow_cover_mm, 0.0);
      }
      covered_days += now.snow_cover_mm > 3.0 ? 1.0 / 96.0 / 6.0 : 0.0;
      rain_hours += now.precipitation_mm_h > 0.0 ? 0.25 / 6.0 : 0.0;
    });
    EXPECT_GT(covered_days, kind == ClimateKind::cold ? 40.0 : -1.0);
    EXPECT_LT(covered_days, kind == ClimateKind::cold    ? 120.0
                            : kind == ClimateKind::mixed ? 25.0
                                                         : 10.0);
    EXPECT_GT(rain_hours, kind == ClimateKind::hot_dry ? 30.0 : 250.0);
    EXPECT_LT(rain_hours, 1'200.0);
  }
}

TEST(WeatherCauses, NothingIsImpossibleAtAnyStep) {
  for (const ClimateKind kind : kClimateKinds) {
    for (const seconds step : {5min, 10min, 15min}) {
      SCOPED_TRACE(std::string(name_of(kind)) + ", step of " + std::to_string(step.count()) + " s");
      double before_C = NAN;
      double sharpest_K = 0.0;
      run_years(kind, 2, 7, step, [&](unsigned, int, const Outdoors& now) {
        const double air_C = now.air.temperature_C;
        ASSERT_GT(air_C, -42.0);
        ASSERT_LT(air_C, 51.0);
        ASSERT_LE(dew_of(now), air_C);
        ASSERT_LT(dew_of(now), 30.0);
        ASSERT_GT(now.relative_humidity, 0.01);
        ASSERT_LE(now.relative_humidity, 1.0);
        ASSERT_GE(now.wind_speed_m_s, 0.0);
        ASSERT_LT(now.wind_speed_m_s, 31.0);
        ASSERT_GE(now.wind_from_deg, 0.0);
        ASSERT_LT(now.wind_from_deg, 360.0);
        ASSERT_GE(now.sky.beam_normal_W_m2, 0.0);
        ASSERT_LT(now.sky.beam_normal_W_m2, 1'100.0);
        ASSERT_GE(now.sky.diffuse_horizontal_W_m2, 0.0);
        ASSERT_LT(now.global_horizontal_W_m2, 1'200.0);
        ASSERT_TRUE(now.sun.up > 0.0 || now.global_horizontal_W_m2 == 0.0);
        ASSERT_LT(now.sky_temperature_C, air_C);
        ASSERT_GT(now.sky_temperature_C, air_C - 50.0);
        ASSERT_GE(now.precipitation_mm_h, 0.0);
        ASSERT_LE(now.precipitation_mm_h, 90.0);
        ASSERT_GE(now.snow_share, 0.0);
        ASSERT_LE(now.snow_share, 1.0);
        ASSERT_LE(now.ground_reflectance, 0.7);
        if (!std::isnan(before_C)) sharpest_K = std::max(sharpest_K, std::abs(air_C - before_C));
        before_C = air_C;
      });
      EXPECT_LT(sharpest_K, 2.5 + 0.2 * static_cast<double>(step / 1min));
    }
  }
}

TEST(WeatherCauses, SeedAndStepDecideEveryByte) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    const auto generator = [&](std::uint64_t seed) {
      return WeatherGenerator(climate_of(kind, comparable_city(kind).place),
                              sys_days{2021y / January / 1}, stream_of(seed, Stream::weather),
                              10min);
    };
    WeatherGenerator one = generator(6);
    WeatherGenerator same = generator(6);
    WeatherGenerator other = generator(7);
    bool differs = false;
    for (int step = 0; step < 144 * 60; ++step) {
      const Outdoors a = one.advance();
      const Outdoors b = same.advance();
      ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0);
      differs = differs || other.advance().air.temperature_C != a.air.temperature_C;
    }
    EXPECT_TRUE(differs);
  }
}

// Precipitation draws from a stream of its own: however it rains, the rest stays as it is.
TEST(WeatherCauses, RainLeavesTheOtherWeatherAlone) {
  const Place& place = comparable_city(ClimateKind::mixed).place;
  Climate rainless = climate_of(ClimateKind::mixed, place);
  rainless.rain.dryness = SeasonalCurve(50.0);
  const auto begin = sys_days{2021y / January / 1};
  WeatherGenerator wet(climate_of(ClimateKind::mixed, place), begin, Rng{8, 1});
  WeatherGenerator dry(rainless, begin, Rng{8, 1});
  double fallen = 0.0;
  for (int step = 0; step < 288 * 60; ++step) {
    const Outdoors a = wet.advance();
    const Outdoors b = dry.advance();
    ASSERT_EQ(a.air.temperature_C, b.air.temperature_C);
    ASSERT_EQ(a.wind_from_deg, b.wind_from_deg);
    ASSERT_EQ(a.global_horizontal_W_m2, b.global_horizontal_W_m2);
    ASSERT_EQ(b.precipitation_mm_h, 0.0);
    fallen += a.precipitation_mm_h;
  }
  EXPECT_GT(fallen, 0.0);
}

}  // namespace
}  // namespace recald::simulators::weather_causes_test
