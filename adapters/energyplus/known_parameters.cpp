#include "adapters/energyplus/known_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include "adapters/energyplus/model/fields.hpp"
#include "adapters/energyplus/model/role_schedules.hpp"
#include "adapters/energyplus/model/rooms.hpp"
#include "core/model/parameter_library.hpp"
#include "core/text/ascii.hpp"
#include "core/text/nearest.hpp"

namespace recald::energyplus {
namespace {

using Pointer = Json::json_pointer;

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kBelowOne = 0.99999;  // where EnergyPlus allows no 1
/// Set-points outside these are ways to say "off".
constexpr double kColdest_C = -40.0;
constexpr double kHottest_C = 60.0;

/// A library name and a place of what it moves, by a factor. A name has several.
struct Spot {
  std::string_view name;
  std::string_view pattern;
  double most = kAny;
  Sense sense = Sense::direct;
};

// clang-format off
constexpr auto kSpots = std::to_array<Spot>({
  {"conductivity_scale", "Material/*/conductivity"},
  {"u_factor_scale", "WindowMaterial:SimpleGlazingSystem/*/u_factor", 7.0},
  {"u_factor_scale", "Construction:FfactorGroundFloor/*/f_factor"},
  {"u_factor_scale", "Construction:CfactorUndergroundWall/*/c_factor"},
  {"shgc_scale", "WindowMaterial:SimpleGlazingSystem/*/solar_heat_gain_coefficient", kBelowOne},
  {"thermal_resistance_scale", "Material:NoMass/*/thermal_resistance"},
  {"thermal_resistance_scale", "Material:AirGap/*/thermal_resistance"},
  {"density_scale", "Material/*/density"},
  {"specific_heat_scale", "Material/*/specific_heat"},
  {"dirt_correction", "WindowMaterial:Glazing/*/dirt_correction_factor_for_solar_and_visible_transmittance", 1.0},
  {"thermal_absorptance_scale", "Material/*/thermal_absorptance", kBelowOne},
  {"thermal_absorptance_scale", "Material:NoMass/*/thermal_absorptance", kBelowOne},
  {"solar_absorptance_scale", "Material/*/solar_absorptance", 1.0},
  {"solar_absorptance_scale", "Material:NoMass/*/solar_absorptance", 1.0},
  {"visible_absorptance_scale", "Material/*/visible_absorptance", 1.0},
  {"visible_absorptance_scale", "Material:NoMass/*/visible_absorptance", 1.0},
  {"infrared_transmittance_scale", "WindowMaterial:Glazing/*/infrared_transmittance_at_normal_incidence", kBelowOne},
  {"infrared_transmittance_scale", "WindowMaterial:Shade/*/infrared_transmittance", kBelowOne},
  {"solar_transmittance_scale", "WindowMaterial:Glazing/*/solar_transmittance_at_normal_incidence", kBelowOne},
  {"solar_transmittance_scale", "WindowMaterial:Shade/*/solar_transmittance", kBelowOne},
  {"visible_transmittance_scale", "WindowMaterial:Glazing/*/visible_transmittance_at_normal_incidence", kBelowOne},
  {"visible_transmittance_scale", "WindowMaterial:SimpleGlazingSystem/*/visible_transmittance", kBelowOne},
  {"visible_transmittance_scale", "WindowMaterial:Shade/*/visible_transmittance", kBelowOne},
  // A pane reflects the long waves that it neither emits nor lets through.
  {"thermal_reflectance_scale", "WindowMaterial:Glazing/*/front_side_infrared_hemispherical_emissivity", kBelowOne, Sense::complement},
  {"thermal_reflectance_scale", "WindowMaterial:Glazing/*/back_side_infrared_hemispherical_emissivity", kBelowOne, Sense::complement},
  {"solar_reflectance_scale", "WindowMaterial:Glazing/*/front_side_solar_reflectance_at_normal_incidence", kBelowOne},
  {"solar_reflectance_scale", "WindowMaterial:Glazing/*/back_side_solar_reflectance_at_normal_incidence", kBelowOne},
  {"solar_reflectance_scale", "WindowMaterial:Shade/*/solar_reflectance", kBelowOne},
  {"visible_reflectance_scale", "WindowMaterial:Glazing/*/front_side_visible_reflectance_at_normal_incidence", kBelowOne},
  {"visible_reflectance_scale", "WindowMaterial:Glazing/*/back_side_visible_reflectance_at_normal_incidence", kBelowOne},
  {"visible_reflectance_scale", "WindowMaterial:Shade/*/visible_reflectance", kBelowOne},
  {"infrared_emissivity_scale", "WindowMaterial:Glazing/*/front_side_infrared_hemispherical_emissivity", kBelowOne},
  {"infrared_emissivity_scale", "WindowMaterial:Glazing/*/back_side_infrared_hemispherical_emissivity", kBelowOne},
  {"infrared_emissivity_scale", "WindowMaterial:Shade/*/infrared_hemispherical_emissivity", kBelowOne},
  {"leakage_area", "ZoneInfiltration:EffectiveLeakageArea/*/effective_air_leakage_area"},
  {"infiltration_scale", "ZoneInfiltration:DesignFlowRate/*/design_flow_rate"},
  {"infiltration_scale", "ZoneInfiltration:DesignFlowRate/*/flow_rate_per_floor_area"},
  {"infiltration_scale", "ZoneInfiltration:DesignFlowRate/*/flow_rate_per_exterior_surface_area"},
  {"infiltration_scale", "ZoneInfiltration:DesignFlowRate/*/air_changes_per_hour"},
  {"infiltration_scale", "ZoneInfiltration:FlowCoefficient/*/flow_coefficient"},
  {"infiltration_scale", "AirflowNetwork:MultiZone:Surface:Crack/*/air_mass_flow_coefficient_at_reference_conditions"},
  {"infiltration_scale", "AirflowNetwork:MultiZone:Surface:EffectiveLeakageArea/*/effective_leakage_area"},
  {"outdoor_airflow", "DesignSpecification:OutdoorAir/*/outdoor_air_flow_*"},
  {"outdoor_airflow", "Controller:OutdoorAir/*/minimum_outdoor_air_flow_rate"},
  {"minimum_supply_flow", "AirTerminal:SingleDuct:VAV:*/*/constant_minimum_air_flow_fraction", 1.0},
  {"minimum_supply_flow", "AirTerminal:SingleDuct:VAV:*/*/fixed_minimum_air_flow_rate"},
  {"heating_efficiency", "Boiler:HotWater/*/nominal_thermal_efficiency", 1.0},
  {"heating_efficiency", "Boiler:Steam/*/theoretical_efficiency", 1.0},
  {"heating_efficiency", "Coil:Heating:Fuel/*/burner_efficiency", 1.0},
  {"heating_efficiency", "Coil:Heating:Gas:MultiStage/*/stage_?_gas_burner_efficiency", 1.0},
  {"heating_efficiency", "ZoneHVAC:HighTemperatureRadiant/*/combustion_efficiency", 1.0},
  {"hot_water_scale", "WaterUse:Equipment/*/peak_flow_rate"},
  {"hot_water_scale", "WaterHeater:*/*/peak_use_flow_rate"},
  {"cooling_cop", "Coil:Cooling:*/*/*cooling_cop"},
  {"cooling_cop", "CoilPerformance:DX:Cooling/*/gross_rated_cooling_cop"},
  {"cooling_cop", "AirConditioner:VariableRefrigerantFlow/*/gross_rated_cooling_cop"},
  {"cooling_cop", "Chiller:*/*/reference_cop"},
  {"cooling_cop", "Chiller:*/*/nominal_cop"},
});

/// What EnergyPlus takes where a field is absent, of those that parameters move.
struct Default {
  std::string_view type;
  const char* field;
  double value;
};
constexpr auto kDefaults = std::to_array<Default>({
  {"Material", "thermal_absorptance", 0.9},
  {"Material", "solar_absorptance", 0.7},
  {"Material", "visible_absorptance", 0.7},
  {"Material:NoMass", "thermal_absorptance", 0.9},
  {"Material:NoMass", "solar_absorptance", 0.7},
  {"Material:NoMass", "visible_absorptance", 0.7},
  {"WindowMaterial:Glazing", "dirt_correction_factor_for_solar_and_visible_transmittance", 1.0},
  {"WindowMaterial:Glazing", "front_side_infrared_hemispherical_emissivity", 0.84},
  {"WindowMaterial:Glazing", "back_side_infrared_hemispherical_emissivity", 0.84},
  {"Coil:Cooling:DX:SingleSpeed", "gross_rated_cooling_cop", 3.0},
  {"Coil:Cooling:DX:CurveFit:Speed", "gross_cooling_cop", 3.0},
  {"Coil:Heating:Fuel", "burner_efficiency", 0.8},
  {"ZoneHVAC:HighTemperatureRadiant", "combustion_efficiency", 0.9},
  {"SetpointManager:Warmest", "minimum_setpoint_temperature", 12.0},
  {"SetpointManager:Warmest", "maximum_setpoint_temperature", 18.0},
});
// clang-format on

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// What a name moves in a model, and its value there; no targets where the model does not have it.
struct Found {
  std::vector<Target> targets;
  double design = 1.0;
  ChangeKind change = ChangeKind::scale;
};

/// Reads one model, for each name in turn.
class Finder {
 public:
  explicit Finder(const Json& objects) : objects_{objects}, rooms_{objects} {}

