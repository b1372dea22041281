#include "simulators/building/envelope.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::simulators::envelope_test {
namespace {

Outdoors still_night(double air_C) {
  Outdoors outdoors{};
  outdoors.air = {air_C, 0.006};
  outdoors.pressure_Pa = 98'000.0;
  outdoors.sky_temperature_C = air_C;
  outdoors.sky = {0.0, 0.0, 1361.0};
  outdoors.sun = {0.0, -0.5, -0.5};
  return outdoors;
}

const std::vector<double> kNoAirHandlers(3, 0.0);
const EnvelopeOperation kAsBuilt;

TEST(Envelope, EmptyBuildingInSteadyWeatherGoesToThatTemperature) {
  Truth truth = draw_truth({}, 1);
  truth.ground_C = 12.0;
  Envelope envelope(truth, {20.0, 0.006});
  for (int step = 0; step < 24 * 400; ++step) {
    const auto& effects = envelope.expose(still_night(12.0), kNoAirHandlers, kAsBuilt);
    for (std::size_t zone = 0; zone < envelope.zones().size(); ++zone) {
      EXPECT_EQ(effects[zone].transmitted_sun_W, 0.0);
      ZoneLoads loads;
      loads.infiltration_kg_s = effects[zone].infiltration_kg_s;
      loads.outdoor = {12.0, 0.006};
      envelope.zones()[zone].advance(loads, 3600.0);
    }
  }
  for (const Zone& zone : envelope.zones()) EXPECT_NEAR(zone.air().temperature_C, 12.0, 0.05);
}

TEST(Envelope, ConstructionAreasAreThoseOfTheDrawings) {
  double wall_and_window_m2 = 0.0;
  double roof_m2 = 0.0;
  const Envelope envelope(draw_truth({}, 1), {20.0, 0.006});
  for (std::size_t zone = 0; zone < envelope.zones().size(); ++zone) {
    const Zone& room = envelope.zones()[zone];
    if (zone % kZonesPerStorey <= west) {
      wall_and_window_m2 += room.surface(room.surface_count() - 1).area_m2 +
                            room.surface(room.surface_count() - 2).area_m2;
    }
    if (zone / kZonesPerStorey == 2) roof_m2 += room.surface(1).area_m2;
    double shares = 0.0;
    for (std::size_t i = 0; i < room.surface_count(); ++i) shares += room.surface(i).solar_share;
    EXPECT_NEAR(shares, 1.0, 1e-12);
  }
  EXPECT_NEAR(wall_and_window_m2, 2.0 * (65.0 + 40.0) * 3.0 * 4.2, 1e-9);
  EXPECT_NEAR(roof_m2, 2600.0, 1e-9);
}

TEST(Envelope, WindPressesAirInOnTheWindwardSideOnly) {
  Envelope envelope(draw_truth({}, 1), {12.0, 0.006});
  Outdoors windy = still_night(12.0);
  windy.wind_speed_m_s = 10.0;
  windy.wind_from_deg = 180.0;
  const auto& effects = envelope.expose(windy, kNoAirHandlers, kAsBuilt);
  EXPECT_GT(effects[south].infiltration_kg_s, 0.1);
  EXPECT_EQ(effects[north].infiltration_kg_s, 0.0);
  EXPECT_EQ(effects[core].infiltration_kg_s, 0.0);
}

TEST(Envelope, StackDrawsColdAirInBelow) {
  Envelope envelope(draw_truth({}, 1), {21.0, 0.006});
  const auto effects = envelope.expose(still_night(-5.0), kNoAirHandlers, kAsBuilt);
  const std::size_t top = 2 * kZonesPerStorey + south;
  EXPECT_GT(effects[south].infiltration_kg_s, 0.0);
  EXPECT_EQ(effects[top].infiltration_kg_s, 0.0);
}

TEST(Envelope, PressurisedStoreyLeaksLess) {
  Envelope envelope(draw_truth({}, 1), {21.0, 0.006});
  const auto off = envelope.expose(still_night(-5.0), kNoAirHandlers, kAsBuilt);
  const auto on = envelope.expose(still_night(-5.0), {1.0, 1.0, 1.0}, kAsBuilt);
  EXPECT_LT(on[south].infiltration_kg_s, off[south].infiltration_kg_s);
}

// By hand, on a still night 25 K colder than a hall 8 m high: 2.3 Pa from warm air above the lower
// cracks and 0.5 Pa of suction through half of all cracks, those of the core's roof among them.
TEST(Envelope, HallsLeakOverTheirHeightAndThroughAllOfTheirRoof) {
  Drawings drawings;
  drawings.storeys = 1;
  drawings.storey_height_m = 8.0;
  drawings.hall = true;
  Truth truth = draw_truth(drawings, 1);
  truth.leakage_cm2_m2 = 2.0;
  Envelope envelope(truth, {20.0, 0.006});
  const auto effects = envelope.expose(still_night(-5.0), {0.0}, kAsBuilt);
  double flow_kg_s = 0.0;
  for (const EnvelopeEffect& effect : effects) flow_kg_s += effect.infiltration_kg_s;
  const double density = density_kg_m3(-5.0, 98'000.0);
  const double lower_Pa = 0.5 + density * 9.81 * 2.0 * 25.0 / 268.15;
  const double cracks_m2 = 2e-4 * (2.0 * (65.0 + 40.0) * 8.0 + 65.0 * 40.0);
  EXPECT_NEAR(flow_kg_s,
              density * 0.5 * cracks_m2 * std::sqrt(8.0 / density) * std::pow(lower_Pa / 4.0, 0.65),
              1e-3 * flow_kg_s);
  EXPECT_EQ(effects[core].infiltration_kg_s, 0.0);
}

TEST(Envelope, SouthWindowsSeeTheWinterSun) {
  Envelope envelope(draw_truth({}, 1), {21.0, 0.006});
  Outdoors noon = still_night(8.0);
  noon.sun = {0.0, -0.83, 0.557};
  noon.sky = {800.0, 90.0, 1400.0};
  const auto& effects = envelope.expose(noon, kNoAirHandlers, kAsBuilt);
  EXPECT_GT(effects[south].transmitted_sun_W, 3.0 * effects[north].transmitted_sun_W);
  // Never more than falls on the glass.
  EXPECT_LT(effects[south].transmitted_sun_W, 0.35 * 65.0 * 4.2 * (800.0 + 90.0 + 200.0));
}

// By hand: 0.6 · 2 m² · sqrt(2 · 1.2 kg/m³ · 20 Pa) is some 8 kg/s; only the side of the opening.
TEST(Envelope, OpeningsAndShaftsAddTheirOwnFlow) {
  Envelope envelope(draw_truth({}, 1), {21.0, 0.006});
  Outdoors windy = still_night(5.0);
  windy.wind_speed_m_s = 10.0;
  windy.wind_from_deg = 180.0;
  const auto plain = envelope.expose(windy, kNoAirHandlers, kAsBuilt);
  EnvelopeOperation open;
  open.opening_m2[south] = 2.0;
  const auto through_door = envelope.expose(windy, kNoAirHandlers, open);
  const double added_kg_s = through_door[south].infiltration_kg_s - plain[south].infiltration_kg_s;
  EXPECT_GT(added_kg_s, 4.0);
  EXPECT_LT(added_kg_s, 12.0);
  EXPECT_EQ(through_door[north].infiltration_kg_s, plain[north].infiltration_kg_s);

  EnvelopeOperation shaft;
  shaft.shaft_m2 = 1.0;
  const auto winter = envelope.expose(windy, kNoAirHandlers, shaft);
  const std::size_t top = 2 * kZonesPerStorey + south;
  EXPECT_GT(winter[south].infiltration_kg_s, plain[south].infiltration_kg_s);
  EXPECT_EQ(winter[top].infiltration_kg_s, plain[top].infiltration_kg_s);
  const auto hot_plain = envelope.expose(still_night(35.0), kNoAirHandlers, kAsBuilt);
  const auto hot = envelope.expose(still_night(35.0), kNoAirHandlers, shaft);
  EXPECT_GT(hot[top].infiltration_kg_s, hot_plain[top].infiltration_kg_s);
}

TEST(Envelope, SkylightLightsTheCoreBelowTheRoof) {
  Drawings drawings;
  drawings.skylight_share = 0.1;
  Envelope envelope(draw_truth(drawings, 1), {21.0, 0.006});
  Outdoors noon = still_night(8.0);
  noon.sun = {0.0, -0.5, 0.866};
  noon.sky = {800.0, 90.0, 1400.0};
  const std::size_t top_core = 2 * kZonesPerStorey + core;
  const auto bright = envelope.expose(noon, kNoAirHandlers, kAsBuilt);
  EXPECT_GT(bright[top_core].transmitted_sun_W, 0.0);
  EXPECT_EQ(bright[core].transmitted_sun_W, 0.0);
  EnvelopeOperation snowed;
  snowed.skylight_factor = 0.25;
  const auto dark = envelope.expose(noon, kNoAirHandlers, snowed);
  EXPECT_NEAR(dark[top_core].transmitted_sun_W, 0.25 * bright[top_core].transmitted_sun_W, 1e-6);
}

}  // namespace
}  // namespace recald::simulators::envelope_test
