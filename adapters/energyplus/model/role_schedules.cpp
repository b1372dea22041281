#include "adapters/energyplus/model/role_schedules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "adapters/energyplus/model/fields.hpp"
#include "core/text/ascii.hpp"

namespace recald::energyplus {
namespace {

using Pointer = Json::json_pointer;

/// Days make weeks and weeks make years; each of the three has names of its own.
enum class Tier : std::uint8_t { day, week, whole };

std::optional<Tier> tier_of(std::string_view type) {
  if (type.starts_with("Schedule:Day:")) return Tier::day;
  if (type.starts_with("Schedule:Week:")) return Tier::week;
  if (type.starts_with("Schedule:")) return Tier::whole;
  return {};
}

using Visit = std::function<void(const Pointer& here, const std::string& text)>;

void each_text(const Json& node, const Pointer& here, const Visit& visit) {
  if (node.is_string()) {
    visit(here, node.get<std::string>());
  } else if (node.is_object()) {
    for (const auto& [key, value] : node.items()) each_text(value, here / key, visit);
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) each_text(node[i], here / i, visit);
  }
}

struct Place {
  std::string type;
  std::string name;
  [[nodiscard]] Pointer pointer() const { return Pointer{} / type / name; }
  auto operator<=>(const Place&) const = default;
};

/// Finds schedules by tier and name.
class Schedules {
 public:
  explicit Schedules(const Json& objects) : objects_{objects} {
    for (const auto& [type, named] : objects.items()) {
      const auto tier = tier_of(type);
      if (!tier || !named.is_object()) continue;
      for (const auto& [name, object] : named.items()) {
        places_[{*tier, to_lower(name)}] = {type, name};
      }
    }
  }

  [[nodiscard]] std::optional<Place> find(Tier tier, std::string_view name) const {
    const auto found = places_.find({tier, to_lower(name)});
    if (found == places_.end()) return {};
    return found->second;
  }

  /// The weeks of a year, or the days of a week: the fields that name them, and where those are.
  [[nodiscard]] std::vector<std::pair<Pointer, Place>> parts(const Place& place) const {
    std::vector<std::pair<Pointer, Place>> found;
    const Tier tier = *tier_of(place.type);
    if (tier == Tier::day || (tier == Tier::whole && place.type != "Schedule:Year")) return found;
    const Tier below = tier == Tier::whole ? Tier::week : Tier::day;
    each_text(objects_.at(place.pointer()), place.pointer(),
              [&](const Pointer& here, const std::string& text) {
                if (const auto part = find(below, text)) found.emplace_back(here, *part);
              });
    return found;
  }

  /// The schedule and all that it is made of.
  void close(const Place& place, std::set<Place>& closure) const {
    if (!closure.insert(place).second) return;
    for (const auto& [here, part] : parts(place)) close(part, closure);
  }

