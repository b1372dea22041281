#include "simulators/climate/sun.hpp"

#include <gtest/gtest.h>

namespace recald::simulators::sun_test {
namespace {

using namespace std::chrono;

constexpr Place kAtlanta{33.65, -84.43, 308.0};

// Reda, Andreas (2004), Solar Energy 76(5), table A5.1: zenith 50.11162 degrees (refraction of
// 0.02 degrees included), azimuth 194.34024 degrees.
TEST(Sun, MeetsPublishedExampleOfTheSolarPositionAlgorithm) {
  const Place golden{39.742476, -105.1786, 1830.14};
  const SunPosition sun = sun_position(sys_days{2003y / October / 17} + 19h + 30min + 30s, golden);
  EXPECT_NEAR(90.0 - sun.elevation_deg(), 50.11, 0.04);
  EXPECT_NEAR(sun.azimuth_deg(), 194.34, 0.03);
}

// At solar noon on the solstices the elevation is 90 − latitude ± 23.44.
TEST(Sun, NoonElevationFollowsTheSeasons) {
  double june_deg = -90.0;
  double december_deg = -90.0;
  for (auto minute = 0min; minute < 1440min; ++minute) {
    june_deg = std::max(
        june_deg, sun_position(sys_days{2021y / June / 21} + minute, kAtlanta).elevation_deg());
    december_deg =
        std::max(december_deg,
                 sun_position(sys_days{2021y / December / 21} + minute, kAtlanta).elevation_deg());
  }
  EXPECT_NEAR(june_deg, 90.0 - 33.65 + 23.44, 0.05);
  EXPECT_NEAR(december_deg, 90.0 - 33.65 - 23.44, 0.05);
}

TEST(Sun, RisesInTheEastAndSetsInTheWest) {
  const SunPosition morning = sun_position(sys_days{2021y / March / 20} + 13h, kAtlanta);
  const SunPosition evening = sun_position(sys_days{2021y / March / 20} + 22h, kAtlanta);
  EXPECT_GT(morning.east, 0.8);
  EXPECT_LT(evening.east, -0.8);
  EXPECT_NEAR(morning.east * morning.east + morning.north * morning.north + morning.up * morning.up,
              1.0, 1e-12);
}

TEST(Sun, EarthIsNearestInJanuary) {
  EXPECT_NEAR(extraterrestrial_W_m2(sys_days{2021y / January / 3}), 1361.0 * 1.0340, 1.0);
  EXPECT_NEAR(extraterrestrial_W_m2(sys_days{2021y / July / 4}), 1361.0 * 0.9670, 1.0);
}

TEST(Sun, HorizontalPlaneReceivesTheGlobalRadiation) {
  const SunPosition sun{0.3, -0.4, 0.866};
  const SkyRadiation sky{600.0, 120.0, 1361.0};
  const Irradiance flat = irradiance_on({0.0, 0.0}, sun, sky, 0.2);
  EXPECT_NEAR(flat.total_W_m2(), 600.0 * 0.866 + 120.0, 1e-9);
}

TEST(Sun, WallFacingAwayHasNoBeam) {
  const SunPosition sun{0.0, -0.8, 0.6};  // south
  const SkyRadiation sky{700.0, 100.0, 1361.0};
  const Irradiance north = irradiance_on({0.0, 90.0}, sun, sky, 0.2);
  EXPECT_EQ(north.beam_W_m2, 0.0);
  EXPECT_GT(north.diffuse_W_m2, 0.0);
  EXPECT_NEAR(irradiance_on({180.0, 90.0}, sun, sky, 0.2).beam_W_m2, 700.0 * 0.8, 1e-9);
}

TEST(Sun, GlazingPassesLessAtGrazingIncidence) {
  EXPECT_DOUBLE_EQ(glazing_angle_factor(1.0), 1.0);
  EXPECT_NEAR(glazing_angle_factor(0.5), 1.0 - 0.18, 1e-12);
  EXPECT_EQ(glazing_angle_factor(0.05), 0.0);
  EXPECT_EQ(glazing_angle_factor(0.0), 0.0);
}

}  // namespace
}  // namespace recald::simulators::sun_test