  [[nodiscard]] Found find(std::string_view name) const {
    if (name == "ground_temperature") return ground();
    if (name == "occupancy_density") return density(rooms_.people());
    if (name == "lighting_power") return density(rooms_.lights());
    if (name == "equipment_power") return density(rooms_.equipment());
    const auto* const role = std::ranges::find(kRoles, name, name_of);
    if (role != std::end(kRoles)) return temperature(*role);
    Found found;
    for (const Spot& spot : kSpots) {
      if (spot.name == name) add(spot, found.targets);
    }
    if (name == "leakage_area") found.design = leakage_cm2_m2(found.targets);
    if (name == "outdoor_airflow") found.design = outdoor_air_m3_s();
    if (name == "minimum_supply_flow") found.design = least_supply_m3_s(found.targets);
    if (name == "heating_efficiency" || name == "cooling_cop") found.design = mean(found.targets);
    if (!(found.design > 0.0)) found.targets.clear();
    return found;
  }

 private:
  [[nodiscard]] double value(const Pointer& field) const {
    return objects_.at(field).get<double>();
  }

  void add(const Spot& spot, std::vector<Target>& targets) const {
    Target target{std::string{spot.pattern}, {}, spot.sense, spot.most};
    for (const Pointer& field : find_fields(objects_, spot.pattern)) {
      if (!objects_.at(field).is_number()) continue;
      const double now = value(field);
      if ((spot.sense == Sense::complement ? 1.0 - now : now) != 0.0) {
        target.fields.push_back(field);
      }
    }
    if (!target.fields.empty()) targets.push_back(std::move(target));
  }

