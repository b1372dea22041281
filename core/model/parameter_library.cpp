#include "core/model/parameter_library.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "core/text/nearest.hpp"

namespace recald::model {
namespace {

double one(const Building&) { return 1.0; }

void scale_u(Building& b, double factor) {
  for (Surface& s : b.surfaces) s.u_W_m2K *= factor;
}
/// The resistances of the air on both sides of a surface, ISO 6946:2017 table 7, m2 K/W.
double film_resistance_m2K_W(SurfaceKind kind) {
  constexpr double kOutside = 0.04;
  switch (kind) {
    case SurfaceKind::roof:
      return 0.10 + kOutside;
    case SurfaceKind::ground:
      return 0.17 + kOutside;
    default:
      return 0.13 + kOutside;
  }
}

/// A model that knows U-values changes their part inside the wall: R = 1/U less the films. Glass
/// hardly resists, so windows stay.
void scale_resistance(Building& b, double factor) {
  for (Surface& s : b.surfaces) {
    if (s.kind == SurfaceKind::window || !(s.u_W_m2K > 0.0)) continue;
    const double films = film_resistance_m2K_W(s.kind);
    const double wall = std::max(1.0 / s.u_W_m2K - films, 0.0);
    if (wall > 0.0) s.u_W_m2K = 1.0 / (films + factor * wall);
  }
}
void scale_conductivity(Building& b, double factor) { scale_resistance(b, 1.0 / factor); }

/// Of walls and roofs; a surface emits long waves as it absorbs them.
void scale_thermal_absorptance(Building& b, double factor) {
  for (Surface& s : b.surfaces) {
    if (s.kind != SurfaceKind::window) s.emissivity *= factor;
  }
}
void scale_heat_capacity(Building& b, double factor) { b.heat_capacity_J_m2K *= factor; }
void scale_shgc(Building& b, double factor) {
  for (Surface& s : b.surfaces) s.shgc *= factor;
}
void scale_dirt(Building& b, double factor) {
  for (Surface& s : b.surfaces) {
    if (s.kind == SurfaceKind::window) s.shading_factor *= factor;
  }
}
void scale_solar_absorptance(Building& b, double factor) {
  for (Surface& s : b.surfaces) s.solar_absorptance *= factor;
}
void scale_emissivity(Building& b, double factor) {
  for (Surface& s : b.surfaces) s.emissivity *= factor;
}

/// A larger floor with the same number of storeys: roof and ground grow with it, walls and
/// windows with its side.
void set_floor_area(Building& b, double area_m2) {
  const double factor = area_m2 / b.floor_area_m2;
  for (Surface& s : b.surfaces) {
    const bool horizontal = s.kind == SurfaceKind::roof || s.kind == SurfaceKind::ground;
    s.area_m2 *= horizontal ? factor : std::sqrt(factor);
  }
  b.floor_area_m2 = area_m2;
}

double outdoor_air(const Building& b) {
  return b.air ? b.air->outdoor_air_m3_s : b.ventilation_m3_s;
}
void set_outdoor_air(Building& b, double v) {
  (b.air ? b.air->outdoor_air_m3_s : b.ventilation_m3_s) = v;
}
double supply_temperature(const Building& b) { return b.air ? b.air->supply_temperature_C : 0.0; }
void set_supply_temperature(Building& b, double v) {
  if (b.air) b.air->supply_temperature_C = v;
}
double least_flow(const Building& b) { return b.air ? b.air->supply_flow_min_m3_s : 0.0; }
void set_least_flow(Building& b, double v) {
  if (b.air) b.air->supply_flow_min_m3_s = v;
}
void set_cooling_set_point(Building& b, double v) {
  // The night value moves with it: people set one thermostat, not two.
  b.set_points.cooling_unoccupied_C += v - b.set_points.cooling_occupied_C;
  b.set_points.cooling_occupied_C = v;
}
void set_heating_set_point(Building& b, double v) {
  b.set_points.heating_unoccupied_C += v - b.set_points.heating_occupied_C;
  b.set_points.heating_occupied_C = v;
}

constexpr double kNoLeast = -std::numeric_limits<double>::infinity();
/// How far a widened range extends beyond the design value, as a share of its width.
constexpr double kWidened = 0.25;

constexpr auto kRelative = RangeKind::relative;
constexpr auto kAbsolute = RangeKind::absolute;

// clang-format off
const std::array kLibrary = std::to_array<ParameterDefinition>({
  // Table 1 of the seed.
  {"ground_temperature", "degC", "Ground temperature", "microclimate", kAbsolute, 12.6, 23.4,
   [](const Building& b) { return b.ground_temperature_C; }, [](Building& b, double v) { b.ground_temperature_C = v; }, kNoLeast},
  {"conductivity_scale", "-", "Conductivity", "thermal properties", kRelative, 0.85, 1.15, one, scale_conductivity},
  {"u_factor_scale", "-", "U-factors, all surfaces", "thermal properties", kRelative, 0.85, 1.15, one, scale_u},
  {"shgc_scale", "-", "Solar heat gain coefficients", "thermal properties", kRelative, 0.85, 1.15, one, scale_shgc},
  {"thermal_resistance_scale", "-", "Thermal resistance", "thermal properties", kRelative, 0.85, 1.15, one, scale_resistance},
  {"density_scale", "-", "Density", "thermal properties", kRelative, 0.97, 1.03, one, scale_heat_capacity},
  {"specific_heat_scale", "-", "Heat capacity", "thermal properties", kRelative, 0.6325, 1.3675, one, scale_heat_capacity},
  {"dirt_correction", "-", "Dirt on the glass", "thermal properties", kRelative, 0.70, 1.30, one, scale_dirt},
  {"thermal_absorptance_scale", "-", "Thermal absorptance", "optical properties", kRelative, 0.88, 1.12, one, scale_thermal_absorptance},
  {"solar_absorptance_scale", "-", "Solar absorptance", "optical properties", kRelative, 0.88, 1.12, one, scale_solar_absorptance},
  {"visible_absorptance_scale", "-", "Visible absorptance", "optical properties", kRelative, 0.88, 1.12, nullptr, nullptr},
  {"infrared_transmittance_scale", "-", "Infrared transmittance", "optical properties", kRelative, 0.97, 1.03, nullptr, nullptr},
  {"solar_transmittance_scale", "-", "Solar transmittance", "optical properties", kRelative, 0.97, 1.03, nullptr, nullptr},
  {"visible_transmittance_scale", "-", "Visible transmittance", "optical properties", kRelative, 0.97, 1.03, nullptr, nullptr},
  {"thermal_reflectance_scale", "-", "Thermal reflectance", "optical properties", kRelative, 0.97, 1.03, nullptr, nullptr},
  {"solar_reflectance_scale", "-", "Solar reflectance", "optical properties", kRelative, 0.97, 1.03, nullptr, nullptr},
  {"visible_reflectance_scale", "-", "Visible reflectance", "optical properties", kRelative, 0.97, 1.03, nullptr, nullptr},
  {"infrared_emissivity_scale", "-", "Infrared hemispherical emissivity", "optical properties", kRelative, 0.97, 1.03, one, scale_emissivity},
  {"leakage_area", "cm2/m2", "Effective leakage area per exterior area", "infiltration", kAbsolute, 0.26, 4.94,
   [](const Building& b) { return b.leakage_cm2_m2; }, [](Building& b, double v) { b.leakage_cm2_m2 = v; }},
  {"occupancy_density", "person/m2", "Occupancy density", "internal load", kRelative, 0.0, 2.0,
   [](const Building& b) { return b.use.occupancy_person_m2; }, [](Building& b, double v) { b.use.occupancy_person_m2 = v; }},
  {"cooling_setpoint", "degC", "Cooling set-point, occupied hours", "system operation", kAbsolute, 20.0, 27.8,
   [](const Building& b) { return b.set_points.cooling_occupied_C; }, set_cooling_set_point, kNoLeast},
  {"chilled_water_temperature", "degC", "Chilled water temperature", "system operation", kAbsolute, 5.0, 8.0,
   [](const Building& b) { return b.chilled_water_C; }, [](Building& b, double v) { b.chilled_water_C = v; }, kNoLeast},
  {"supply_temperature", "degC", "Supply air temperature", "system operation", kAbsolute, 11.0, 14.0, supply_temperature, set_supply_temperature, kNoLeast},
  {"outdoor_airflow", "m3/s", "Outdoor airflow rate", "system operation", kRelative, 0.3, 1.2, outdoor_air, set_outdoor_air},
  // Ours.
  {"heating_setpoint", "degC", "Heating set-point, occupied hours", "system operation", kAbsolute, 16.0, 24.0,
   [](const Building& b) { return b.set_points.heating_occupied_C; }, set_heating_set_point, kNoLeast},
  {"minimum_supply_flow", "m3/s", "Supply flow with all boxes at minimum", "system operation", kRelative, 0.5, 1.3, least_flow, set_least_flow},
  {"heating_efficiency", "-", "Boiler or heat exchanger efficiency", "plant", kRelative, 0.85, 1.10,
   [](const Building& b) { return b.heating_efficiency; }, [](Building& b, double v) { b.heating_efficiency = v; }},
  {"hot_water_volume", "m3/day", "Hot water drawn", "plant", kRelative, 0.0, 2.0,
   [](const Building& b) { return b.hot_water.volume_m3_day; }, [](Building& b, double v) { b.hot_water.volume_m3_day = v; }},
  {"base_heat", "kW", "Heat drawn at all hours that serves no zone", "plant", kRelative, 0.0, 2.0,
   [](const Building& b) { return b.base_heat_kW; }, [](Building& b, double v) { b.base_heat_kW = v; }},
  {"start_early", "h", "Plant starts before its timetable", "system operation", kAbsolute, -1.0, 2.5,
   [](const Building& b) { return b.set_points.start_early_h; }, [](Building& b, double v) { b.set_points.start_early_h = v; }, kNoLeast},
  {"stop_late", "h", "Plant stops after its timetable", "system operation", kAbsolute, -1.5, 1.5,
   [](const Building& b) { return b.set_points.stop_late_h; }, [](Building& b, double v) { b.set_points.stop_late_h = v; }, kNoLeast},
  {"closet_share", "-", "Share of plug heat in closets that are cooled at all hours", "internal load", kAbsolute, 0.0, 0.6,
   [](const Building& b) { return b.use.closet_share; }, [](Building& b, double v) { b.use.closet_share = v; }, 0.0, 1.0},
  {"gains_to_core", "-", "Share of the perimeter's internal gains that arises in the core", "internal load", kAbsolute, 0.0, 0.6,
   [](const Building& b) { return b.use.gains_to_core; }, [](Building& b, double v) { b.use.gains_to_core = v; }, 0.0, 1.0},
  {"supply_reset", "K", "Supply air warmer on cold days", "system operation", kAbsolute, 0.0, 5.0,
   [](const Building& b) { return b.air ? b.air->supply_reset_K : 0.0; }, [](Building& b, double v) { if (b.air) b.air->supply_reset_K = v; }},
  {"warm_up", "h", "Time in which the heating set-point climbs in the morning", "system operation", kAbsolute, 0.0, 4.0,
   [](const Building& b) { return b.set_points.warm_up_h; }, [](Building& b, double v) { b.set_points.warm_up_h = v; }},
  {"closed_start", "h", "Time after the start with outdoor-air dampers shut", "system operation", kAbsolute, 0.0, 2.0,
   [](const Building& b) { return b.set_points.closed_start_h; }, [](Building& b, double v) { b.set_points.closed_start_h = v; }},
  {"mass_coupling", "-", "Conductance between the mass and the inner surfaces, over the standard's", "thermal properties", kAbsolute, 0.1, 2.5,
   [](const Building& b) { return b.mass_coupling; }, [](Building& b, double v) { b.mass_coupling = v; }},
  {"core_mass", "-", "Heat capacity of rooms without outer walls, over that of the others", "thermal properties", kAbsolute, 0.02, 2.0,
   [](const Building& b) { return b.core_mass_share; }, [](Building& b, double v) { b.core_mass_share = v; }},
  {"air_capacity", "kJ/m2K", "Heat capacity of air and furniture per floor area", "thermal properties", kAbsolute, 0.0, 150.0,
   [](const Building& b) { return 1e-3 * b.air_capacity_J_m2K; }, [](Building& b, double v) { b.air_capacity_J_m2K = 1e3 * v; }},
  {"night_fan", "-", "Share of the fans that runs while rooms are heated at night", "system operation", kAbsolute, 0.0, 1.0,
   [](const Building& b) { return b.air ? b.air->night_fan_share : 0.0; }, [](Building& b, double v) { if (b.air) b.air->night_fan_share = v; }, 0.0, 1.0},
  {"fan_idle", "-", "Share of their design power that fans keep at little flow", "system operation", kAbsolute, 0.0, 0.25,
   [](const Building& b) { return b.air ? b.air->fan_idle_share : 0.0; }, [](Building& b, double v) { if (b.air) b.air->fan_idle_share = v; }, 0.0, 1.0},
  {"chiller_lift", "1/K", "More chiller electricity per K of outdoor wet bulb", "plant", kAbsolute, 0.0, 0.06,
   [](const Building& b) { return b.chiller_lift_per_K; }, [](Building& b, double v) { b.chiller_lift_per_K = v; }},
  {"cooling_idle", "W/m2", "Electricity of the cooling plant whenever it runs, over its load's", "plant", kRelative, 0.3, 2.0,
   [](const Building& b) { return 1e3 * b.cooling_idle_kW / b.floor_area_m2; }, [](Building& b, double v) { b.cooling_idle_kW = 1e-3 * v * b.floor_area_m2; }},
  // Their meters give the built-in models lights and plugs.
  {"lighting_power", "W/m2", "Installed lighting", "internal load", kRelative, 0.7, 1.4, nullptr, nullptr},
  {"equipment_power", "W/m2", "Installed equipment", "internal load", kRelative, 0.5, 1.5, nullptr, nullptr},
  {"infiltration_scale", "-", "Infiltration", "infiltration", kRelative, 0.1, 1.9,
   one, [](Building& b, double v) { b.leakage_cm2_m2 *= v; }},
  {"hot_water_scale", "-", "Hot water drawn, as a factor", "plant", kRelative, 0.0, 2.0,
   one, [](Building& b, double v) { b.hot_water.volume_m3_day *= v; }},
  {"cooling_cop", "-", "Rated COP of chillers and cooling coils", "plant", kRelative, 0.75, 1.15,
   [](const Building& b) { return b.chiller_cop.value_or(0.0); }, [](Building& b, double v) { if (b.chiller_cop) b.chiller_cop = v; }},
  {"lighting_use", "-", "Electricity of the lights, over what the meter's profile has", "internal load", kRelative, 0.75, 1.25,
   one, [](Building& b, double v) { b.use.lights_scale *= v; }},
  {"plug_use", "-", "Electricity of plug loads, over what the meter's profile has", "internal load", kRelative, 0.75, 1.25,
   one, [](Building& b, double v) { b.use.plugs_scale *= v; }},
  {"electric_use", "-", "Electricity of lights and plug loads, over what the meter's profile has", "internal load", kRelative, 0.75, 1.25,
   one, [](Building& b, double v) { b.use.lights_scale *= v; b.use.plugs_scale *= v; }},
  {"floor_area", "m2", "Floor area", "geometry", kRelative, 0.4, 2.5,
   [](const Building& b) { return b.floor_area_m2; }, set_floor_area},
});
// clang-format on

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

std::span<const ParameterDefinition> parameter_library() { return kLibrary; }

Result<const ParameterDefinition*> find_parameter(std::string_view name) {
  const auto found = std::ranges::find(kLibrary, name, &ParameterDefinition::name);
  if (found == kLibrary.end()) {
    std::vector<std::string_view> names;
    for (const auto& definition : kLibrary) names.push_back(definition.name);
    const std::string_view nearest = nearest_name(name, names);
    return failure(ErrorCode::not_found,
                   "unknown parameter '" + std::string{name} + "'" +
                       (nearest.empty() ? "" : "; did you mean '" + std::string{nearest} + "'?"));
  }
  if (!found->is_modelled()) {
    return failure(ErrorCode::unsupported,
                   "parameter '" + std::string{name} +
                       "': this model has no such quantity; a model in EnergyPlus may have it");
  }
  return &*found;
}

Result<Prior> physical_prior(const ParameterDefinition& definition, const Prior& prior) {
  Prior cut = prior;
  if (const auto* normal = std::get_if<TruncatedNormalPrior>(&prior.distribution())) {
    const double min = std::isfinite(normal->min) ? normal->min : definition.least;
    const double max = std::isfinite(normal->max) ? normal->max : definition.most;
    auto made = Prior::make(TruncatedNormalPrior{normal->location, normal->sd, min, max});
    if (!made) return made;
    cut = *made;
  } else if (const auto* skewed = std::get_if<LogNormalPrior>(&prior.distribution())) {
    const double max = std::isfinite(skewed->max) ? skewed->max : definition.most;
    auto made = Prior::make(LogNormalPrior{skewed->median, skewed->log_sd, skewed->min, max});
    if (!made) return made;
    cut = *made;
  }
  const auto amount = [&](double value) {
    return number(value) + (definition.unit == "-" ? "" : " " + std::string{definition.unit});
  };
  const bool is_too_low = cut.min() < definition.least;
  const bool is_too_high = std::isfinite(cut.max()) && cut.max() > definition.most;
  if (!is_too_low && !is_too_high) return cut;
  return failure(
      ErrorCode::invalid_value,
      std::string{definition.name} + " cannot be " + amount(is_too_low ? cut.min() : cut.max()) +
          "; it is at " +
          (is_too_low ? "least " + amount(definition.least) : "most " + amount(definition.most)));
}

Result<Parameter> make_parameter(const ParameterDefinition& definition, const Building& nominal,
                                 const std::optional<Prior>& prior) {
  return make_parameter(definition, definition.get(nominal), prior);
}

Result<Parameter> make_parameter(const ParameterDefinition& definition, double design,
                                 const std::optional<Prior>& prior) {
  const std::string name{definition.name};
  const std::string unit{definition.unit};
  const auto with = [&](Prior of) {
    return Parameter{.name = name,
                     .unit = unit,
                     .prior = std::move(of),
                     .label = std::string{definition.label},
                     .definition = &definition};
  };
  if (prior) {
    auto physical = TRY(physical_prior(definition, *prior));
    return with(physical);
  }
  if (definition.range == RangeKind::relative) {
    if (!(design > 0.0)) {
      return failure(ErrorCode::invalid_value,
                     name + ": its range is relative to the design value, which is " +
                         number(design) + "; give min, mode and max");
    }
    return with({definition.low * design, design, definition.high * design});
  }
  if (!(definition.least <= design && design <= definition.most)) {
    return failure(ErrorCode::invalid_value,
                   name + ": the design value " + number(design) + " " + unit + " is not possible");
  }
  const double beyond = kWidened * (definition.high - definition.low);
  const double low =
      design < definition.low ? std::max(design - beyond, definition.least) : definition.low;
  const double high =
      design > definition.high ? std::min(design + beyond, definition.most) : definition.high;
  return with({low, design, high});
}

void settle(Building& building) {
  SetPoints& set = building.set_points;
  set.heating_occupied_C =
      std::min(set.heating_occupied_C, set.cooling_occupied_C - kLeastDeadBand_K);
  set.heating_unoccupied_C = std::min(set.heating_unoccupied_C, set.heating_occupied_C);
  set.cooling_unoccupied_C = std::max(set.cooling_unoccupied_C, set.cooling_occupied_C);
  for (Surface& s : building.surfaces) {
    s.shading_factor = std::min(s.shading_factor, 1.0);
    s.solar_absorptance = std::min(s.solar_absorptance, 1.0);
    s.emissivity = std::min(s.emissivity, 1.0);
  }
}

}  // namespace recald::model
