#include "simulators/building/plant.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/climate/air.hpp"

namespace recald::simulators {
namespace {

constexpr double kKelvin = 273.15;

double variable_speed(double part_load) {
  return 0.18 + 0.82 * std::pow(std::min(1.0, part_load), 2.2);
}

}  // namespace

Plant::Plant(const Truth& truth, double step_s, Rng rng)
    : truth_(truth), rng_(rng), taps_(1800.0, step_s, rng_) {}

double Plant::hot_water_W(double people_share, const PlantOperation& operation) {
  const Drawings& drawings = truth_.drawings;
  // Glass washers and hand basins: most of the day's water while people are in.
  const double daily_shape = 0.25 + 2.4 * people_share;
  const double taps = std::max(0.0, 1.0 + 0.45 * taps_.advance(rng_));
  const double flow_kg_s =
      operation.hot_water_factor * truth_.hot_water_m3_day * 1000.0 / 86'400.0 * daily_shape * taps;
  const double mains_C = drawings.mains_C + operation.mains_shift_K;
  return flow_kg_s * kWaterHeat_J_kgK * (drawings.hot_water_C - mains_C) /
         drawings.hot_water_efficiency;
}

double Plant::pumps_W(const ServiceLoad& load, const PlantOperation& operation) const {
  const bool loop_never_stops = truth_.drawings.core_runs_always;
  const auto speed = [&](double load_W, double design_kW) {
    const bool turns = load_W > 0.0 || loop_never_stops;
    const double following = turns ? variable_speed(load_W / (1000.0 * design_kW)) : 0.0;
    return following + (1.0 - operation.pumps_follow_load) * (1.0 - following);
  };
  return 1000.0 * truth_.pump_kW *
             (0.65 * speed(load.cooling_W, truth_.drawings.chilled_water_design_kW) +
              0.35 * speed(load.heating_W, truth_.drawings.heating_design_kW)) +
         operation.pumps_always_W;
}

/// Compressor and tower by the universal chiller model, (Te/Tc)·x = 1 + a/q + b/q·(Tc − Te) + c·q·x
/// with x = 1 + 1/COP and load share q; internal losses weigh at part load, heat exchangers at
/// full.
/// @see Gordon, Ng (2000), "Cool Thermodynamics", ch. 4.
double Plant::chiller_W(double cooling_W, double cop_factor, double wet_bulb_C) const {
  if (cooling_W <= 0.0) return 0.0;
  constexpr double evaporator_K = 12.0 + kKelvin;
  constexpr double rated_condenser_K = 29.4 + kKelvin;
  constexpr double internal_loss = 0.02;
  constexpr double leak_loss = 0.02;  // at the rated lift
  constexpr double least_share = 0.12;
  const double cop = truth_.chiller_cop_scale * truth_.drawings.chiller_cop;
  const double exchanger_loss =
      evaporator_K / rated_condenser_K - (1.0 + internal_loss + leak_loss) / (1.0 + 1.0 / cop);
  const double condenser_K = std::max(18.0, wet_bulb_C + 5.5) + kKelvin;
  const double lift = (condenser_K - evaporator_K) / (rated_condenser_K - evaporator_K);
  const double share = cooling_W / (1000.0 * truth_.drawings.chilled_water_design_kW);
  const double q = std::max(share, least_share);  // below, it cycles at this share
  const double x = (1.0 + (internal_loss + leak_loss * lift) / q) /
                   (evaporator_K / condenser_K - exchanger_loss * q);
  return cooling_W * (x - 1.0) / cop_factor;
}

/// Air to water: a share of Carnot's efficiency, resistance heat joins in below −5 degC.
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

UtilityPower Plant::advance(const ServiceLoad& load, const PlantOperation& operation,
                            const Outdoors& outdoors) {
  const Drawings& drawings = truth_.drawings;
  const double pumps_W_now = pumps_W(load, operation);
  const double exterior_W = load.dark ? 1000.0 * truth_.exterior_kW : 0.0;
  const double pump_heat_W = 0.65 * 0.8 * pumps_W_now;
  const double hot_water_W_now = hot_water_W(load.people_share, operation);
  double electricity_W =
      load.lights_and_plugs_W + load.fans_W + pumps_W_now + exterior_W + load.other_electricity_W;
  // A store that gives more than is needed keeps the rest.
  const double cooling_W = std::max(0.0, load.cooling_W * (1.0 + truth_.chilled_water_loss_share) +
                                             pump_heat_W + operation.cooling_shift_W);
  const double cooling_kW = cooling_W / 1000.0 + truth_.chilled_water_standing_kW +
                            operation.chilled_water_standing_W / 1000.0;
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
  if (drawings.cooling == CoolingPlant::chiller) {
    const double wet_bulb = wet_bulb_C(outdoors.air, outdoors.pressure_Pa);
    electricity_W += chiller_W(1000.0 * cooling_kW, operation.chiller_cop_factor, wet_bulb);
  }
  return {electricity_W / 1000.0, cooling_kW, heat_kW};
}

double Plant::heating_efficiency(double heating_W) const {
  if (truth_.drawings.heating != HeatingPlant::boiler) return truth_.heating_efficiency;
  // Little load: burners start and stop, and purge their heat up the chimney.
  const double idle = 1.0 - std::min(1.0, heating_W / (1000.0 * truth_.drawings.heating_design_kW));
  return truth_.heating_efficiency * (1.0 - 0.06 * idle * idle * idle);
}

}  // namespace recald::simulators