  [[nodiscard]] Found ground() const {
    Found found{.targets = {}, .design = 0.0, .change = ChangeKind::add};
    std::vector<double> months;
    for (const std::string_view type :
         {"Site:GroundTemperature:BuildingSurface", "Site:GroundTemperature:FCfactorMethod"}) {
      add({"", fmt::format("{}/*/*_ground_temperature", type)}, found.targets);
    }
    for (const Target& target : found.targets) {
      for (const Pointer& field : target.fields) months.push_back(value(field));
    }
    if (!months.empty()) found.design = recald::energyplus::mean(months);
    return found;
  }

  [[nodiscard]] Found density(const std::vector<Level>& levels) const {
    Found found{.targets = {}, .design = rooms_.density(levels), .change = ChangeKind::scale};
    if (!(found.design > 0.0)) return found;
    // A target for each type and field, so that patterns can be shown.
    std::map<std::string, Target> targets;
    for (const Level& level : levels) {
      if (value(level.field) == 0.0) continue;
      const std::string field = level.field.back();
      const std::string type = level.field.parent_pointer().parent_pointer().back();
      const std::string pattern = fmt::format("{}/*/{}", type, field);
      Target& target = targets[pattern];
      target.pattern = pattern;
      target.sense = level.sense;
      target.fields.push_back(level.field);
    }
    for (auto& [pattern, target] : targets) found.targets.push_back(std::move(target));
    return found;
  }

