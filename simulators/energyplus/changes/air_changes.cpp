#include <algorithm>
#include <cmath>

#include "simulators/energyplus/changes/changes.hpp"

namespace recald::simulators::energyplus::changes {
namespace {

bool takes_outdoor_air(const BuildingYear& building) {
  Json model = building.model();
  return scale_outdoor_air(model, 1.0) > 0;
}

/// The flows that a handler's controller moves between are known.
bool has_damper(const BuildingYear& building) {
  return has_object(building.model(), "Controller:OutdoorAir", [](const Json& object) {
    return object.value("maximum_outdoor_air_flow_rate", Json()).is_number();
  });
}

bool has_scheduled_outdoor_air(const BuildingYear& building) {
  return building.has(Role::outdoor_air) && building.has(Role::presence);
}

bool has_economiser(const BuildingYear& building) {
  return has_object(building.model(), "Controller:OutdoorAir", [](const Json& object) {
    return object.value("economizer_control_type", "NoEconomizer") != "NoEconomizer";
  });
}

bool has_fixed_changeover(const BuildingYear& building) {
  return has_object(building.model(), "Controller:OutdoorAir", [](const Json& object) {
    return object.value("economizer_control_type", "") == "FixedDryBulb";
  });
}

bool has_slowing_fans(const BuildingYear& building) {
  return has_object(building.model(), "Fan:VariableVolume");
}

bool has_slowing_pumps(const BuildingYear& building) {
  return has_object(building.model(), "Pump:VariableSpeed");
}

bool has_supply_schedule(const BuildingYear& building) {
  return building.has(Role::supply_temperature);
}

bool has_reset(const BuildingYear& building) {
  for (const std::string& name : building.names_of(Role::supply_temperature)) {
    const auto [least, most] = std::ranges::minmax(building.schedule(name));
    if (most - least >= 1.5) return true;
  }
  return false;
}

bool has_heaters_in_cold_air(const BuildingYear& building) {
  const bool has_heaters = has_object(building.model(), "AirTerminal:SingleDuct:VAV:Reheat") ||
                           has_object(building.model(), "ZoneHVAC:FourPipeFanCoil");
  return has_heaters && !heating_fuel(building.model()).empty();
}

void outdoor_air_amount(BuildingYear& building, double share, Rng /*rng*/) {
  scale_outdoor_air(building.model(), 1.0 + share);
}

void damper_stuck_open(BuildingYear& building, double share, Rng /*rng*/) {
  for_each_object(building.model(), "Controller:OutdoorAir", [&](Json& controller) {
    const Json most = controller.value("maximum_outdoor_air_flow_rate", Json());
    const Json least = controller.value("minimum_outdoor_air_flow_rate", Json());
    if (!most.is_number() || !least.is_number()) return;
    controller["minimum_outdoor_air_flow_rate"] =
        std::max(least.get<double>(), share * most.get<double>());
    // A share of what is supplied, however much that is.
    controller["minimum_limit_type"] = "ProportionalMinimum";
  });
  building.change(Role::outdoor_air, [](std::size_t, std::size_t, double) { return 1.0; });
}

void demand_ventilation(BuildingYear& building, double share, Rng /*rng*/) {
  const Quarters presence = building.schedule(building.names_of(Role::presence).front());
  const double most = std::max(*std::ranges::max_element(presence), 1e-6);
  building.change(Role::outdoor_air, [&](std::size_t day, std::size_t quarter, double value) {
    return value * (1.0 - share + share * presence[day * kQuartersPerDay + quarter] / most);
  });
}

void economiser_failed(BuildingYear& building, double /*share*/, Rng /*rng*/) {
  for_each_object(building.model(), "Controller:OutdoorAir", [&](Json& controller) {
    controller["economizer_control_type"] = "NoEconomizer";
  });
}

void economiser_changeover(BuildingYear& building, double shift_K, Rng /*rng*/) {
  for_each_object(building.model(), "Controller:OutdoorAir", [&](Json& controller) {
    if (controller.value("economizer_control_type", "") != "FixedDryBulb") return;
    Json& limit = controller["economizer_maximum_limit_dry_bulb_temperature"];
    limit = limit.get<double>() + shift_K;
  });
}

/// A curve of part load that leans towards full power at all loads.
void lean_to_full(Json& object, const char* first, std::initializer_list<const char*> rest,
                  double share) {
  object[first] = (1.0 - share) * object.value(first, 0.0) + share;
  for (const char* coefficient : rest) {
    object[coefficient] = (1.0 - share) * object.value(coefficient, 0.0);
  }
}

void constant_speed_fans(BuildingYear& building, double share, Rng /*rng*/) {
  for_each_object(building.model(), "Fan:VariableVolume", [&](Json& fan) {
    lean_to_full(fan, "fan_power_coefficient_1",
                 {"fan_power_coefficient_2", "fan_power_coefficient_3", "fan_power_coefficient_4",
                  "fan_power_coefficient_5"},
                 share);
  });
}

void constant_flow_pumps(BuildingYear& building, double share, Rng /*rng*/) {
  for_each_object(building.model(), "Pump:", [&](Json& pump) {
    if (share > 0.5) pump["pump_control_type"] = "Continuous";
  });
  for_each_object(building.model(), "Pump:VariableSpeed", [&](Json& pump) {
    // What is left out is a straight line through nothing.
    if (!pump.contains("coefficient_2_of_the_part_load_performance_curve")) {
      pump["coefficient_2_of_the_part_load_performance_curve"] = 1.0;
    }
    lean_to_full(pump, "coefficient_1_of_the_part_load_performance_curve",
                 {"coefficient_2_of_the_part_load_performance_curve",
                  "coefficient_3_of_the_part_load_performance_curve",
                  "coefficient_4_of_the_part_load_performance_curve"},
                 share);
  });
}

void deep_drying(BuildingYear& building, double colder_K, Rng /*rng*/) {
  constexpr double kHumid_kg_kg = 0.0095;
  building.change(Role::supply_temperature,
                  [&](std::size_t day, std::size_t quarter, double value) {
                    const bool is_humid =
                        building.weather_at(day, quarter).at_end.air.humidity_kg_kg > kHumid_kg_kg;
                    return is_humid ? value - colder_K : value;
                  });
}

/// Least flows of heaters will not do: EnergyPlus still mixes to what the room asks for. So the
/// heat that leaks goes into the rooms while air is blown in, and the heat meter counts it.
void simultaneous_heating_cooling(BuildingYear& building, double W_m2, Rng /*rng*/) {
  Quarters leaks(building.days().size() * kQuartersPerDay, building.has(Role::fans) ? 0.0 : 1.0);
  for (const std::string& name : building.names_of(Role::fans)) {
    const Quarters& runs = building.schedule(name);
    for (std::size_t i = 0; i < leaks.size(); ++i) leaks[i] = std::max(leaks[i], runs[i]);
  }
  const std::string schedule = building.add_schedule("Heaters leak", std::move(leaks));
  const std::string zones = add_zone_list(building.model());
  building.model()["OtherEquipment"]["Heaters leak"] = {
      {"fuel_type", heating_fuel(building.model())},
      {"zone_or_zonelist_or_space_or_spacelist_name", zones},
      {"schedule_name", schedule},
      {"design_level_calculation_method", "Watts/Area"},
      {"power_per_floor_area", W_m2}};
}

void supply_reset_missing(BuildingYear& building, double colder_K, Rng /*rng*/) {
  for (const std::string& name : building.names_of(Role::supply_temperature)) {
    Quarters& quarters = building.schedule(name);
    const double least = *std::ranges::min_element(quarters);
    for (double& value : quarters) value = std::max(value - colder_K, least);
  }
}

}  // namespace

void add_air_changes(std::vector<HiddenChange>& all) {
  all.insert(all.end(),
             {{"outdoor_air_amount", -0.6, 1.5, "", takes_outdoor_air, outdoor_air_amount,
               Course::at_once, kDated},
              {"damper_stuck_open", 0.25, 0.9, "", has_damper, damper_stuck_open},
              {"demand_ventilation", 0.3, 1.0, "", has_scheduled_outdoor_air, demand_ventilation},
              {"economiser_failed", 1.0, 1.0, "", has_economiser, economiser_failed},
              {"economiser_changeover", -8.0, 8.0, "", has_fixed_changeover, economiser_changeover},
              {"constant_speed_fans", 0.3, 1.0, "", has_slowing_fans, constant_speed_fans},
              {"constant_flow_pumps", 0.3, 1.0, "", has_slowing_pumps, constant_flow_pumps},
              {"deep_drying", 1.0, 4.0, "K", has_supply_schedule, deep_drying},
              {"simultaneous_heating_cooling", 0.5, 15.0, "W/m2 of floor", has_heaters_in_cold_air,
               simultaneous_heating_cooling},
              {"supply_reset_missing", 1.0, 4.0, "K", has_reset, supply_reset_missing}});
}

}  // namespace recald::simulators::energyplus::changes
