#include "adapters/energyplus/effect_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <tuple>
#include <utility>

#include "adapters/energyplus/known_parameters.hpp"
#include "adapters/energyplus/model/fields.hpp"
#include "adapters/energyplus/model/role_schedules.hpp"
#include "adapters/energyplus/model/rooms.hpp"
#include "adapters/energyplus/model/schedule_values.hpp"
#include "core/text/ascii.hpp"

namespace recald::energyplus {
namespace {

using Pointer = Json::json_pointer;
using Values = std::span<const double>;
using Fields = std::vector<Pointer>;

constexpr int kNoon = kMinutesADay / 2;
constexpr const char* kCompact = "Schedule:Compact";
constexpr const char* kAlways = "recald always";
constexpr double kWattsPerKilowatt = 1000.0;
/// Where a wind's share of the leakage is the catalogue's, whatever the exponent.
constexpr double kUsualWind_m_s = 4.0;
/// By which rooms are warmer than outdoors on a morning of the heating season.
constexpr double kUsualCold_K = 15.0;

// ---- schedules

Fields fields_of(const Json& objects, std::initializer_list<std::string_view> patterns) {
  Fields fields;
  for (const std::string_view pattern : patterns) {
    for (Pointer& field : find_fields(objects, pattern)) fields.push_back(std::move(field));
  }
  return fields;
}

/// Those of thermostats that name schedules.
Fields thermostat_fields(const Json& objects) {
  return fields_of(objects,
                   {"ThermostatSetpoint:DualSetpoint/*/heating_setpoint_temperature_schedule_name",
                    "ThermostatSetpoint:DualSetpoint/*/cooling_setpoint_temperature_schedule_name",
                    "ThermostatSetpoint:SingleHeating/*/setpoint_temperature_schedule_name",
                    "ThermostatSetpoint:SingleCooling/*/setpoint_temperature_schedule_name"});
}

/// Those too by which fans and units run or take in outdoor air.
Fields operation_fields(const Json& objects) {
  Fields fields = fields_of(
      objects, {"AvailabilityManager:Scheduled/*/schedule_name",
                "AvailabilityManager:NightCycle/*/fan_schedule_name",
                "Fan:*/*/availability_schedule_name", "ZoneHVAC:*/*/availability_schedule_name",
                "ZoneHVAC:*/*/supply_air_fan_operating_mode_schedule_name",
                "AirLoopHVAC:Unitary*/*/availability_schedule_name",
                "AirLoopHVAC:Unitary*/*/supply_air_fan_operating_mode_schedule_name",
                "Controller:OutdoorAir/*/minimum_outdoor_air_schedule_name"});
  for (Pointer& field : thermostat_fields(objects)) fields.push_back(std::move(field));
  return fields;
}

using ChangeSpan = std::function<void(ScheduleSpan&)>;

/// Lets the fields name changed copies of their schedules. Others that use them keep them.
/// @param label  Of the copies' names: its own for each change of the same schedules.
/// @return how many schedules differ from what they were.
std::size_t change_schedules(const Fields& fields, std::string_view label, const ChangeSpan& change,
                             Json& objects) {
  std::map<std::string, std::string> copies;  // by lower-case name; empty: as it was
  for (const Pointer& field : fields) {
    if (!objects.contains(field) || !objects.at(field).is_string()) continue;
    const std::string name = objects.at(field).get<std::string>();
    const auto [copy, is_new] = copies.try_emplace(to_lower(name));
    if (is_new) {
      auto schedule = read_schedule(objects, name);
      if (!schedule) continue;
      const Json before = compact_schedule(*schedule);
      std::ranges::for_each(schedule->spans, change);
      Json after = compact_schedule(*schedule);
      if (after == before) continue;
      copy->second = fmt::format("{} {}", name, label);
      objects[kCompact][copy->second] = std::move(after);
    }
    if (!copy->second.empty()) objects[field] = copy->second;
  }
  return static_cast<std::size_t>(
      std::ranges::count_if(copies, [](const auto& copy) { return !copy.second.empty(); }));
}

/// Minutes at which the day has another value than before.
std::vector<int> steps_of(const DayValues& day) {
  std::vector<int> steps;
  for (std::size_t i = 0; i + 1 < day.size(); ++i) {
    if (day[i].value != day[i + 1].value) steps.push_back(day[i].minute);
  }
  return steps;
}

double value_at(const DayValues& day, int minute) {
  const auto part =
      std::ranges::find_if(day, [&](const UntilValue& one) { return minute < one.minute; });
  return part == day.end() ? day.back().value : part->value;
}

/// The first share of the hours between a weekday's first and last step is as on that weekday.
void run_as_on_a_weekday(const DayValues& weekday, double share, DayValues& day) {
  const std::vector<int> steps = steps_of(weekday);
  if (share <= 0.0) return;
  const int from = steps.empty() ? 0 : steps.front();
  const int last = steps.empty() ? kMinutesADay : steps.back();
  const int to = from + static_cast<int>(std::lround(share * (last - from)));
  if (to <= from) return;
  const DayValues before = day;
  day.clear();
  const auto add = [&](int minute, double value) {
    if (!day.empty() && day.back().value == value) {
      day.back().minute = minute;
    } else {
      day.push_back({minute, value});
    }
  };
  std::vector<int> ends{from, to, kMinutesADay};
  for (const DayValues& one : {before, weekday}) {
    for (const UntilValue& part : one) ends.push_back(part.minute);
  }
  std::ranges::sort(ends);
  int begun = 0;
  for (const int end : ends) {
    if (end <= begun) continue;
    add(end, value_at(from <= begun && begun < to ? weekday : before, begun));
    begun = end;
  }
}

ChangeSpan weekend_operation(double saturday_share, double sunday_share) {
  return [=](ScheduleSpan& span) {
    const DayValues weekday = span.days[kWednesday];
    run_as_on_a_weekday(weekday, saturday_share, span.days[kSaturday]);
    run_as_on_a_weekday(weekday, sunday_share, span.days[kSunday]);
  };
}

/// Moves what happens in a half of a working day.
ChangeSpan moved_steps(double hours, bool is_afternoon) {
  return [=](ScheduleSpan& span) {
    const int by = static_cast<int>(std::lround(60.0 * hours));
    for (std::size_t kind = kMonday; kind <= kFriday; ++kind) {
      DayValues moved;
      for (const UntilValue& part : span.days[kind]) {
        const bool moves = part.minute < kMinutesADay && (part.minute > kNoon) == is_afternoon;
        const int minute = moves ? std::clamp(part.minute + by, 1, kMinutesADay) : part.minute;
        if (moved.empty() || minute > moved.back().minute) moved.push_back({minute, part.value});
      }
      moved.back().minute = kMinutesADay;
      span.days[kind] = std::move(moved);
    }
  };
}

/// Set-points come nearer to those of occupied hours.
ChangeSpan weaker_set_back(double missing_share, bool is_heating) {
  return [=](ScheduleSpan& span) {
    const DayValues& day = span.days[kWednesday];
    double occupied = day.front().value;
    for (const UntilValue& part : day) {
      occupied = is_heating ? std::max(occupied, part.value) : std::min(occupied, part.value);
    }
    for (std::size_t kind = kSunday; kind <= kHoliday; ++kind) {
      for (UntilValue& part : span.days[kind]) {
        const double nearer = part.value + missing_share * (occupied - part.value);
        part.value = is_heating ? std::max(part.value, nearer) : std::min(part.value, nearer);
      }
    }
  };
}

std::size_t weaken_set_backs(double missing_share, Json& objects) {
  Fields heating;
  Fields cooling;
  for (Pointer& field : thermostat_fields(objects)) {
    const std::string type = field.parent_pointer().parent_pointer().back();
    const bool is_cooling =
        field.back().starts_with("cooling") || type == "ThermostatSetpoint:SingleCooling";
    (is_cooling ? cooling : heating).push_back(std::move(field));
  }
  const auto change = [&](const Fields& fields, bool is_heating) {
    return change_schedules(
        fields, fmt::format("night_setback_missing {}", is_heating ? "heating" : "cooling"),
        weaker_set_back(missing_share, is_heating), objects);
  };
  return change(heating, true) + change(cooling, false);
}

/// What people do with their lights and machines, without what never stops.
ChangeSpan fewer_people(double left_share) {
  return [=](ScheduleSpan& span) {
    double least = span.days[kWednesday].front().value;
    for (std::size_t kind = kSunday; kind <= kHoliday; ++kind) {
      for (const UntilValue& part : span.days[kind]) least = std::min(least, part.value);
    }
    for (std::size_t kind = kSunday; kind <= kHoliday; ++kind) {
      for (UntilValue& part : span.days[kind]) {
        part.value = least + left_share * (part.value - least);
      }
    }
  };
}

std::size_t empty_rooms(double absent_share, Json& objects) {
  constexpr double kOfLoads = 0.8;  // as in the catalogue
  std::size_t changed = 0;
  for (const auto& [type, field, left] :
       {std::tuple{"People", "number_of_people_schedule_name", 1.0 - absent_share},
        {"Lights", "schedule_name", 1.0 - kOfLoads * absent_share},
        {"ElectricEquipment", "schedule_name", 1.0 - kOfLoads * absent_share}}) {
    changed += change_schedules(find_fields(objects, fmt::format("{}/*/{}", type, field)),
                                fmt::format("vacancy {}", type), fewer_people(left), objects);
  }
  return changed;
}

// ---- loads

std::string always_on(Json& objects) {
  ScheduleValues always{"", {{12, 31, {}}}};
  always.spans.front().days.fill({{kMinutesADay, 1.0}});
  objects[kCompact][kAlways] = compact_schedule(always);
  return kAlways;
}

/// Electric equipment of rooms, without servers, which EnergyPlus models in another way.
struct Equipment {
  std::vector<Level> levels;
  double installed_kW = 0.0;
  double mean_kW = 0.0;  ///< Over a year without holidays.
};

/// Of a schedule over a year without holidays; 1 where it cannot be read.
double mean_of_schedule(const Json& objects, const std::string& name) {
  const auto schedule = read_schedule(objects, name);
  if (!schedule) return 1.0;
  double sum = 0.0;
  double days = 0.0;
  int begun = 0;
  for (const ScheduleSpan& span : schedule->spans) {
    const int end = 31 * (span.month - 1) + span.day;  // nearly a day of the year
    double of_week = 0.0;
    for (std::size_t kind = kSunday; kind <= kSaturday; ++kind) {
      int from = 0;
      for (const UntilValue& part : span.days[kind]) {
        of_week += part.value * (part.minute - from) / kMinutesADay;
        from = part.minute;
      }
    }
    sum += of_week / 7.0 * (end - begun);
    days += end - begun;
    begun = end;
  }
  return days > 0.0 ? sum / days : 1.0;
}

Equipment equipment_of(const Json& objects) {
  Equipment found{Rooms{objects}.equipment()};
  std::erase_if(found.levels, [](const Level& level) {
    return !level.field.to_string().starts_with("/ElectricEquipment/");
  });
  for (const Level& level : found.levels) {
    const double kW = level.total / kWattsPerKilowatt;
    const Json& object = objects.at(level.field.parent_pointer());
    found.installed_kW += kW;
    found.mean_kW += kW * mean_of_schedule(objects, text_of(object, "schedule_name"));
  }
  return found;
}

/// Adds a share of what is there. @param schedule  Empty: as what is there.
/// @return how many objects were added.
std::size_t add_equipment(const Equipment& there, double share, const std::string& schedule,
                          std::string_view label, Json& objects) {
  for (const Level& level : there.levels) {
    const Pointer place = level.field.parent_pointer();
    Json more = objects.at(place);
    Json& amount = more.at(level.field.back());
    amount = level.sense == Sense::reciprocal ? amount.get<double>() / share
                                              : amount.get<double>() * share;
    if (!schedule.empty()) more["schedule_name"] = schedule;
    objects["ElectricEquipment"][fmt::format("{} {}", place.back(), label)] = std::move(more);
  }
  return there.levels.size();
}

std::size_t add_servers(double power_kW, Json& objects) {
  const Equipment there = equipment_of(objects);
  if (there.installed_kW <= 0.0) return 0;
  return add_equipment(there, power_kW / there.installed_kW, always_on(objects), "server_room",
                       objects);
}

/// @param power_kW  Mean power; what goes goes from what is there, by its hours.
std::size_t step_equipment(double power_kW, double following_use, Json& objects) {
  const Equipment there = equipment_of(objects);
  if (there.mean_kW <= 0.0) return 0;
  if (power_kW < 0.0) {
    const double left = std::max(1.0 + power_kW / there.mean_kW, 0.0);
    for (const Level& level : there.levels) {
      apply({.pattern = "", .fields = {level.field}, .sense = level.sense}, ChangeKind::scale, left,
            objects);
    }
    return there.levels.size();
  }
  add_equipment(there, (1.0 - following_use) * power_kW / there.installed_kW, always_on(objects),
                "equipment_step", objects);
  return add_equipment(there, following_use * power_kW / there.mean_kW, "", "equipment_step use",
                       objects);
}

std::size_t light_outside(double power_kW, Json& objects) {
  objects["Exterior:Lights"]["recald exterior_lighting"] = {
      {"schedule_name", always_on(objects)},
      {"design_level", kWattsPerKilowatt * power_kW},
      {"control_option", "AstronomicalClock"}};
  return 1;
}

// ---- air

std::size_t fail_economisers(double failed_share, Json& objects) {
  std::size_t failed = 0;
  for (const Pointer& field :
       find_fields(objects, "Controller:OutdoorAir/*/economizer_control_type")) {
    Json& controller = objects.at(field.parent_pointer());
    if (equals_ignoring_case(text_of(controller, "economizer_control_type"), "NoEconomizer")) {
      continue;
    }
    const double least = number_of(controller, "minimum_outdoor_air_flow_rate");
    const double most = number_of(controller, "maximum_outdoor_air_flow_rate");
    if (most <= least) continue;  // its flow has no size yet
    ++failed;
    if (failed_share >= 1.0) {
      controller["economizer_control_type"] = "NoEconomizer";
    } else {
      controller["maximum_outdoor_air_flow_rate"] = most - failed_share * (most - least);
    }
  }
  return failed;
}

/// EnergyPlus has flow = design * (constant + temperature + velocity + velocity squared).
std::size_t leak_in_wind(double factor, double exponent, Json& objects) {
  std::size_t changed = 0;
  const auto all = objects.find("ZoneInfiltration:DesignFlowRate");
  if (all == objects.end()) return 0;
  for (auto& [name, leak] : all->items()) {
    const double wind = kUsualWind_m_s;
    // EnergyPlus takes one for the constant where no term is given.
    const double usual = number_of(leak, "constant_term_coefficient", 1.0) +
                         number_of(leak, "velocity_term_coefficient") * wind +
                         number_of(leak, "velocity_squared_term_coefficient") * wind * wind;
    const double more = factor * usual * std::pow(wind, exponent - 1.0);
    leak["velocity_term_coefficient"] = number_of(leak, "velocity_term_coefficient") + more;
    ++changed;
  }
  return changed;
}

std::size_t run_fans_at_constant_speed(double share, Json& objects) {
  const auto fans = objects.find("Fan:VariableVolume");
  if (fans == objects.end()) return 0;
  for (auto& [name, fan] : fans->items()) {
    for (int term = 1; term <= 5; ++term) {
      const std::string field = fmt::format("fan_power_coefficient_{}", term);
      fan[field] = (1.0 - share) * number_of(fan, field) + (term == 1 ? share : 0.0);
    }
  }
  return fans->size();
}

/// A parameter of the library at a factor of what it is.
std::size_t scale_parameters(std::initializer_list<std::string_view> names, double factor,
                             const ModelDocument& model, Json& objects) {
  std::size_t fields = 0;
  for (const std::string_view name : names) {
    const auto known = find_known_parameter(model, name);
    if (!known) continue;
    for (const Target& target : known->targets) {
      apply(target, ChangeKind::scale, factor, objects);
      fields += target.fields.size();
    }
  }
  return fields;
}

/// How an effect changes a model; none where it returns 0.
struct Entry {
  /// As the catalogue names it, with a value by which every model that can have the effect changes.
  struct Parameter {
    std::string_view name;
    double trial;
  };
  std::string_view effect;
  std::vector<Parameter> parameters;  ///< Of the catalogue's, in the order of `apply`.
  std::size_t (*apply)(Values values, const ModelDocument& model, Json& objects);
};

// In order of their ids.
const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"after_hours",
       {{"late_stop", 2.0}},
       [](Values v, const ModelDocument&, Json& objects) {
         return change_schedules(operation_fields(objects), "after_hours", moved_steps(v[0], true),
                                 objects);
       }},
      {"constant_speed_fans",
       {{"constant_share", 0.5}},
       [](Values v, const ModelDocument&, Json& objects) {
         return run_fans_at_constant_speed(v[0], objects);
       }},
      {"early_start",
       {{"lead", 2.0}, {"lead_per_cold", 0.0}},
       [](Values v, const ModelDocument&, Json& objects) {
         const double lead_h = v[0] + kUsualCold_K * v[1];
         return change_schedules(operation_fields(objects), "early_start",
                                 moved_steps(-lead_h, false), objects);
       }},
      {"economiser_failed",
       {{"failed_share", 0.5}},
       [](Values v, const ModelDocument&, Json& objects) {
         return fail_economisers(v[0], objects);
       }},
      {"equipment_step",
       {{"power", 1.0}, {"following_use", 0.5}},
       [](Values v, const ModelDocument&, Json& objects) {
         return step_equipment(v[0], v[1], objects);
       }},
      {"exterior_lighting",
       {{"power", 1.0}},
       [](Values v, const ModelDocument&, Json& objects) { return light_outside(v[0], objects); }},
      {"night_setback_missing",
       {{"missing_share", 0.5}},
       [](Values v, const ModelDocument&, Json& objects) {
         return weaken_set_backs(v[0], objects);
       }},
      {"outdoor_air_amount",
       {{"change", 0.2}},
       [](Values v, const ModelDocument& model, Json& objects) {
         return scale_parameters({"outdoor_airflow"}, 1.0 + v[0], model, objects);
       }},
      {"server_room",
       {{"power", 1.0}},
       [](Values v, const ModelDocument&, Json& objects) { return add_servers(v[0], objects); }},
      {"solar_gain_change",
       {{"solar_reduction", 0.2}},
       [](Values v, const ModelDocument& model, Json& objects) {
         return scale_parameters({"shgc_scale", "solar_transmittance_scale"}, 1.0 - v[0], model,
                                 objects);
       }},
      {"vacancy",
       {{"absent_share", 0.5}},
       [](Values v, const ModelDocument&, Json& objects) { return empty_rooms(v[0], objects); }},
      {"weekend_operation",
       {{"saturday_share", 0.8}, {"sunday_share", 0.8}},
       [](Values v, const ModelDocument&, Json& objects) {
         return change_schedules(operation_fields(objects), "weekend_operation",
                                 weekend_operation(v[0], v[1]), objects);
       }},
      {"wind_infiltration",
       {{"wind_factor", 0.2}, {"wind_exponent", 1.0}},
       [](Values v, const ModelDocument&, Json& objects) {
         return leak_in_wind(v[0], v[1], objects);
       }},
  };
  return all;
}

}  // namespace