  [[nodiscard]] Found temperature(Role role) const {
    Found found{.targets = {}, .design = 0.0, .change = ChangeKind::add};
    std::vector<double> occupied;
    std::set<std::string> moved;  // a day may serve several schedules
    for (const RoleSchedule& schedule : schedules_of(objects_, role)) {
      std::vector<double> values;
      Target target{fmt::format("{}/{}", schedule.type, schedule.name), {}};
      for (const Pointer& field : schedule.numbers) {
        const double now = value(field);
        if (!(kColdest_C < now && now < kHottest_C)) continue;
        values.push_back(now);
        if (moved.insert(field.to_string()).second) target.fields.push_back(field);
      }
      if (values.empty()) continue;
      // Rooms in use are kept warmest in winter and coolest in summer.
      occupied.push_back(role == Role::heating_setpoint ? std::ranges::max(values)
                                                        : std::ranges::min(values));
      if (!target.fields.empty()) found.targets.push_back(std::move(target));
    }
    for (const RoleField& manager : manager_fields(objects_, role)) {
      const double now = value(manager.main);
      if (!(kColdest_C < now && now < kHottest_C)) continue;
      occupied.push_back(now);
      for (const Pointer& field : manager.numbers) {
        found.targets.push_back({field.to_string().substr(1), {field}});
      }
    }
    if (!occupied.empty()) found.design = median(std::move(occupied));
    return found;
  }

  [[nodiscard]] double sum(const std::vector<Target>& targets) const {
    double total = 0.0;
    for (const Target& target : targets) {
      for (const Pointer& field : target.fields) total += value(field);
    }
    return total;
  }

  [[nodiscard]] double mean(const std::vector<Target>& targets) const {
    std::size_t fields = 0;
    for (const Target& target : targets) fields += target.fields.size();
    return fields == 0 ? 0.0 : sum(targets) / static_cast<double>(fields);
  }

  [[nodiscard]] double leakage_cm2_m2(const std::vector<Target>& targets) const {
    const double exterior = rooms_.exterior_area_m2();
    return exterior > 0.0 ? sum(targets) / exterior : 0.0;
  }

  /// What rooms are meant to get, since a controller's least flow may not be worked out yet.
  [[nodiscard]] double outdoor_air_m3_s() const {
    const double of_rooms = rooms_.outdoor_air_m3_s();
    if (of_rooms > 0.0) return of_rooms;
    double total = 0.0;
    for (const auto& [name, controller] : objects_of(objects_, "Controller:OutdoorAir")) {
      total += number_of(*controller, "minimum_outdoor_air_flow_rate");
    }
    return total;
  }

  [[nodiscard]] double least_supply_m3_s(const std::vector<Target>& targets) const {
    double total = 0.0;
    for (const Target& target : targets) {
      for (const Pointer& field : target.fields) {
        const bool is_share = field.back() == "constant_minimum_air_flow_fraction";
        const Json& terminal = objects_.at(field.parent_pointer());
        total += value(field) * (is_share ? number_of(terminal, "maximum_air_flow_rate") : 1.0);
      }
    }
    return total;
  }

