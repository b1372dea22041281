#include "core/diagnosis/evidence/day_part_parameters.hpp"

#include <algorithm>
#include <array>

#include "core/model/parameter_library.hpp"

namespace recald::diagnosis {
namespace {

struct DayPartParameter {
  std::string_view name;
  double log_sd = 0.0;   ///< 0: the library's prior.
  double median = 0.0;   ///< 0: the drawings' value.
  double if_none = 0.0;  ///< The median where the drawings say 0.
  bool of_own_chiller = false;
  bool of_reheat_boxes = false;
};
constexpr auto kDayPartParameters = std::to_array<DayPartParameter>({
    {"start_early"},
    {"stop_late"},
    {"occupancy_density", 0.5},
    {"outdoor_airflow", 0.4},
    {"cooling_setpoint"},
    {"heating_setpoint"},
    {"u_factor_scale", 0.3},
    {"shgc_scale", 0.4},
    {"specific_heat_scale", 0.6},
    {"leakage_area", 0.7},
    {.name = "supply_temperature", .of_reheat_boxes = true},
    {.name = "minimum_supply_flow", .log_sd = 0.35, .of_reheat_boxes = true},
    {"hot_water_volume", 0.6},
    {"base_heat", 0.7},
    {.name = "closet_share", .of_reheat_boxes = true},
    {"gains_to_core"},
    {.name = "supply_reset", .of_reheat_boxes = true},
    {"warm_up"},
    {"closed_start"},
    // Not in any drawing: approximate values of the training buildings.
    {"mass_coupling", 0.5, 0.5},
    {.name = "core_mass", .log_sd = 0.9, .median = 0.3},
    {"air_capacity", 0.5, 35.0},
    {.name = "night_fan", .of_reheat_boxes = true},
    {.name = "fan_idle", .of_reheat_boxes = true},
    {.name = "chiller_lift", .of_own_chiller = true},
    {.name = "cooling_idle", .log_sd = 1.0, .if_none = 1.5, .of_own_chiller = true},
    // The profile is what the meter has without the plant of the drawings: if the real one idles
    // more, the profile has its idle power too, which heats no room.
    {.name = "electric_use", .log_sd = 0.15, .of_own_chiller = true},
});

bool applies(const DayPartParameter& parameter, const model::Building& nominal) {
  return (!parameter.of_own_chiller || nominal.chiller_cop) &&
         (!parameter.of_reheat_boxes || has_reheat_boxes(nominal));
}

/// nullptr: not one of them.
const DayPartParameter* find_day_part_parameter(std::string_view name) {
  const auto found = std::ranges::find(kDayPartParameters, name, &DayPartParameter::name);
  return found == kDayPartParameters.end() ? nullptr : &*found;
}

}  // namespace

std::vector<std::string_view> day_part_parameters(const model::Building& nominal) {
  std::vector<std::string_view> names;
  for (const DayPartParameter& parameter : kDayPartParameters) {
    if (applies(parameter, nominal)) names.push_back(parameter.name);
  }
  return names;
}

std::optional<Prior> wide_prior(std::string_view name, const model::Building& nominal) {
  const DayPartParameter* parameter = find_day_part_parameter(name);
  if (parameter == nullptr || parameter->log_sd == 0.0 || !applies(*parameter, nominal)) {
    return std::nullopt;
  }
  const auto definition = model::find_parameter(name);
  const double drawn = definition ? (*definition)->get(nominal) : 0.0;
  const double design_value = drawn > 0.0 ? drawn : parameter->if_none;
  const double median = parameter->median > 0.0 ? parameter->median : design_value;
  if (!(median > 0.0)) return std::nullopt;
  return Prior{LogNormalPrior{.median = median, .log_sd = parameter->log_sd}};
}

}  // namespace recald::diagnosis
