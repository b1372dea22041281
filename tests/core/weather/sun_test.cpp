/// The sun against an almanac's facts, and irradiance against hand calculations.
#include "core/weather/sun.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::weather {
namespace {

using metering::Instant;
using std::chrono::minutes;

constexpr Location kAtlanta{33.65, -84.43, 300.0};
constexpr Location kSydney{-33.87, 151.21, 20.0};
constexpr Location kGreenwich{51.48, 0.0, 50.0};
constexpr double kObliquity_deg = 23.44;  // declination at the solstices

Instant midnight_utc(int year, unsigned month, unsigned day) {
  return std::chrono::sys_days{std::chrono::year{year} / std::chrono::month{month} /
                               std::chrono::day{day}};
}

double zenith_deg(const SunPosition& sun) {
  return std::acos(sun.cos_zenith) * 180.0 / std::numbers::pi;
}

/// The minute of the 24 h from `begin` on in which the sun stands highest.
Instant highest_sun(Instant begin, const Location& location) {
  Instant best = begin;
  for (Instant t = begin; t < begin + std::chrono::hours{24}; t += minutes{1}) {
    if (sun_position(t, location).cos_zenith > sun_position(best, location).cos_zenith) best = t;
  }
  return best;
}

/// The first minute after `begin` at which the sun is above the horizon, having been below.
Instant sunrise(Instant begin, const Location& location) {
  Instant t = begin;
  while (sun_position(t, location).cos_zenith > 0.0) t += minutes{1};
  while (sun_position(t, location).cos_zenith <= 0.0) t += minutes{1};
  return t;
}

TEST(SunPosition, NoonZenithIsLatitudeLessDeclination) {
  struct Case {
    const char* what;
    Location place;
    Instant day;
    double declination_deg;
  };
  const Case cases[] = {
      {"Atlanta, June", kAtlanta, midnight_utc(2021, 6, 21), kObliquity_deg},
      {"Atlanta, December", kAtlanta, midnight_utc(2021, 12, 21), -kObliquity_deg},
      {"Atlanta, March", kAtlanta, midnight_utc(2021, 3, 20), 0.0},
      {"Atlanta, September of a leap year", kAtlanta, midnight_utc(2020, 9, 22), 0.0},
      {"Sydney, June", kSydney, midnight_utc(2021, 6, 20), kObliquity_deg},
      {"Sydney, December", kSydney, midnight_utc(2021, 12, 21), -kObliquity_deg},
      {"Greenwich, June", kGreenwich, midnight_utc(2021, 6, 21), kObliquity_deg},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    const SunPosition noon = sun_position(highest_sun(c.day, c.place), c.place);
    EXPECT_NEAR(zenith_deg(noon), std::abs(c.place.latitude_deg - c.declination_deg), 0.5);
    // Seen from the north of the sun's path, noon is due south; from the south of it, due north.
    const double facing = c.place.latitude_deg > c.declination_deg ? -1.0 : 1.0;
    EXPECT_NEAR(std::cos(noon.azimuth_deg * std::numbers::pi / 180.0), facing, 1e-3);
  }
}

// The equation of time: -14.2 min on 11 February, +16.4 min on 3 November.
TEST(SunPosition, NoonComesLateInFebruaryAndEarlyInNovember) {
  const Instant february = midnight_utc(2021, 2, 11);
  const Instant november = midnight_utc(2021, 11, 3);
  const auto after_twelve = [](Instant day) {
    return (highest_sun(day, kGreenwich) - day - std::chrono::hours{12}).count() / 60;
  };
  EXPECT_NEAR(static_cast<double>(after_twelve(february)), 14.2, 1.6);
  EXPECT_NEAR(static_cast<double>(after_twelve(november)), -16.4, 1.6);
}

// Four minutes a degree; in the middle of April the equation of time is nothing.
TEST(SunPosition, NoonMovesWithTheLongitude) {
  const Instant april = midnight_utc(2021, 4, 15);
  const auto noon_min = [&](const Location& place) {
    return static_cast<double>((highest_sun(april, place) - april).count()) / 60.0;
  };
  EXPECT_NEAR(noon_min(kAtlanta), 12 * 60 + 4.0 * 84.43, 1.6);
  EXPECT_NEAR(noon_min(kSydney), 12 * 60 - 4.0 * 151.21, 1.6);
}

// cos(azimuth) = sin(declination) / cos(latitude) on the horizon.
TEST(SunPosition, RisesInTheEastAndSetsInTheWest) {
  const Instant equinox = midnight_utc(2021, 3, 20) + std::chrono::hours{5};
  EXPECT_NEAR(sun_position(sunrise(equinox, kAtlanta), kAtlanta).azimuth_deg, 90.0, 1.0);
  const Instant solstice = midnight_utc(2021, 6, 21) + std::chrono::hours{5};
  const Instant rise = sunrise(solstice, kAtlanta);
  EXPECT_NEAR(sun_position(rise, kAtlanta).azimuth_deg, 61.5, 1.0);
  const Instant noon = highest_sun(midnight_utc(2021, 6, 21), kAtlanta);
  EXPECT_NEAR(sun_position(noon + (noon - rise), kAtlanta).azimuth_deg, 360.0 - 61.5, 1.0);
}

TEST(SunPosition, IsBelowTheHorizonAtNightAndAllDayInPolarNight) {
  for (unsigned month = 1; month <= 12; ++month) {
    const Instant noon = highest_sun(midnight_utc(2021, month, 15), kAtlanta);
    EXPECT_LT(sun_position(noon + std::chrono::hours{12}, kAtlanta).cos_zenith, 0.0) << month;
  }
  constexpr Location tromso{69.65, 18.96, 0.0};
  const Instant noon = highest_sun(midnight_utc(2021, 12, 21), tromso);
  EXPECT_LT(sun_position(noon, tromso).cos_zenith, 0.0);
}

/// New Year's Day, so that the sun is nearest: 1367 · 1.033 W/m² outside the atmosphere.
const Instant kNewYear = midnight_utc(2021, 1, 1);
constexpr double kExtraterrestrial_W_m2 = 1367.0 * 1.033;

double diffuse_share(double clearness) {
  const SunPosition sun{0.5, 180.0};
  const double global_W_m2 = clearness * kExtraterrestrial_W_m2 * sun.cos_zenith;
  return split_global_horizontal(global_W_m2, sun, kNewYear).diffuse_horizontal_W_m2 / global_W_m2;
}

TEST(SplitGlobalHorizontal, FollowsErbsInItsThreePieces) {
  EXPECT_NEAR(diffuse_share(0.10), 1.0 - 0.009, 1e-9);
  // 0.9511 − 0.1604 k + 4.388 k² − 16.638 k³ + 12.336 k⁴ at k = 0.3 and 0.5
  EXPECT_NEAR(diffuse_share(0.30), 0.9511 - 0.04812 + 0.39492 - 0.449226 + 0.0999216, 1e-9);
  EXPECT_NEAR(diffuse_share(0.50), 0.9511 - 0.0802 + 1.0970 - 2.07975 + 0.7710, 1e-9);
  EXPECT_NEAR(diffuse_share(0.90), 0.165, 1e-9);
}

TEST(SplitGlobalHorizontal, IsContinuousWhereThePiecesMeet) {
  EXPECT_NEAR(diffuse_share(0.22 - 1e-9), diffuse_share(0.22 + 1e-9), 0.001);
  // The published polynomial ends at 0.175 where the constant is 0.165.
  EXPECT_NEAR(diffuse_share(0.80 - 1e-9), diffuse_share(0.80 + 1e-9), 0.011);
}

TEST(SplitGlobalHorizontal, PartsAddUpAndAreNeverNegative) {
  for (const double cos_zenith : {-0.3, 0.0, 0.04, 0.06, 0.3, 1.0}) {
    for (const double global_W_m2 : {0.0, 1.0, 50.0, 400.0, 1100.0}) {
      const SunPosition sun{cos_zenith, 120.0};
      const SplitIrradiance sky = split_global_horizontal(global_W_m2, sun, kNewYear);
      EXPECT_GE(sky.direct_normal_W_m2, 0.0);
      EXPECT_GE(sky.diffuse_horizontal_W_m2, 0.0);
      EXPECT_NEAR(sky.direct_normal_W_m2 * cos_zenith + sky.diffuse_horizontal_W_m2, global_W_m2,
                  1e-9);
    }
  }
}

TEST(SplitGlobalHorizontal, LowSunIsAllDiffuseAndASensorsNightOffsetIsNothing) {
  const SplitIrradiance dawn = split_global_horizontal(20.0, {0.03, 90.0}, kNewYear);
  EXPECT_EQ(dawn.direct_normal_W_m2, 0.0);
  EXPECT_EQ(dawn.diffuse_horizontal_W_m2, 20.0);
  const SplitIrradiance night = split_global_horizontal(-4.0, {-0.5, 0.0}, kNewYear);
  EXPECT_EQ(night.direct_normal_W_m2, 0.0);
  EXPECT_EQ(night.diffuse_horizontal_W_m2, 0.0);
}

constexpr SplitIrradiance kSky{600.0, 100.0};
constexpr SunPosition kSunInSouth{0.8, 180.0};  // sin(zenith) = 0.6
constexpr double kGlobal_W_m2 = 600.0 * 0.8 + 100.0;

TEST(IrradianceOn, AFlatRoofSeesTheGlobalHorizontal) {
  for (const double azimuth_deg : {0.0, 90.0, 213.0}) {
    EXPECT_NEAR(irradiance_on_W_m2({azimuth_deg, 0.0}, kSky, kGlobal_W_m2, kSunInSouth),
                kGlobal_W_m2, 1e-9);
  }
}

TEST(IrradianceOn, WallsSeeHalfTheSkyHalfTheGroundAndPerhapsTheSun) {
  const double around_W_m2 = 0.5 * 100.0 + 0.5 * 0.2 * kGlobal_W_m2;
  const auto wall = [](double azimuth_deg) {
    return irradiance_on_W_m2({azimuth_deg, 90.0}, kSky, kGlobal_W_m2, kSunInSouth);
  };
  EXPECT_NEAR(wall(180.0), around_W_m2 + 600.0 * 0.6, 1e-9);
  EXPECT_NEAR(wall(120.0), around_W_m2 + 600.0 * 0.6 * 0.5, 1e-9);
  EXPECT_NEAR(wall(240.0), wall(120.0), 1e-9);
  EXPECT_NEAR(wall(0.0), around_W_m2, 1e-9);
}

TEST(IrradianceOn, ItIsTheAngleBetweenSunAndSurfaceThatCounts) {
  const SunPosition morning{0.8, 100.0};
  const double around_W_m2 = 0.5 * 100.0 + 0.5 * 0.2 * kGlobal_W_m2;
  EXPECT_NEAR(irradiance_on_W_m2({100.0, 90.0}, kSky, kGlobal_W_m2, morning),
              around_W_m2 + 600.0 * 0.6, 1e-9);
  EXPECT_NEAR(irradiance_on_W_m2({160.0, 90.0}, kSky, kGlobal_W_m2, morning),
              around_W_m2 + 600.0 * 0.6 * 0.5, 1e-9);
}

TEST(IrradianceOn, APlaneThatFacesTheSunSeesTheWholeBeam) {
  const double tilt_deg = zenith_deg(kSunInSouth);  // cos(tilt) = 0.8
  EXPECT_NEAR(irradiance_on_W_m2({180.0, tilt_deg}, kSky, kGlobal_W_m2, kSunInSouth),
              600.0 + 100.0 * 0.9 + 0.2 * kGlobal_W_m2 * 0.1, 1e-9);
}

TEST(IrradianceOn, IsNeverNegativeAndDownwardsOnlyGround) {
  for (double azimuth_deg = 0.0; azimuth_deg < 360.0; azimuth_deg += 45.0) {
    for (double tilt_deg = 0.0; tilt_deg <= 180.0; tilt_deg += 15.0) {
      EXPECT_GE(irradiance_on_W_m2({azimuth_deg, tilt_deg}, kSky, kGlobal_W_m2, {-0.2, 300.0}),
                0.0);
    }
  }
  EXPECT_NEAR(irradiance_on_W_m2({0.0, 180.0}, kSky, kGlobal_W_m2, kSunInSouth), 0.2 * kGlobal_W_m2,
              1e-9);
}

}  // namespace
}  // namespace recald::weather