  const Json& objects_;
  Rooms rooms_;
};

Result<KnownParameter> known(const Finder& finder, const model::ParameterDefinition& definition,
                             const std::optional<Prior>& prior) {
  Found found = finder.find(definition.name);
  if (found.targets.empty()) {
    return failure(ErrorCode::unsupported,
                   fmt::format("parameter '{}': this model has no such quantity; give its targets "
                               "under a name of your own if you know better",
                               definition.name));
  }
  auto parameter = TRY(model::make_parameter(definition, found.design, prior));
  return KnownParameter{
      {std::move(parameter), std::move(found.targets), found.change, found.design},
      std::string{definition.label},
      std::string{definition.group}};
}

/// The lowest cooling set-point less the highest heating one, with the heating ones' fields.
struct DeadBand {
  double cooling_least_C = kAny;
  double heating_most_C = -kAny;
  std::vector<Pointer> heating;
};

DeadBand dead_band(const Json& objects) {
  DeadBand band;
  const auto each = [&](Role role, auto use) {
    for (const RoleSchedule& schedule : schedules_of(objects, role)) {
      for (const Pointer& field : schedule.numbers) {
        const double now = objects.at(field).get<double>();
        if (kColdest_C < now && now < kHottest_C) use(field, now);
      }
    }
  };
  each(Role::cooling_setpoint, [&](const Pointer&, double now) {
    band.cooling_least_C = std::min(band.cooling_least_C, now);
  });
  each(Role::heating_setpoint, [&](const Pointer& field, double now) {
    band.heating_most_C = std::max(band.heating_most_C, now);
    band.heating.push_back(field);
  });
  return band;
}

}  // namespace

void prepare_for_parameters(ModelDocument& model) {
  split_schedules(model);
  for (const Default& d : kDefaults) {
    const auto named = model.objects.find(std::string{d.type});
    if (named == model.objects.end() || !named->is_object()) continue;
    for (auto& [name, object] : named->items()) {
      if (object.is_object() && !object.contains(d.field)) object[d.field] = d.value;
    }
  }
}

std::vector<KnownParameter> known_parameters(const ModelDocument& model) {
  const Finder finder{model.objects};
  std::vector<KnownParameter> all;
  for (const model::ParameterDefinition& definition : model::parameter_library()) {
    if (auto one = known(finder, definition, {})) all.push_back(std::move(*one));
  }
  return all;
}

Result<KnownParameter> find_known_parameter(const ModelDocument& model, std::string_view name,
                                            const std::optional<Prior>& prior) {
  const auto library = model::parameter_library();
  const auto definition = std::ranges::find(library, name, &model::ParameterDefinition::name);
  if (definition != library.end()) return known(Finder{model.objects}, *definition, prior);
  const std::vector<KnownParameter> there = known_parameters(model);
  std::vector<std::string_view> names;
  for (const KnownParameter& parameter : there) names.emplace_back(parameter.parameter.name);
  const std::string_view nearest = nearest_name(name, names);
  return failure(ErrorCode::not_found,
                 fmt::format("unknown parameter '{}'{}", name,
                             nearest.empty() ? "; a name of your own needs targets"
                                             : fmt::format("; did you mean '{}'?", nearest)));
}

void settle(const Json& nominal, Json& objects) {
  const DeadBand before = dead_band(nominal);
  const DeadBand after = dead_band(objects);
  const double least_K =
      std::min(model::kLeastDeadBand_K, before.cooling_least_C - before.heating_most_C);
  for (const Pointer& field : after.heating) {
    Json& node = objects.at(field);
    node = std::min(node.get<double>(), after.cooling_least_C - least_K);
  }
  const auto panes = objects.find("WindowMaterial:Glazing");
  if (panes != objects.end()) {
    for (auto& [name, pane] : panes->items()) {
      for (const std::string_view light : {"solar", "visible"}) {
        const double through =
            number_of(pane, fmt::format("{}_transmittance_at_normal_incidence", light));
        for (const std::string_view side : {"front", "back"}) {
          const auto reflectance =
              pane.find(fmt::format("{}_side_{}_reflectance_at_normal_incidence", side, light));
          if (reflectance == pane.end() || !reflectance->is_number()) continue;
          *reflectance = std::clamp(reflectance->get<double>(), 0.0, kBelowOne - through);
        }
      }
    }
  }
  const auto controllers = objects.find("Controller:OutdoorAir");
  if (controllers == objects.end()) return;
  for (auto& [name, controller] : controllers->items()) {
    const double most = number_of(controller, "maximum_outdoor_air_flow_rate", kAny);
    const auto least = controller.find("minimum_outdoor_air_flow_rate");
    if (least == controller.end() || !least->is_number()) continue;
    *least = std::min(least->get<double>(), most);
  }
}

}  // namespace recald::energyplus
