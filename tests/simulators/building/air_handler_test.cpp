#include "simulators/building/air_handler.hpp"

#include <gtest/gtest.h>

namespace recald::simulators::air_handler_test {
namespace {

AirHandlerDesign design() {
  return {.supply_kg_s = 8.0,
          .outdoor_kg_s = 3.0,
          .supply_C = 13.0,
          .supply_reset_K = 0.0,
          .preheat_W = 200e3,
          .coil = {.capacity_W = 400e3,
                   .design_flow_kg_s = 8.0,
                   .design_bypass_factor = 0.08,
                   .lowest_apparatus_dew_point_C = 8.5},
          .fan = {.design_W = 15e3, .idle_share = 0.1, .exponent = 2.3, .share_in_airstream = 0.7},
          .economiser_limit_C = std::nullopt};
}

constexpr AirHandlerCommand kVentilate{AirHandlerMode::ventilate, 1.0, 1.0};
constexpr AirHandlerCommand kRecirculate{AirHandlerMode::recirculate, 0.0, 1.0};

BoxDemand zone_at(double felt_C) { return {{felt_C, 0.008}, felt_C, 24.0, 21.0, 1.5}; }

AirHandlerWork run_for_an_hour(AirHandler& handler, const AirHandlerCommand& command,
                               const BoxDemand& demand, const AirState& outdoor) {
  AirHandlerWork work;
  for (int i = 0; i < 12; ++i) {
    work = handler.advance(command, std::span(&demand, 1), outdoor, 98'000.0, 300.0);
  }
  return work;
}

// First law around mixing box, coils and fan.
TEST(AirHandler, EnergyAndWaterBalanceClose) {
  for (const AirState outdoor :
       {AirState{33.0, 0.017}, AirState{2.0, 0.003}, AirState{15.0, 0.009}}) {
    SCOPED_TRACE(outdoor.temperature_C);
    AirHandler handler(design(), {{8.0, 0.4, 100e3}});
    const AirHandlerWork work = run_for_an_hour(handler, kVentilate, zone_at(24.3), outdoor);
    const double air_W =
        work.supply_kg_s * (enthalpy_J_kg(work.supply) - enthalpy_J_kg(work.mixed));
    const double off_coil_C =
        work.supply.temperature_C -
        work.fan_to_air_W / (work.supply_kg_s * heat_capacity_J_kgK(work.supply));
    const double drained_W = work.condensate_kg_s * kWaterHeat_J_kgK * off_coil_C;
    EXPECT_NEAR(air_W, work.preheat_W + work.fan_to_air_W - work.cooling_W - drained_W,
                1e-6 * (work.cooling_W + work.preheat_W + 1.0));
    EXPECT_NEAR(work.condensate_kg_s,
                work.supply_kg_s * (work.mixed.humidity_kg_kg - work.supply.humidity_kg_kg), 1e-12);
  }
}

TEST(AirHandler, SuppliesAtItsSetPointWhileCooling) {
  AirHandler handler(design(), {{8.0, 0.4, 100e3}});
  const AirHandlerWork work = run_for_an_hour(handler, kVentilate, zone_at(24.5), {33.0, 0.016});
  EXPECT_NEAR(work.supply.temperature_C, 13.0, 0.02);
  EXPECT_EQ(work.preheat_W, 0.0);
  EXPECT_NEAR(work.outdoor_kg_s, 3.0, 1e-12);
}

TEST(AirHandler, WarmZoneGetsMoreAirAndColdZoneGetsReheat) {
  AirHandler handler(design(), {{8.0, 0.4, 100e3}});
  const AirHandlerWork warm = run_for_an_hour(handler, kVentilate, zone_at(25.5), {28.0, 0.012});
  EXPECT_NEAR(warm.supply_kg_s, 8.0, 0.05);
  EXPECT_NEAR(warm.reheat_W, 0.0, 50.0);
  const AirHandlerWork idle = run_for_an_hour(handler, kVentilate, zone_at(22.5), {28.0, 0.012});
  EXPECT_NEAR(idle.supply_kg_s, 0.4 * 8.0, 0.05);
  const AirHandlerWork cold = run_for_an_hour(handler, kVentilate, zone_at(20.0), {28.0, 0.012});
  EXPECT_GT(cold.reheat_W, 50e3);
  EXPECT_GT(cold.cooling_W, 0.0);  // summer reheat: the coil still dries and cools
}

TEST(AirHandler, NoMixtureNeedsBothCoils) {
  for (double outdoor_C = -10.0; outdoor_C <= 38.0; outdoor_C += 1.0) {
    AirHandler handler(design(), {{8.0, 0.4, 100e3}});
    const AirHandlerWork work =
        run_for_an_hour(handler, kVentilate, zone_at(22.5), {outdoor_C, 0.001});
    EXPECT_TRUE(work.preheat_W == 0.0 || work.cooling_W == 0.0) << outdoor_C << " degC";
  }
}

TEST(AirHandler, SupplyIsNeverLessThanTheOutdoorAir) {
  AirHandlerDesign much = design();
  much.outdoor_kg_s = 5.0;
  AirHandler handler(much, {{8.0, 0.2, 100e3}});
  const AirHandlerWork work = run_for_an_hour(handler, kVentilate, zone_at(22.5), {20.0, 0.010});
  EXPECT_NEAR(work.supply_kg_s, 5.0, 1e-9);
  EXPECT_NEAR(work.outdoor_kg_s, 5.0, 1e-9);
}

TEST(AirHandler, NightCycleTakesNoOutdoorAirAndDoesNotCoolWhatItWarms) {
  AirHandler handler(design(), {{8.0, 0.4, 100e3}});
  const AirHandlerWork work = run_for_an_hour(handler, kRecirculate, zone_at(16.0), {-5.0, 0.002});
  EXPECT_EQ(work.outdoor_kg_s, 0.0);
  EXPECT_EQ(work.cooling_W, 0.0);
  EXPECT_GT(work.reheat_W, 10e3);
}

TEST(AirHandler, OffMeansNothingMoves) {
  AirHandler handler(design(), {{8.0, 0.4, 100e3}});
  run_for_an_hour(handler, kVentilate, zone_at(26.0), {30.0, 0.012});
  const AirHandlerWork work =
      run_for_an_hour(handler, {AirHandlerMode::off, 0.0, 1.0}, zone_at(26.0), {30.0, 0.012});
  EXPECT_EQ(work.supply_kg_s, 0.0);
  EXPECT_EQ(work.fan_W, 0.0);
  EXPECT_EQ(work.cooling_W, 0.0);
  EXPECT_EQ(handler.supplies()[0].kg_s, 0.0);
}

TEST(AirHandler, EconomiserSavesCoolingInCoolWeatherOnly) {
  AirHandlerDesign with = design();
  with.economiser_limit_C = 18.0;
  for (const double outdoor_C : {10.0, 15.0, 25.0}) {
    AirHandler plain(design(), {{8.0, 0.4, 100e3}});
    AirHandler saving(with, {{8.0, 0.4, 100e3}});
    const AirState outdoor{outdoor_C, 0.005};
    const double plain_W = run_for_an_hour(plain, kVentilate, zone_at(25.0), outdoor).cooling_W;
    const double saving_W = run_for_an_hour(saving, kVentilate, zone_at(25.0), outdoor).cooling_W;
    if (outdoor_C < 18.0) {
      EXPECT_LT(saving_W, 0.8 * plain_W) << outdoor_C << " degC";
    } else {
      EXPECT_DOUBLE_EQ(saving_W, plain_W);
    }
  }
}

TEST(Fan, PowerRisesSteeplyWithFlow) {
  const Fan fan{.design_W = 10e3, .idle_share = 0.1, .exponent = 2.0, .share_in_airstream = 1.0};
  EXPECT_EQ(fan.power_W(0.0), 0.0);
  EXPECT_NEAR(fan.power_W(0.5), 10e3 * (0.1 + 0.9 * 0.25), 1e-9);
  EXPECT_NEAR(fan.power_W(1.0), 10e3, 1e-9);
}

}  // namespace
}  // namespace recald::simulators::air_handler_test
