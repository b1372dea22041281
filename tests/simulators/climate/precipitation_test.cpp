#include "simulators/climate/precipitation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace recald::simulators::precipitation_test {
namespace {

constexpr double kHour_s = 3600.0;
constexpr RainCause kDrizzle{.year_share = 0.5,
                             .cloud = 0.9,
                             .lift = 0.3,
                             .convection = 0.0,
                             .dryness_K = 2.0,
                             .moisture_K = 0.0};

RainHabit habit() { return {SeasonalCurve(0.5), SeasonalCurve(0.7), 0.1, {0.2, 0.3}}; }

/// Mean over many steps, mm/h.
double mean_rain_mm_h(const RainCause& cause, const RainHabit& of = habit()) {
  Precipitation rain(of, 300.0, Rng{1});
  constexpr int steps = 20'000;
  double sum = 0.0;
  for (int step = 0; step < steps; ++step) sum += rain.advance_mm_h(cause);
  return sum / steps;
}

TEST(Precipitation, FallsFromThickCloudOnly) {
  RainCause cause = kDrizzle;
  EXPECT_GT(mean_rain_mm_h(cause), 0.1);
  cause.cloud = 0.5;
  cause.lift = 3.0;
  EXPECT_EQ(mean_rain_mm_h(cause), 0.0);
}

TEST(Precipitation, GrowsWithEachCause) {
  const double reference_mm_h = mean_rain_mm_h(kDrizzle);
  const auto changed = [](auto&& change) {
    RainCause cause = kDrizzle;
    change(cause);
    return mean_rain_mm_h(cause);
  };
  EXPECT_GT(changed([](RainCause& c) { c.cloud = 1.0; }), reference_mm_h);
  EXPECT_GT(changed([](RainCause& c) { c.lift = 1.0; }), reference_mm_h);
  EXPECT_GT(changed([](RainCause& c) { c.convection = 1.0; }), reference_mm_h);
  EXPECT_GT(changed([](RainCause& c) { c.moisture_K = 5.0; }), reference_mm_h);
  EXPECT_LT(changed([](RainCause& c) { c.dryness_K = 10.0; }), reference_mm_h);
}

// Intensity enters as a factor: exp(0.7 + ln 2) is twice exp(0.7).
TEST(Precipitation, IntensityScalesTheAmount) {
  RainHabit heavy = habit();
  heavy.log_intensity = SeasonalCurve(0.7 + std::log(2.0));
  EXPECT_NEAR(mean_rain_mm_h(kDrizzle, heavy) / mean_rain_mm_h(kDrizzle), 2.0, 0.02);
}

TEST(Snow, FallsBelowEightTenthsOfADegreeForTheMostPart) {
  EXPECT_EQ(snow_share(-12.0), 1.0);
  EXPECT_EQ(snow_share(0.0), 1.0);
  EXPECT_DOUBLE_EQ(snow_share(0.8), 0.5);
  EXPECT_EQ(snow_share(1.6), 0.0);
  EXPECT_EQ(snow_share(20.0), 0.0);
}

TEST(Snow, LiesUnchangedInColdCloudyAir) {
  SnowCover snow;
  snow.advance(4.0,
               {.air_C = -5.0, .sky_C = -8.0, .wind_speed_m_s = 4.0, .global_horizontal_W_m2 = 0.0},
               kHour_s);
  for (int hour = 0; hour < 100; ++hour) {
    snow.advance(0.0, {-5.0, -8.0, 4.0, 60.0}, kHour_s);
  }
  EXPECT_EQ(snow.water_mm(), 4.0);
}

// By hand: 20 mm, air 4 degC, sky 0 degC, wind 4 m/s, sun 200 W/m²:
// 0.3 · 200 + (2 + 1.5 · 4) · 4 = 92 W/m², times 3600 s over 334 kJ/kg: 0.9916 kg/m² an hour.
TEST(Snow, MeltsByTheEnergyThatReachesIt) {
  SnowCover snow;
  const MeltWeather frost{-10.0, -10.0, 0.0, 0.0};
  const MeltWeather thaw{4.0, 0.0, 4.0, 200.0};
  snow.advance(20.0, frost, kHour_s);
  snow.advance(0.0, thaw, kHour_s);
  EXPECT_NEAR(snow.water_mm(), 20.0 - 0.9916, 1e-4);
  // Half the ground covered: half the melt.
  SnowCover thin;
  thin.advance(5.0, frost, kHour_s);
  thin.advance(0.0, thaw, kHour_s);
  EXPECT_NEAR(thin.water_mm(), 5.0 - 0.5 * 0.9916, 1e-4);
}

TEST(Snow, ThawEndsACover) {
  SnowCover snow;
  snow.advance(30.0, {-3.0, -8.0, 3.0, 0.0}, kHour_s);
  for (int hour = 0; hour < 24 * 30; ++hour) snow.advance(0.0, {8.0, 2.0, 3.0, 150.0}, kHour_s);
  EXPECT_EQ(snow.water_mm(), 0.0);
  EXPECT_EQ(snow.ground_reflectance(), 0.2);
}

TEST(Snow, BrightensTheGround) {
  SnowCover snow;
  EXPECT_EQ(snow.ground_reflectance(), 0.2);
  snow.advance(5.0, {-10.0, -20.0, 2.0, 0.0}, kHour_s);
  EXPECT_NEAR(snow.ground_reflectance(), 0.45, 1e-12);
  snow.advance(25.0, {-10.0, -20.0, 2.0, 0.0}, kHour_s);
  EXPECT_NEAR(snow.ground_reflectance(), 0.7, 1e-12);
}

}  // namespace
}  // namespace recald::simulators::precipitation_test
