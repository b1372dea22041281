#include "simulators/building/zone.hpp"

#include <gtest/gtest.h>

#include <array>

namespace recald::simulators::zone_test {
namespace {

Zone small_room(double start_C) {
  const std::array<Layer, 2> wall{Layer{0.06, 0.035, 4e4, 1}, Layer{0.15, 0.9, 1.6e6, 3}};
  const std::array<Layer, 1> mass{Layer{0.1, 1.6, 2.1e6, 2}};
  std::vector<ZoneSurface> surfaces;
  surfaces.push_back({Wall(wall, start_C), 30.0, 0.3});
  surfaces.push_back({Wall::massless(start_C), 10.0, 0.1});
  surfaces.push_back({Wall(mass, start_C), 50.0, 0.6});
  return Zone(std::move(surfaces), 150.0, {start_C, 0.008});
}

TEST(Zone, WithoutGainsOrDifferencesNothingHappens) {
  Zone zone = small_room(20.0);
  zone.set_outer_side(0, {15.0, 20.0, 0.0});
  zone.set_outer_side(1, {2.0, 20.0, 0.0});
  for (int i = 0; i < 1000; ++i) zone.advance({}, 300.0);
  EXPECT_NEAR(zone.air().temperature_C, 20.0, 1e-9);
  EXPECT_NEAR(zone.radiant_C(), 20.0, 1e-9);
  EXPECT_NEAR(zone.air().humidity_kg_kg, 0.008, 1e-15);
}

TEST(Zone, UnheatedRoomGoesToTheOutdoorTemperature) {
  Zone zone = small_room(25.0);
  zone.set_outer_side(0, {15.0, 3.0, 0.0});
  zone.set_outer_side(1, {2.0, 3.0, 0.0});
  ZoneLoads loads;
  loads.infiltration_kg_s = 0.01;
  loads.outdoor = {3.0, 0.004};
  for (int i = 0; i < 30'000; ++i) zone.advance(loads, 300.0);
  EXPECT_NEAR(zone.air().temperature_C, 3.0, 1e-6);
  EXPECT_NEAR(zone.air().humidity_kg_kg, 0.004, 1e-9);
}

TEST(Zone, HeatBalanceClosesEveryStep) {
  Zone zone = small_room(18.0);
  for (int i = 0; i < 2000; ++i) {
    zone.set_outer_side(0, {10.0 + i % 5, 5.0 + i % 17, 10.0 * (i % 11)});
    zone.set_outer_side(1, {2.0, 5.0 + i % 17, 30.0 * (i % 2)});
    ZoneLoads loads;
    loads.convective_W = 400.0 * (i % 3);
    loads.radiant_W = 900.0 * (i % 4);
    loads.supply_kg_s = 0.05 * (i % 2);
    loads.supply = {13.0, 0.008};
    loads.infiltration_kg_s = 0.01;
    loads.outdoor = {5.0 + i % 17, 0.006};
    loads.exchange_W = -150.0;
    const double before_J = zone.stored_J();
    const ZoneHeat heat = zone.advance(loads, 300.0);
    ASSERT_NEAR(zone.stored_J() - before_J, heat.total_J(), 1e-9 * zone.stored_J()) << "step " << i;
  }
}

TEST(Zone, MoistureEndsWhereSourcesAndSupplyMeet) {
  Zone zone = small_room(22.0);
  ZoneLoads loads;
  loads.supply_kg_s = 0.2;
  loads.supply = {14.0, 0.0085};
  loads.moisture_kg_s = 2e-4;
  for (int i = 0; i < 20'000; ++i) zone.advance(loads, 300.0);
  EXPECT_NEAR(zone.air().humidity_kg_kg, 0.0085 + 2e-4 / 0.2, 1e-9);
}

TEST(Zone, SunOnTheFloorArrivesLaterThanHeatInTheAir) {
  Zone sunny = small_room(20.0);
  Zone heated = small_room(20.0);
  ZoneLoads sun;
  sun.radiant_W = 2000.0;
  ZoneLoads heat;
  heat.convective_W = 2000.0;
  sunny.advance(sun, 300.0);
  heated.advance(heat, 300.0);
  EXPECT_GT(heated.air().temperature_C, sunny.air().temperature_C + 0.1);
  EXPECT_GT(sunny.air().temperature_C, 20.0);
}

}  // namespace
}  // namespace recald::simulators::zone_test