std::vector<std::string_view> patched_effects() {
  std::vector<std::string_view> ids;
  for (const Entry& entry : entries()) ids.push_back(entry.effect);
  return ids;
}

Result<EffectPatch> find_effect_patch(const ModelDocument& model, std::string_view effect,
                                      std::span<const std::string> parameters) {
  const auto entry = std::ranges::find(entries(), effect, &Entry::effect);
  if (entry == entries().end()) {
    return failure(ErrorCode::unsupported,
                   fmt::format("an EnergyPlus model cannot be given the effect '{}'", effect));
  }
  std::vector<std::size_t> places;  // of the entry's parameters among the values to come
  std::vector<double> trial;
  for (const Entry::Parameter& parameter : entry->parameters) {
    const auto place = std::ranges::find(parameters, parameter.name);
    if (place == parameters.end()) {
      return failure(
          ErrorCode::unsupported,
          fmt::format("the effect '{}' comes without its parameter '{}', so an EnergyPlus "
                      "model cannot be given it; `recald model revert` takes it out",
                      effect, parameter.name));
    }
    places.push_back(static_cast<std::size_t>(place - parameters.begin()));
    trial.push_back(parameter.trial);
  }
  Json tried = model.objects;
  const std::size_t changed = entry->apply(trial, model, tried);
  if (changed == 0 || tried == model.objects) {
    return failure(ErrorCode::unsupported,
                   fmt::format("the EnergyPlus model has nothing that the effect '{}' would "
                               "change, so it cannot be calibrated while a model version with it "
                               "is in force; `recald model revert` takes it out",
                               effect));
  }
  return EffectPatch{std::string{effect},
                     [entry = *entry, places, model](Values values, Json& objects) {
                       std::vector<double> own;
                       for (const std::size_t place : places) own.push_back(values[place]);
                       entry.apply(own, model, objects);
                     }};
}

}  // namespace recald::energyplus
