#include "simulators/building/envelope.hpp"

#include <gtest/gtest.h>

namespace recald::simulators {
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

constexpr std::array<bool, drawings::storeys> kNoAirHandlers{};

TEST(Envelope, EmptyBuildingInSteadyWeatherGoesToThatTemperature) {
  Truth truth = draw_truth(1);
  truth.ground_C = 12.0;
  Envelope envelope(truth, {20.0, 0.006});
  for (int step = 0; step < 24 * 400; ++step) {
    const auto& effects = envelope.expose(still_night(12.0), kNoAirHandlers);
    for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
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
  const Envelope envelope(draw_truth(1), {20.0, 0.006});
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
    const Zone& room = envelope.zones()[zone];
    if (zone % drawings::zones_per_storey <= drawings::west) {
      wall_and_window_m2 += room.surface(room.surface_count() - 1).area_m2 +
                            room.surface(room.surface_count() - 2).area_m2;
    }
    if (zone / drawings::zones_per_storey == drawings::storeys - 1)
      roof_m2 += room.surface(1).area_m2;
    double shares = 0.0;
    for (std::size_t i = 0; i < room.surface_count(); ++i) shares += room.surface(i).solar_share;
    EXPECT_NEAR(shares, 1.0, 1e-12);
  }
  EXPECT_NEAR(wall_and_window_m2, 2.0 * (65.0 + 40.0) * 3.0 * 4.2, 1e-9);
  EXPECT_NEAR(roof_m2, 2600.0, 1e-9);
}

TEST(Envelope, WindPressesAirInOnTheWindwardSideOnly) {
  Envelope envelope(draw_truth(1), {12.0, 0.006});
  Outdoors windy = still_night(12.0);
  windy.wind_speed_m_s = 10.0;
  windy.wind_from_deg = 180.0;
  const auto& effects = envelope.expose(windy, kNoAirHandlers);
  EXPECT_GT(effects[drawings::south].infiltration_kg_s, 0.1);
  EXPECT_EQ(effects[drawings::north].infiltration_kg_s, 0.0);
  EXPECT_EQ(effects[drawings::laboratory].infiltration_kg_s, 0.0);
}

TEST(Envelope, StackDrawsColdAirInBelow) {
  Envelope envelope(draw_truth(1), {21.0, 0.006});
  const auto effects = envelope.expose(still_night(-5.0), kNoAirHandlers);
  const std::size_t top = 2 * drawings::zones_per_storey + drawings::south;
  EXPECT_GT(effects[drawings::south].infiltration_kg_s, 0.0);
  EXPECT_EQ(effects[top].infiltration_kg_s, 0.0);
}

TEST(Envelope, PressurisedStoreyLeaksLess) {
  Envelope envelope(draw_truth(1), {21.0, 0.006});
  const auto off = envelope.expose(still_night(-5.0), kNoAirHandlers);
  const auto on = envelope.expose(still_night(-5.0), {true, true, true});
  EXPECT_LT(on[drawings::south].infiltration_kg_s, off[drawings::south].infiltration_kg_s);
}

TEST(Envelope, SouthWindowsSeeTheWinterSun) {
  Envelope envelope(draw_truth(1), {21.0, 0.006});
  Outdoors noon = still_night(8.0);
  noon.sun = {0.0, -0.83, 0.557};
  noon.sky = {800.0, 90.0, 1400.0};
  const auto& effects = envelope.expose(noon, kNoAirHandlers);
  EXPECT_GT(effects[drawings::south].transmitted_sun_W,
            3.0 * effects[drawings::north].transmitted_sun_W);
  // Never more than falls on the glass.
  EXPECT_LT(effects[drawings::south].transmitted_sun_W, 0.35 * 65.0 * 4.2 * (800.0 + 90.0 + 200.0));
}

}  // namespace
}  // namespace recald::simulators
