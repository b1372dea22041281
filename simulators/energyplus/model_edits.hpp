/// Changes of a model that hold for models of any origin.
#pragma once

#include <initializer_list>
#include <string_view>
#include <type_traits>

#include "simulators/energyplus/building_year.hpp"

namespace recald::simulators::energyplus {

/// `visit(name, object)` or `visit(object)` for all objects whose type begins so. @param model
/// `Json`, const or not
template <class Model, class Visit>
void for_each_object(Model& model, std::string_view type, const Visit& visit) {
  for (auto& [of, objects] : model.items()) {
    if (!of.starts_with(type)) continue;
    for (auto& [name, object] : objects.items()) {
      if constexpr (std::is_invocable_v<Visit, decltype(name), decltype(object)>) {
        visit(name, object);
      } else {
        visit(object);
      }
    }
  }
}

[[nodiscard]] bool has_object(const Json& model, std::string_view type);

/// Whether `holds(object)` for any of them.
template <class Holds>
bool has_object(const Json& model, std::string_view type, const Holds& holds) {
  bool found = false;
  for_each_object(model, type, [&](const Json& object) { found |= holds(object); });
  return found;
}

/// Multiplies numbers; what is left to EnergyPlus stays so. @return how many
std::size_t scale(Json& model, std::string_view type,
                  std::initializer_list<std::string_view> fields, double factor);

std::size_t scale_people(Json& model, double factor);
std::size_t scale_lights(Json& model, double factor);
std::size_t scale_equipment(Json& model, double factor);
std::size_t scale_infiltration(Json& model, double factor);
/// The least outdoor air of air handlers and units.
std::size_t scale_outdoor_air(Json& model, double factor);
/// Of coils and chillers.
std::size_t scale_cooling_cop(Json& model, double factor);
/// Simple glazing alone: of panes and gaps nobody says which film they get.
std::size_t scale_solar_gain(Json& model, double factor);

/// A list of all zones that hold a thermostat, and its name.
std::string add_zone_list(Json& model);

/// Power in the rooms, given as it is seen by the floor. @param schedule  0 … 1
void add_equipment(BuildingYear& building, const std::string& name, double W_m2,
                   const std::string& schedule);
/// Power outside that warms no room. @param fuel  As EnergyPlus calls it.
void add_outside_load(BuildingYear& building, const std::string& name, const char* fuel,
                      double power_W, const std::string& schedule);

/// What heats the building as its meter has it: "DistrictHeatingWater", "NaturalGas", or "" where
/// electricity does.
[[nodiscard]] std::string heating_fuel(const Json& model);

/// Holds what a day's schedules do while the building is used for longer: fans and outdoor air run,
/// set-points are those of the day. Negative: for less long.
/// @param quarters  Of the day: {before it begins, after it ends}.
template <class Hours>
void stretch_operation(BuildingYear& building, const Hours& quarters);

/// One day's values where the largest (or smallest) within reach counts.
void stretch_day(double* values, int before, int after, bool keep_largest);

template <class Hours>
void stretch_operation(BuildingYear& building, const Hours& quarters) {
  for (const Role role :
       {Role::fans, Role::outdoor_air, Role::heating_setpoint, Role::cooling_setpoint}) {
    for (const std::string& name : building.names_of(role)) {
      Quarters& all = building.schedule(name);
      for (std::size_t day = 0; day < building.days().size(); ++day) {
        const auto [before, after] = quarters(day);
        if (before == 0 && after == 0) continue;
        stretch_day(all.data() + day * kQuartersPerDay, before, after,
                    role != Role::cooling_setpoint);
      }
    }
  }
}

}  // namespace recald::simulators::energyplus
