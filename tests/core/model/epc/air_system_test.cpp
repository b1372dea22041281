#include "core/model/epc/air_system.hpp"

#include <gtest/gtest.h>

namespace recald::model::epc::air_system_test {
namespace {

constexpr double kHeatCapacity_J_m3K = 1200.0;

AirSystem worked_system() {
  return {.outdoor_air_m3_s = 1.5,
          .supply_flow_design_m3_s = 10.0,
          .supply_flow_min_m3_s = 2.5,
          .supply_temperature_C = 13.0};
}

BoxLimits worked_limits() { return {.supply_C = 13.0, .least_m3_s = 2.5, .most_m3_s = 10.0}; }

ZoneDemand worked_demand() {
  return {.cooling_load_W = 40e3,
          .shortage_W = 0.0,
          .conductance_W_K = 2000.0,
          .cooling_set_point_C = 24.0,
          .heating_set_point_C = 21.0};
}

// One hour by hand: V_s = 40 kW / (1200 · 11 K); coil = 40 kW + 1200 · 1.5 · 6 K.
TEST(AirSystem, WorkedHour) {
  const BoxRates box = box_rates(worked_limits(), kHeatCapacity_J_m3K, worked_demand());
  EXPECT_NEAR(box.flow_m3_s, 3.030303, 1e-6);
  EXPECT_NEAR(box.heating_W, 0.0, 1e-9);
  EXPECT_NEAR(box.zone_C, 24.0, 1e-12);
  const HandlerRates handler =
      handler_rates(worked_system(), kHeatCapacity_J_m3K, 1.0, box.flow_m3_s, box.zone_C, 30.0);
  EXPECT_NEAR(handler.coil_W, 50800.0, 1e-6);
}

// Whatever the regime, the zone's heat balance closes: supply air takes out load, shortage and
// drift; the boxes put in the rest.
TEST(AirSystem, ZoneBalanceClosesInEveryRegime) {
  for (const double load_W : {0.0, 5e3, 20e3, 33e3, 90e3}) {
    for (const double shortage_W : {0.0, 15e3, 80e3}) {
      if (load_W > 0.0 && shortage_W > 0.0) continue;
      SCOPED_TRACE(::testing::Message() << load_W << " " << shortage_W);
      ZoneDemand demand = worked_demand();
      demand.cooling_load_W = load_W;
      demand.shortage_W = shortage_W;
      const BoxRates r = box_rates(worked_limits(), kHeatCapacity_J_m3K, demand);
      const double supply_W = kHeatCapacity_J_m3K * r.flow_m3_s * (r.zone_C - 13.0);
      const double drift_W = demand.conductance_W_K * (24.0 - r.zone_C);
      EXPECT_NEAR(r.heating_W + load_W + drift_W - shortage_W, supply_W, 1e-6);
      EXPECT_GE(r.zone_C, 21.0 - 1e-12);
      EXPECT_LE(r.zone_C, 24.0);
      if (r.zone_C > 21.0 + 1e-9) {
        EXPECT_NEAR(r.heating_W, 0.0, 1e-6);
      }
    }
  }
}

TEST(AirSystem, CoilOrPreheatIsTheWayFromMixedToSupplyAir) {
  for (const double outdoor_C : {-10.0, 8.0, 20.0, 35.0}) {
    SCOPED_TRACE(outdoor_C);
    const HandlerRates r =
        handler_rates(worked_system(), kHeatCapacity_J_m3K, 1.0, 4.0, 23.0, outdoor_C);
    const double mixed_C = 23.0 + 1.5 / 4.0 * (outdoor_C - 23.0);
    EXPECT_NEAR(r.coil_W - r.preheat_W, kHeatCapacity_J_m3K * 4.0 * (mixed_C - 13.0), 1e-6);
    EXPECT_EQ(r.coil_W * r.preheat_W, 0.0);
  }
}

TEST(AirSystem, MinimumFlowReheatsOnlyAtTheHeatingSetPoint) {
  ZoneDemand demand = worked_demand();
  demand.cooling_load_W = 20e3;  // minimum flow brings 33 kW: 13 kW too much
  const BoxRates floating = box_rates(worked_limits(), kHeatCapacity_J_m3K, demand);
  // A drop of 3 K takes (2000 + 3000) W/K · 3 K = 15 kW: enough, no reheat.
  EXPECT_EQ(floating.heating_W, 0.0);
  EXPECT_NEAR(floating.zone_C, 24.0 - 13e3 / 5000.0, 1e-9);
  demand.heating_set_point_C = 23.0;
  EXPECT_NEAR(box_rates(worked_limits(), kHeatCapacity_J_m3K, demand).heating_W, 13e3 - 5e3, 1e-6);
}

TEST(AirSystem, EconomiserOpensAsFarAsTheSupplyTemperatureAsks) {
  AirSystem system = worked_system();
  const auto at = [&](double outdoor_C) {
    return handler_rates(system, kHeatCapacity_J_m3K, 1.0, 4.0, 23.0, outdoor_C);
  };
  const HandlerRates without = at(10.0);
  EXPECT_GT(without.coil_W, 0.0);
  system.economiser_lockout_C = 18.0;
  EXPECT_NEAR(at(10.0).coil_W, 0.0, 1e-6);
  EXPECT_NEAR(at(10.0).preheat_W, 0.0, 1e-6);
  EXPECT_NEAR(at(10.0).outdoor_air_share, 10.0 / 13.0, 1e-12);
  EXPECT_NEAR(at(18.0).outdoor_air_share, without.outdoor_air_share, 1e-12);  // at the lock-out
}

TEST(AirSystem, FanHeatReachesTheCoilAndFewerHandlersDrawLess) {
  AirSystem system = worked_system();
  const auto at = [&](double running) {
    return handler_rates(system, kHeatCapacity_J_m3K, running, 5.0, 24.0, 30.0);
  };
  const HandlerRates cool = at(1.0);
  system.fan_design_kW = 20.0;
  const HandlerRates warm = at(1.0);
  EXPECT_NEAR(warm.coil_W - cool.coil_W, warm.fan_W, 1e-6);
  EXPECT_NEAR(warm.fan_W, 20e3 * fan_power_share(0.5), 1e-9);
  EXPECT_NEAR(at(0.4).fan_W, 0.4 * warm.fan_W, 1e-9);
  EXPECT_NEAR(at(0.4).coil_W, 0.4 * warm.coil_W, 1e-6);
}

TEST(AirSystem, FanCurveEndsNearOneAndNearZero) {
  EXPECT_NEAR(fan_power_share(1.0), 0.9991, 1e-12);
  EXPECT_NEAR(fan_power_share(0.0), 0.0013, 1e-12);
}

}  // namespace
}  // namespace recald::model::epc::air_system_test