 private:
  const Json& objects_;
  std::map<std::pair<Tier, std::string>, Place> places_;
};

/// The numbers of one object; a year has none of its own.
void add_numbers(const Json& objects, const Place& place, std::vector<Pointer>& numbers) {
  const Json& object = objects.at(place.pointer());
  const auto add = [&](const Pointer& here) {
    if (objects.contains(here) && objects.at(here).is_number()) numbers.push_back(here);
  };
  constexpr std::array<std::tuple<std::string_view, const char*, const char*>, 3> kLists{{
      {"Schedule:Compact", "data", "field"},
      {"Schedule:Day:Interval", "data", "value_until_time"},
      {"Schedule:Day:List", "extensions", "value"},
  }};
  for (const auto& [type, list, key] : kLists) {
    if (place.type != type || !object.contains(list)) continue;
    for (std::size_t i = 0; i < object.at(list).size(); ++i) add(place.pointer() / list / i / key);
  }
  if (place.type == "Schedule:Constant") add(place.pointer() / "hourly_value");
  if (place.type == "Schedule:Day:Hourly") {
    for (int hour = 1; hour <= 24; ++hour) add(place.pointer() / fmt::format("hour_{}", hour));
  }
}

/// The nodes that a field names: one, or those of a list.
std::set<std::string> nodes_of(const Json& objects, const std::string& name) {
  for (const auto& [list, object] : objects_of(objects, "NodeList")) {
    if (!equals_ignoring_case(list, name) || !object->contains("nodes")) continue;
    std::set<std::string> nodes;
    for (const Json& node : object->at("nodes")) {
      nodes.insert(to_lower(text_of(node, "node_name")));
    }
    return nodes;
  }
  return {to_lower(name)};
}

std::set<std::string> nodes_of_role(const Json& objects, Role role) {
  std::set<std::string> nodes;
  if (role == Role::supply_temperature) {
    for (const auto& [name, loop] : objects_of(objects, "AirLoopHVAC")) {
      nodes.merge(nodes_of(objects, text_of(*loop, "supply_side_outlet_node_names")));
    }
  } else if (role == Role::chilled_water_temperature) {
    for (const auto& [name, sizing] : objects_of(objects, "Sizing:Plant")) {
      if (to_lower(text_of(*sizing, "loop_type")) != "cooling") continue;
      for (const auto& [loop, object] : objects_of(objects, "PlantLoop")) {
        if (!equals_ignoring_case(loop, text_of(*sizing, "plant_or_condenser_loop_name"))) continue;
        nodes.merge(nodes_of(objects, text_of(*object, "loop_temperature_setpoint_node_name")));
      }
    }
  }
  return nodes;
}

/// The managers of a type that set a temperature at the role's nodes.
std::vector<std::pair<std::string, const Json*>> managers_of(const Json& objects, Role role,
                                                             std::string_view type) {
  const std::set<std::string> nodes = nodes_of_role(objects, role);
  auto managers = objects_of(objects, type);
  std::erase_if(managers, [&](const auto& manager) {
    const Json& object = *manager.second;
    if (to_lower(text_of(object, "control_variable", "Temperature")) != "temperature") return true;
    const auto own = nodes_of(objects, text_of(object, "setpoint_node_or_nodelist_name"));
    return std::ranges::none_of(own, [&](const auto& node) { return nodes.contains(node); });
  });
  return managers;
}

/// The thermostats' fields that name schedules.
std::vector<Pointer> thermostat_uses(const Json& objects, bool is_cooling) {
  const std::string dual = is_cooling ? "cooling_setpoint_temperature_schedule_name"
                                      : "heating_setpoint_temperature_schedule_name";
  const std::array<std::pair<std::string, std::string>, 2> fields{{
      {"ThermostatSetpoint:DualSetpoint", dual},
      {is_cooling ? "ThermostatSetpoint:SingleCooling" : "ThermostatSetpoint:SingleHeating",
       "setpoint_temperature_schedule_name"},
  }};
  std::set<std::string> controls;  // of thermostats in use
  for (const auto& [name, thermostat] : objects_of(objects, "ZoneControl:Thermostat")) {
    each_text(*thermostat, Pointer{},
              [&](const Pointer&, const std::string& text) { controls.insert(to_lower(text)); });
  }
  std::vector<Pointer> uses;
  for (const auto& [type, field] : fields) {
    for (const auto& [name, control] : objects_of(objects, type)) {
      if (controls.contains(to_lower(name))) uses.push_back(Pointer{} / type / name / field);
    }
  }
  if (!is_cooling) {
    for (const Pointer& field : find_fields(
             objects,
             "ZoneHVAC:HighTemperatureRadiant/*/heating_setpoint_temperature_schedule_name")) {
      uses.push_back(field);
    }
  }
  return uses;
}

/// The role's fields that name schedules.
std::vector<Pointer> uses_of(const Json& objects, Role role) {
  std::vector<Pointer> uses;
  if (role == Role::cooling_setpoint || role == Role::heating_setpoint) {
    uses = thermostat_uses(objects, role == Role::cooling_setpoint);
  } else {
    const std::string type = "SetpointManager:Scheduled";
    for (const auto& [name, manager] : managers_of(objects, role, type)) {
      uses.push_back(Pointer{} / type / name / "schedule_name");
    }
  }
  std::erase_if(uses, [&](const Pointer& use) {
    return !objects.contains(use) || !objects.at(use).is_string();
  });
  return uses;
}

std::set<Place> places_of(const Json& objects, const Schedules& schedules,
                          const std::vector<Pointer>& uses) {
  std::set<Place> places;
  for (const Pointer& use : uses) {
    if (const auto place = schedules.find(Tier::whole, objects.at(use).get<std::string>())) {
      places.insert(*place);
    }
  }
  return places;
}

/// Whether anything but the role's fields uses one of the schedules.
bool is_shared(const Json& objects, const Schedules& schedules, const std::set<Place>& closure,
               const std::vector<Pointer>& uses) {
  bool shared = false;
  for (const auto& [type, named] : objects.items()) {
    if (type.starts_with("EnergyManagementSystem:") || type.starts_with("Output")) continue;
    if (tier_of(type)) {
      if (!named.is_object()) continue;
      for (const auto& [name, object] : named.items()) {
        if (closure.contains({type, name})) continue;
        for (const auto& [here, part] : schedules.parts({type, name})) {
          shared = shared || closure.contains(part);
        }
      }
      continue;
    }
    each_text(named, Pointer{} / type, [&](const Pointer& here, const std::string& text) {
      const auto place = schedules.find(Tier::whole, text);
      shared = shared ||
               (place && closure.contains(*place) && std::ranges::find(uses, here) == uses.end());
    });
  }
  return shared;
}

}  // namespace

