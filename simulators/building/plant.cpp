#include "simulators/building/plant.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/climate/air.hpp"

namespace recald::simulators {
namespace {

constexpr double kKelvin = 273.15;
constexpr double kChilledWaterPumps = 0.65;  ///< Of all pumps' power, if there is chilled water.

double variable_speed(double part_load) {
  return 0.18 + 0.82 * std::pow(std::min(1.0, part_load), 2.2);
}

}  // namespace

Plant::Plant(const Truth& truth, double step_s, Rng rng)
    : truth_(truth), rng_(rng), taps_(1800.0, step_s, rng_) {}

double Plant::hot_water_W(double awake_share, const PlantOperation& operation) {
  const Drawings& drawings = truth_.drawings;
  // Glass washers and hand basins: most of the day's water is used while people are in.
  const double daily_shape = 0.25 + drawings.hot_water_with_people * awake_share;
  const double taps = std::max(0.0, 1.0 + 0.45 * taps_.advance(rng_));
  const double flow_kg_s =
      operation.hot_water_factor * truth_.hot_water_m3_day * 1000.0 / 86'400.0 * daily_shape * taps;
  const double mains_C = drawings.mains_C + operation.mains_shift_K;
  return flow_kg_s * kWaterHeat_J_kgK * (drawings.hot_water_C - mains_C) /
         drawings.hot_water_efficiency;
}

double Plant::pumps_W(const ServiceLoad& load, const PlantOperation& operation) const {
  const Drawings& drawings = truth_.drawings;
  const bool loop_never_stops = drawings.core_runs_always || drawings.perimeter_runs_always;
  const auto speed = [&](double load_W, double design_kW) {
    const bool turns = load_W > 0.0 || loop_never_stops;
    const double following = turns ? variable_speed(load_W / (1000.0 * design_kW)) : 0.0;
    return following + (1.0 - operation.pumps_follow_load) * (1.0 - following);
  };
  const double heating = speed(load.heating_W, drawings.heating_design_kW);
  const double both =
      drawings.cooling == CoolingPlant::packaged
          ? heating
          : kChilledWaterPumps * speed(load.cooling_W, drawings.chilled_water_design_kW) +
                0.35 * heating;
  return 1000.0 * truth_.pump_kW * both + operation.pumps_always_W;
}

/// A chiller's condenser follows the tower's wet bulb, the condenser of packaged units
/// the outdoor air.
Plant::Lift Plant::lift_of(const Outdoors& outdoors) const {
  if (truth_.drawings.cooling == CoolingPlant::packaged) {
    // Rated at 35 degC outdoors (AHRI 340/360); two to four compressors in stages.
    return {8.0 + kKelvin, 49.0 + kKelvin,
            std::max(25.0, outdoors.air.temperature_C + 14.0) + kKelvin, 0.25};
  }
  const double tower_C = wet_bulb_C(outdoors.air, outdoors.pressure_Pa) + 5.5;
  return {12.0 + kKelvin, 29.4 + kKelvin, std::max(18.0, tower_C) + kKelvin, 0.12};
}

/// Compressor and condenser cooling by the universal chiller model,
/// (Te/Tc)·x = 1 + a/q + b/q·(Tc − Te) + c·q·x with x = 1 + 1/COP and load share q; internal losses
/// dominate at part load, heat exchangers at full load.
/// @see Gordon, Ng (2000), "Cool Thermodynamics", ch. 4.
double Plant::compressor_W(double cooling_W, double cop_factor, const Lift& at) const {
  if (cooling_W <= 0.0) return 0.0;
  constexpr double internal_loss = 0.02;
  constexpr double leak_loss = 0.02;  // at the rated lift
  const double cop = truth_.chiller_cop_scale * truth_.drawings.chiller_cop;
  const double exchanger_loss = at.evaporator_K / at.rated_condenser_K -
                                (1.0 + internal_loss + leak_loss) / (1.0 + 1.0 / cop);
  const double lift = (at.condenser_K - at.evaporator_K) / (at.rated_condenser_K - at.evaporator_K);
  const double share = cooling_W / (1000.0 * truth_.drawings.chilled_water_design_kW);
  const double q = std::max(share, at.least_share);
  const double x = (1.0 + (internal_loss + leak_loss * lift) / q) /
                   (at.evaporator_K / at.condenser_K - exchanger_loss * q);
  return cooling_W * (x - 1.0) / cop_factor;
}

/// Air to water: a share of Carnot's efficiency; resistance heat is added below −5 degC.
double Plant::heat_pump_W(double heating_W, double cop_factor, double outdoor_C) const {
  constexpr double water_C = 45.0;
  const auto carnot = [&](double air_C) {
    return (water_C + kKelvin) / (water_C - std::min(air_C, 20.0) + 6.0);
  };
  const double cop = cop_factor * truth_.heat_pump_cop_scale * truth_.drawings.heat_pump_cop *
                     carnot(outdoor_C) / carnot(8.3);
  const double resistance_share = std::clamp((-5.0 - outdoor_C) / 15.0, 0.0, 1.0);
  return heating_W * ((1.0 - resistance_share) / cop + resistance_share);
}

/// Chilled water with pipe losses, or the heat that packaged units take from the air.
double Plant::cooling_kW(const ServiceLoad& load, double pumps_W,
                         const PlantOperation& operation) const {
  // If a store could give more than is needed, it keeps the rest.
  if (truth_.drawings.cooling == CoolingPlant::packaged) {
    return std::max(0.0, load.cooling_W + operation.cooling_shift_W) / 1000.0;
  }
  const double pump_heat_W = kChilledWaterPumps * 0.8 * pumps_W;
  const double cooling_W = std::max(0.0, load.cooling_W * (1.0 + truth_.chilled_water_loss_share) +
                                             pump_heat_W + operation.cooling_shift_W);
  return cooling_W / 1000.0 + truth_.chilled_water_standing_kW +
         operation.chilled_water_standing_W / 1000.0;
}

UtilityPower Plant::advance(const ServiceLoad& load, const PlantOperation& operation,
                            const Outdoors& outdoors) {
  const Drawings& drawings = truth_.drawings;
  const double pumps_W_now = pumps_W(load, operation);
  const double exterior_W = load.dark ? 1000.0 * truth_.exterior_kW : 0.0;
  const double hot_water_W_now = hot_water_W(load.awake_share, operation);
  double electricity_W =
      load.lights_and_plugs_W + load.fans_W + pumps_W_now + exterior_W + load.other_electricity_W;
  const double cooling_kW_now = cooling_kW(load, pumps_W_now, operation);
  double heat_kW = 0.0;
  if (drawings.heating == HeatingPlant::heat_pump) {
    const double standing_W = 1000.0 * truth_.heating_standing_kW + operation.heating_standing_W;
    electricity_W += heat_pump_W(load.heating_W + standing_W, operation.heat_pump_cop_factor,
                                 outdoors.air.temperature_C) +
                     hot_water_W_now + load.other_fuel_W;
  } else {
    const double heating_W = load.heating_W + hot_water_W_now;
    heat_kW = heating_W / heating_efficiency(heating_W) / 1000.0 + truth_.heating_standing_kW +
              (operation.heating_standing_W + load.other_fuel_W) / 1000.0;
  }
  if (drawings.cooling != CoolingPlant::district) {
    electricity_W +=
        compressor_W(1000.0 * cooling_kW_now, operation.chiller_cop_factor, lift_of(outdoors));
  }
  return {electricity_W / 1000.0, cooling_kW_now, heat_kW};
}

double Plant::heating_efficiency(double heating_W) const {
  if (truth_.drawings.heating != HeatingPlant::boiler) return truth_.heating_efficiency;
  // At low load burners start and stop, and purging loses their heat up the chimney.
  const double idle = 1.0 - std::min(1.0, heating_W / (1000.0 * truth_.drawings.heating_design_kW));
  return truth_.heating_efficiency * (1.0 - 0.06 * idle * idle * idle);
}

}  // namespace recald::simulators
