#include "simulators/energyplus/building_year.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "simulators/energyplus/model_edits.hpp"

namespace recald::simulators::energyplus {
namespace {

/// A field by which objects of a type follow a schedule.
struct Follower {
  std::string_view type;  ///< Begins the object's type.
  std::string_view field;
  Role role;
};

constexpr std::array kFollowers{
    Follower{"People", "number_of_people_schedule_name", Role::presence},
    Follower{"Lights", "schedule_name", Role::lights},
    Follower{"ElectricEquipment", "schedule_name", Role::equipment},
    Follower{"ThermostatSetpoint:", "heating_setpoint_temperature_schedule_name",
             Role::heating_setpoint},
    Follower{"ThermostatSetpoint:", "cooling_setpoint_temperature_schedule_name",
             Role::cooling_setpoint},
    Follower{"ThermostatSetpoint:SingleHeating", "setpoint_temperature_schedule_name",
             Role::heating_setpoint},
    Follower{"ThermostatSetpoint:SingleCooling", "setpoint_temperature_schedule_name",
             Role::cooling_setpoint},
    Follower{"Fan:", "availability_schedule_name", Role::fans},
    Follower{"AvailabilityManager:", "fan_schedule_name", Role::fans},
    Follower{"AvailabilityManager:Scheduled", "schedule_name", Role::fans},
    Follower{"AirLoopHVAC:", "supply_air_fan_operating_mode_schedule_name", Role::fans},
    Follower{"ZoneHVAC:", "supply_air_fan_operating_mode_schedule_name", Role::fans},
    Follower{"ZoneHVAC:", "outdoor_air_schedule_name", Role::outdoor_air},
    Follower{"Controller:OutdoorAir", "minimum_outdoor_air_schedule_name", Role::outdoor_air},
    Follower{"DesignSpecification:OutdoorAir", "outdoor_air_schedule_name", Role::outdoor_air},
};

std::string_view suffix_of(Role role) {
  switch (role) {
    case Role::presence:
      return "presence";
    case Role::lights:
      return "lights";
    case Role::equipment:
      return "equipment";
    case Role::fans:
      return "fans";
    case Role::outdoor_air:
      return "outdoor air";
    case Role::heating_setpoint:
      return "heating";
    case Role::cooling_setpoint:
      return "cooling";
    case Role::supply_temperature:
      return "supply";
    case Role::added:
      break;
  }
  return "added";
}

/// Where the air of air handlers comes out, in capitals.
std::set<std::string> supply_nodes(const Json& model) {
  std::set<std::string> nodes;
  if (!model.contains("AirLoopHVAC")) return nodes;
  for (const auto& [name, loop] : model["AirLoopHVAC"].items()) {
    nodes.insert(in_capitals(loop.value("supply_side_outlet_node_names", "")));
  }
  return nodes;
}

/// A node, or the nodes of a list.
std::vector<std::string> nodes_of(const Json& model, const std::string& node_or_list) {
  std::vector<std::string> nodes{in_capitals(node_or_list)};
  if (!model.contains("NodeList")) return nodes;
  for (const auto& [name, list] : model["NodeList"].items()) {
    if (in_capitals(name) != nodes.front() || !list.contains("nodes")) continue;
    for (const Json& node : list["nodes"])
      nodes.push_back(in_capitals(node.value("node_name", "")));
  }
  return nodes;
}

}  // namespace

BuildingYear::BuildingYear(Json model, ScheduleYear schedules, const YearAround& around)
    : model_(std::move(model)),
      schedules_(std::move(schedules)),
      around_(around),
      days_(days_of(around.year)) {
  const std::set<std::chrono::sys_days> free(around.holidays.begin(), around.holidays.end());
  for (const metering::Day day : days_) {
    const std::chrono::weekday weekday{std::chrono::sys_days{day}};
    const bool is_free =
        weekday == std::chrono::Sunday || free.contains(std::chrono::sys_days{day});
    kinds_.push_back(is_free                            ? DayKind::sunday
                     : weekday == std::chrono::Saturday ? DayKind::saturday
                                                        : DayKind::workday);
  }
  // EnergyPlus does not tell of constants.
  for_each_object(model_, "Schedule:Constant", [&](const std::string& name, const Json& constant) {
    schedules_.try_emplace(in_capitals(name), days_.size() * kQuartersPerDay,
                           constant.value("hourly_value", 0.0));
  });
  give_roles();
}

void BuildingYear::give_roles() {
  const auto follow = [&](Json& object, const std::string& field, Role role) {
    if (!object.contains(field) || !object[field].is_string()) return;
    const std::string name = in_capitals(object[field].get<std::string>());
    const auto found = schedules_.find(name);
    if (found == schedules_.end()) return;
    const std::string own = name + " FOR " + in_capitals(std::string{suffix_of(role)});
    schedules_.try_emplace(own, found->second);
    roles_.try_emplace(own, role);
    object[field] = own;
  };
  for (auto& [type, objects] : model_.items()) {
    for (const Follower& follower : kFollowers) {
      if (!type.starts_with(follower.type)) continue;
      for (auto& [name, object] : objects.items()) {
        follow(object, std::string{follower.field}, follower.role);
      }
    }
  }
  if (!model_.contains("SetpointManager:Scheduled")) return;
  const std::set<std::string> supplies = supply_nodes(model_);
  for (auto& [name, manager] : model_["SetpointManager:Scheduled"].items()) {
    const auto nodes = nodes_of(model_, manager.value("setpoint_node_or_nodelist_name", ""));
    const bool is_of_air = std::ranges::any_of(
        nodes, [&](const std::string& node) { return supplies.contains(node); });
    if (is_of_air && manager.value("control_variable", "") == "Temperature") {
      follow(manager, "schedule_name", Role::supply_temperature);
    }
  }
}

std::vector<std::string> BuildingYear::names_of(Role role) const {
  std::vector<std::string> names;
  for (const auto& [name, of] : roles_) {
    if (of == role) names.push_back(name);
  }
  return names;
}

std::string BuildingYear::add_schedule(const std::string& name, Quarters quarters) {
  const std::string own = in_capitals(name);
  schedules_[own] = std::move(quarters);
  roles_.try_emplace(own, Role::added);
  return own;
}

const WeatherHour& BuildingYear::weather_at(std::size_t day, std::size_t quarter) const {
  // Clock time may be an hour ahead of standard time; of the weather that is good enough.
  const std::size_t hour = day * 24 + quarter / 4;
  return around_.hours[std::min(hour, around_.hours.size() - 1)];
}

BuildingYear::Written BuildingYear::write(const std::string& csv_name) const {
  Written written{model_, {}};
  Json& model = written.model;
  constexpr const char* kType = "Any quarter hour";
  model["ScheduleTypeLimits"][kType] = Json::object();
  std::vector<const Quarters*> columns;
  for (const auto& [name, role] : roles_) {
    columns.push_back(&schedules_.at(name));
    model["Schedule:File"][name] = {{"schedule_type_limits_name", kType},
                                    {"file_name", csv_name},
                                    {"column_number", columns.size()},
                                    {"rows_to_skip_at_top", 1},
                                    {"number_of_hours_of_data", 24 * days_.size()},
                                    {"column_separator", "Comma"},
                                    {"interpolate_to_timestep", "No"},
                                    {"minutes_per_item", 15},
                                    {"adjust_schedule_for_daylight_savings", "Yes"}};
    written.csv += (columns.size() == 1 ? "" : ",") + name;
  }
  written.csv += '\n';
  auto out = std::back_inserter(written.csv);
  for (std::size_t i = 0; i < days_.size() * kQuartersPerDay; ++i) {
    for (std::size_t column = 0; column < columns.size(); ++column) {
      fmt::format_to(out, "{}{:.4g}", column == 0 ? "" : ",", (*columns[column])[i]);
    }
    written.csv += '\n';
  }
  return written;
}

}  // namespace recald::simulators::energyplus