std::string_view name_of(Role role) {
  switch (role) {
    case Role::cooling_setpoint:
      return "cooling_setpoint";
    case Role::heating_setpoint:
      return "heating_setpoint";
    case Role::supply_temperature:
      return "supply_temperature";
    case Role::chilled_water_temperature:
      break;
  }
  return "chilled_water_temperature";
}

std::vector<RoleSchedule> schedules_of(const Json& objects, Role role) {
  const Schedules schedules{objects};
  std::vector<RoleSchedule> found;
  for (const Place& place : places_of(objects, schedules, uses_of(objects, role))) {
    std::set<Place> closure;
    schedules.close(place, closure);
    RoleSchedule schedule{place.type, place.name, {}};
    for (const Place& part : closure) add_numbers(objects, part, schedule.numbers);
    if (!schedule.numbers.empty()) found.push_back(std::move(schedule));
  }
  return found;
}

std::vector<RoleField> manager_fields(const Json& objects, Role role) {
  struct Fields {
    const char* type;
    std::vector<std::string> fields;  // the main one first
  };
  const std::vector<Fields> kinds{
      {"SetpointManager:OutdoorAirReset",
       {"setpoint_at_outdoor_high_temperature", "setpoint_at_outdoor_low_temperature",
        "setpoint_at_outdoor_high_temperature_2", "setpoint_at_outdoor_low_temperature_2"}},
      {"SetpointManager:Warmest", {"minimum_setpoint_temperature", "maximum_setpoint_temperature"}},
      {"SetpointManager:WarmestTemperatureFlow",
       {"minimum_setpoint_temperature", "maximum_setpoint_temperature"}},
      {"SetpointManager:MultiZone:Cooling:Average",
       {"minimum_setpoint_temperature", "maximum_setpoint_temperature"}},
      // Their maximum belongs to the heating of a unit that does both.
      {"SetpointManager:SingleZone:Cooling", {"minimum_supply_air_temperature"}},
      {"SetpointManager:SingleZone:Reheat", {"minimum_supply_air_temperature"}},
  };
  std::vector<RoleField> found;
  for (const Fields& kind : kinds) {
    for (const auto& [name, manager] : managers_of(objects, role, kind.type)) {
      RoleField field;
      for (const std::string& key : kind.fields) {
        if (!manager->contains(key) || !manager->at(key).is_number()) continue;
        field.numbers.push_back(Pointer{} / kind.type / name / key);
      }
      if (field.numbers.empty() || !manager->contains(kind.fields.front())) continue;
      field.main = field.numbers.front();
      found.push_back(std::move(field));
    }
  }
  return found;
}

void split_schedules(ModelDocument& model) {
  Json& objects = model.objects;
  for (const Role role : kRoles) {
    const Schedules schedules{objects};
    const std::vector<Pointer> uses = uses_of(objects, role);
    std::set<Place> closure;
    for (const Place& place : places_of(objects, schedules, uses)) {
      schedules.close(place, closure);
    }
    if (closure.empty() || !is_shared(objects, schedules, closure, uses)) continue;
    const auto copy_of = [&](const std::string& name) {
      return fmt::format("{} {}", name, name_of(role));
    };
    Json copied = objects;
    for (const Place& place : closure) {
      const Place copy{place.type, copy_of(place.name)};
      copied[copy.type][copy.name] = objects.at(place.pointer());
      for (const auto& [here, part] : schedules.parts(place)) {
        const std::string within = here.to_string().substr(place.pointer().to_string().size());
        const Pointer field{copy.pointer().to_string() + within};
        copied[field] = copy_of(part.name);
      }
    }
    for (const Pointer& use : uses) {
      const auto place = schedules.find(Tier::whole, objects.at(use).get<std::string>());
      if (place) copied[use] = copy_of(place->name);
    }
    objects = std::move(copied);
  }
}

}  // namespace recald::energyplus
