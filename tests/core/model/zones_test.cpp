#include "core/model/zones.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/sample_building.hpp"

namespace recald::model::zones_test {
namespace {

using testing::sample_building;

std::vector<weather::Orientation> orientations() {
  return {{0.0, 90.0}, {90.0, 90.0}, {180.0, 90.0}, {270.0, 90.0}, {0.0, 0.0}};
}

std::vector<Zone> zones_of(const Building& building) {
  std::vector<Zone> zones(zone_count(building, orientations()));
  for (Zone& zone : zones) zone.solar_aperture_m2.resize(orientations().size());
  describe_zones(building, orientations(), zones);
  return zones;
}

// 550 m² of façade over three storeys of 4 m is 45.83 m long; 4.57 m deep, corners once:
// 4.57 · (45.83 − 4.57) · 3 = 565.7 m² of 5000 m² on each side.
TEST(Zones, PerimeterByHand) {
  const auto zones = zones_of(sample_building());
  ASSERT_EQ(zones.size(), 5u);
  for (int side = 0; side < 4; ++side) {
    EXPECT_NEAR(zones[static_cast<std::size_t>(side)].floor_share,
                4.57 * (550.0 / 12.0 - 4.57) * 3.0 / 5000.0, 1e-12);
  }
  EXPECT_NEAR(zones[4].floor_share, 1.0 - 4.0 * zones[0].floor_share, 1e-12);
}

// Cutting a building moves nothing in or out of it.
TEST(Zones, PartsAddUpToTheWhole) {
  Building building = sample_building();
  const auto parts = zones_of(building);
  building.air.reset();
  const auto whole = zones_of(building);
  ASSERT_EQ(whole.size(), 1u);
  const auto sum = [&](double Zone::*member) {
    return std::accumulate(parts.begin(), parts.end(), 0.0,
                           [&](double total, const Zone& zone) { return total + zone.*member; });
  };
  for (double Zone::*member : {&Zone::floor_share, &Zone::transmission_W_K, &Zone::ground_W_K,
                               &Zone::sky_loss_W, &Zone::leakage_cm2}) {
    EXPECT_NEAR(sum(member), whole[0].*member, 1e-9 * std::abs(whole[0].*member));
  }
  for (std::size_t k = 0; k < orientations().size(); ++k) {
    double aperture_m2 = 0.0;
    for (const Zone& zone : parts) aperture_m2 += zone.solar_aperture_m2[k];
    EXPECT_NEAR(aperture_m2, whole[0].solar_aperture_m2[k], 1e-9);
  }
}

TEST(Zones, FacadesSeeTheirOwnSunOnly) {
  const auto zones = zones_of(sample_building());
  EXPECT_GT(zones[2].solar_aperture_m2[2], 0.0);
  EXPECT_EQ(zones[2].solar_aperture_m2[0], 0.0);
  EXPECT_EQ(zones[4].solar_aperture_m2[2], 0.0);
  EXPECT_GT(zones[4].solar_aperture_m2[4], 0.0);  // the core's share of the roof
}

TEST(Zones, SmallBuildingKeepsACore) {
  Building building = sample_building();
  building.floor_area_m2 = 1200.0;
  EXPECT_NEAR(zones_of(building).back().floor_share, 0.05, 1e-12);
}

TEST(Zones, LeakageByHand) {
  // One storey, 20 K and 4 m/s: √(1.45e-4·20 + 1.74e-4·16) L/s a cm².
  EXPECT_NEAR(leakage_flow(1).per_area_m3_s(-20.0, 16.0),
              1e-3 * std::sqrt(1.45e-4 * 20.0 + 1.74e-4 * 16.0), 1e-15);
  EXPECT_EQ(leakage_flow(9).wind_coefficient, leakage_flow(3).wind_coefficient);
}

}  // namespace
}  // namespace recald::model::zones_test
