#include "simulators/energyplus/model_edits.hpp"

#include <algorithm>
#include <array>

namespace recald::simulators::energyplus {

bool has_object(const Json& model, std::string_view type) {
  for (const auto& [of, objects] : model.items()) {
    if (of.starts_with(type) && !objects.empty()) return true;
  }
  return false;
}

std::size_t scale(Json& model, std::string_view type,
                  std::initializer_list<std::string_view> fields, double factor) {
  std::size_t count = 0;
  for_each_object(model, type, [&](Json& object) {
    for (const std::string_view field : fields) {
      const auto at = object.find(std::string{field});
      if (at == object.end() || !at->is_number()) continue;
      *at = factor * at->get<double>();
      ++count;
    }
  });
  return count;
}

std::size_t scale_people(Json& model, double factor) {
  return scale(model, "People", {"number_of_people", "people_per_floor_area"}, factor) +
         scale(model, "People", {"floor_area_per_person"}, 1.0 / factor);
}

std::size_t scale_lights(Json& model, double factor) {
  return scale(model, "Lights", {"lighting_level", "watts_per_floor_area", "watts_per_person"},
               factor);
}

std::size_t scale_equipment(Json& model, double factor) {
  return scale(model, "ElectricEquipment",
               {"design_level", "watts_per_floor_area", "watts_per_person"}, factor);
}

std::size_t scale_infiltration(Json& model, double factor) {
  return scale(
      model, "ZoneInfiltration:",
      {"design_flow_rate", "flow_rate_per_floor_area", "flow_rate_per_exterior_surface_area",
       "air_changes_per_hour", "effective_air_leakage_area"},
      factor);
}

std::size_t scale_outdoor_air(Json& model, double factor) {
  std::size_t count =
      scale(model, "Controller:OutdoorAir", {"minimum_outdoor_air_flow_rate"}, factor) +
      scale(model, "ZoneHVAC:",
            {"maximum_outdoor_air_flow_rate", "cooling_outdoor_air_flow_rate",
             "heating_outdoor_air_flow_rate", "no_load_outdoor_air_flow_rate"},
            factor);
  for_each_object(model, "Controller:OutdoorAir", [](Json& of) {
    const Json& most = of["maximum_outdoor_air_flow_rate"];
    Json& least = of["minimum_outdoor_air_flow_rate"];
    // No more than all of the air.
    if (most.is_number() && least.is_number()) {
      least = std::min(least.get<double>(), most.get<double>());
    }
  });
  // A mechanical ventilation controller asks for what the zones' specifications say, and so does
  // ideal air.
  if (has_object(model, "Controller:MechanicalVentilation") ||
      has_object(model, "ZoneHVAC:IdealLoadsAirSystem")) {
    count += scale(model, "DesignSpecification:OutdoorAir",
                   {"outdoor_air_flow_per_person", "outdoor_air_flow_per_zone_floor_area",
                    "outdoor_air_flow_per_zone", "outdoor_air_flow_air_changes_per_hour"},
                   factor);
  }
  return count;
}

std::size_t scale_cooling_cop(Json& model, double factor) {
  return scale(model, "Coil:Cooling:",
               {"gross_rated_cooling_cop", "high_speed_gross_rated_cooling_cop",
                "low_speed_gross_rated_cooling_cop"},
               factor) +
         scale(model, "Chiller:", {"reference_cop", "nominal_cop"}, factor) +
         scale(model, "AirConditioner:VariableRefrigerantFlow", {"gross_rated_cooling_cop"},
               factor);
}

std::size_t scale_solar_gain(Json& model, double factor) {
  std::size_t count = 0;
  for_each_object(model, "WindowMaterial:SimpleGlazingSystem", [&](Json& glazing) {
    constexpr double kMost = 0.87;
    Json& gain = glazing["solar_heat_gain_coefficient"];
    gain = std::min(factor * gain.get<double>(), kMost);
    ++count;
  });
  return count;
}

std::string add_zone_list(Json& model) {
  constexpr const char* kName = "All zones that are kept warm";
  Json zones = Json::array();
  for_each_object(model, "ZoneHVAC:EquipmentConnections", [&](const Json& connections) {
    zones.push_back({{"zone_name", connections.value("zone_name", "")}});
  });
  model["ZoneList"][kName]["zones"] = std::move(zones);
  return kName;
}

void add_equipment(BuildingYear& building, const std::string& name, double W_m2,
                   const std::string& schedule) {
  const std::string zones = add_zone_list(building.model());
  building.model()["ElectricEquipment"][name] = {
      {"zone_or_zonelist_or_space_or_spacelist_name", zones},
      {"schedule_name", schedule},
      {"design_level_calculation_method", "Watts/Area"},
      {"watts_per_floor_area", W_m2},
      {"fraction_radiant", 0.3}};
}

void add_outside_load(BuildingYear& building, const std::string& name, const char* fuel,
                      double power_W, const std::string& schedule) {
  building.model()["Exterior:FuelEquipment"][name] = {
      {"fuel_use_type", fuel}, {"schedule_name", schedule}, {"design_level", power_W}};
}

std::string heating_fuel(const Json& model) {
  // Where a boiler stands beside ideal air, the boiler heats most.
  for (const auto& [type, objects] : model.items()) {
    if (!type.starts_with("Boiler:") && !type.starts_with("Coil:Heating:Fuel") &&
        !type.starts_with("Coil:Heating:Gas")) {
      continue;
    }
    for (const auto& [name, object] : objects.items()) {
      if (object.value("fuel_type", "NaturalGas") == "NaturalGas") return "NaturalGas";
    }
  }
  const bool is_district =
      has_object(model, "DistrictHeating:Water") || has_object(model, "ZoneHVAC:IdealLoads");
  return is_district ? "DistrictHeatingWater" : "";
}

void stretch_day(double* values, int before, int after, bool keep_largest) {
  constexpr auto kLast = static_cast<int>(kQuartersPerDay) - 1;
  // Longer: a quarter hour takes the day's value from one within reach; shorter: it loses it to
  // one.
  const auto pass = [&](int quarters, int direction) {
    const bool largest = quarters > 0 ? keep_largest : !keep_largest;
    const int step = quarters > 0 ? direction : -direction;
    std::array<double, kQuartersPerDay> old{};
    std::copy_n(values, kQuartersPerDay, old.begin());
    for (int at = 0; at <= kLast; ++at) {
      for (int i = 1; i <= std::abs(quarters); ++i) {
        const int from = at + step * i;
        if (from < 0 || from > kLast) break;
        const double other = old[static_cast<std::size_t>(from)];
        values[at] = largest ? std::max(values[at], other) : std::min(values[at], other);
      }
    }
  };
  pass(before, 1);
  pass(after, -1);
}

}  // namespace recald::simulators::energyplus
