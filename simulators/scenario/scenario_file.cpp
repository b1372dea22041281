#include "simulators/scenario/scenario_file.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>

#include "simulators/scenario/archetypes.hpp"
#include "simulators/scenario/sizing.hpp"
#include "simulators/toml/toml_table.hpp"

namespace recald::simulators {
namespace {

constexpr std::array kMasses{Word<bool>{"heavy", true}, Word<bool>{"light", false}};
constexpr std::array kCoolings{Word<CoolingPlant>{"district", CoolingPlant::district},
                               Word<CoolingPlant>{"chiller", CoolingPlant::chiller},
                               Word<CoolingPlant>{"packaged", CoolingPlant::packaged}};
constexpr std::array kVintages{Word<Vintage>{"1980s", Vintage::of_1980s},
                               Word<Vintage>{"2000s", Vintage::of_2000s},
                               Word<Vintage>{"2010s", Vintage::of_2010s}};
constexpr std::array kHeatings{Word<HeatingPlant>{"district_steam", HeatingPlant::district_steam},
                               Word<HeatingPlant>{"district_water", HeatingPlant::district_water},
                               Word<HeatingPlant>{"boiler", HeatingPlant::boiler},
                               Word<HeatingPlant>{"heat_pump", HeatingPlant::heat_pump}};
constexpr std::array kCares{Word<MeterCare>{"perfect", MeterCare::perfect},
                            Word<MeterCare>{"usual", MeterCare::usual},
                            Word<MeterCare>{"gaps", MeterCare::gaps}};
constexpr std::array kSteps{Word<std::chrono::seconds>{"5m", std::chrono::seconds{300}},
                            Word<std::chrono::seconds>{"15m", std::chrono::seconds{900}}};
constexpr std::array kDecoys{Word<Decoy>{"wind_of_another_year", Decoy::wind_of_another_year},
                             Word<Decoy>{"neighbour_meter", Decoy::neighbour_meter}};

std::array<Word<Use>, kUses.size()> use_words() {
  std::array<Word<Use>, kUses.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = {to_string(kUses[i]), kUses[i]};
  return words;
}

std::array<Word<ClimateKind>, kClimateKinds.size()> climate_words() {
  std::array<Word<ClimateKind>, kClimateKinds.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i)
    words[i] = {name_of(kClimateKinds[i]), kClimateKinds[i]};
  return words;
}

/// First come the keys that decide the sizes of everything else.
Drawings read_brief(TomlTable& building, TomlTable& climate, TomlTable& plant) {
  Brief brief;
  building.word("use", use_words(), brief.use);
  brief = typical_brief(brief.use);
  auto storeys = static_cast<std::int64_t>(brief.storeys);
  building.whole("storeys", 1, 40, storeys);
  brief.storeys = static_cast<std::size_t>(storeys);
  building.number("length_m", 15.0, 300.0, brief.length_m);
  building.number("width_m", 10.0, 200.0, brief.width_m);
  building.number("window_share", 0.02, 0.95, brief.window_share);
  building.number("skylight_share", 0.0, 0.5, brief.skylight_share);
  building.word("mass", kMasses, brief.heavy);
  building.word("vintage", kVintages, brief.vintage);
  climate.word("name", climate_words(), brief.climate);
  plant.word("cooling", kCoolings, brief.cooling);
  plant.word("heating", kHeatings, brief.heating);
  return draw_up(brief);
}

void read_constructions(TomlTable& building, Drawings& drawings) {
  building.number("storey_height_m", 2.5, 12.0, drawings.storey_height_m);
  building.number("wall_u_W_m2K", 0.08, 2.5, drawings.wall_u_W_m2K);
  building.number("roof_u_W_m2K", 0.05, 2.0, drawings.roof_u_W_m2K);
  building.number("window_u_W_m2K", 0.5, 5.0, drawings.window_u_W_m2K);
  building.number("window_shgc", 0.1, 0.8, drawings.window_shgc);
  building.number("leakage_cm2_m2", 0.1, 10.0, drawings.leakage_cm2_m2);
  building.number("occupancy_person_m2", 0.0, 0.5, drawings.occupancy_person_m2);
  building.number("lighting_W_m2", 1.0, 40.0, drawings.perimeter_rooms.lighting_W_m2);
  building.number("plugs_W_m2", 0.5, 150.0, drawings.perimeter_rooms.plugs_W_m2);
  building.number("core_plugs_W_m2", 0.5, 150.0, drawings.core_rooms.plugs_W_m2);
}

void read_controls(TomlTable& controls, Drawings& drawings) {
  controls.number("cooling_setpoint_C", 21.0, 27.5, drawings.cooling_setpoint_C);
  controls.number("heating_setpoint_C", drawings.heating_setpoint_min_C,
                  drawings.heating_setpoint_max_C, drawings.heating_setpoint_C);
  controls.number("night_cooling_C", 24.0, 35.0, drawings.night_cooling_C);
  controls.number("night_heating_C", 10.0, 20.0, drawings.night_heating_C);
  if (!drawings.never_stops()) {
    controls.number("occupied_from_h", 2.0, 12.0, drawings.occupied_from_h);
    controls.number("occupied_to_h", 13.0, 23.0, drawings.occupied_to_h);
  }
  controls.number("supply_C", 11.0, 16.0, drawings.supply_C);
  controls.number("economiser_limit_C", 5.0, 30.0, drawings.economiser_limit_C);
}

void read_period(TomlTable& period, Scenario& scenario) {
  std::int64_t start = scenario.period.start_year;
  std::int64_t years = scenario.period.years;
  period.whole("start", 1972, 2036, start);
  period.whole("years", 1, 20, years);
  period.word("step", kSteps, scenario.step);
  scenario.period = {static_cast<int>(start), static_cast<int>(years)};
}

/// The meter must exist under the name it has in the readings.
std::optional<Utility> meter_named(const std::string& name, const Drawings& drawings) {
  for (const MeterPlate& plate : plates_of(drawings)) {
    if (plate.id == name) return plate.utility;
  }
  return std::nullopt;
}

HiddenChoice read_effect(TomlTable& table, const Drawings& drawings, Complaint& complaint) {
  HiddenChoice choice{};
  const std::string name = table.text("name");
  choice.kind = find_effect_kind(name);
  if (choice.kind == nullptr) {
    Names names;
    for (const EffectKind& kind : effect_kinds()) names.emplace(kind.id);
    complaint.about(table.node(), name.empty()
                                      ? std::string("an [[effect]] needs a name")
                                      : fmt::format("unknown effect {}{}; recald-sim building "
                                                    "--list-effects explains them all",
                                                    name, did_you_mean(name, names)));
    return choice;
  }
  choice.strength = choice.kind->strength.typical;
  table.number("strength", -1e9, 1e9, choice.strength);
  choice.from = table.day("from");
  choice.to = table.day("to");
  if (const std::string meter = table.text("meter"); !meter.empty()) {
    choice.meter = meter_named(meter, drawings);
    if (!choice.meter) {
      std::string there;
      for (const MeterPlate& plate : plates_of(drawings)) {
        there += (there.empty() ? "" : ", ") + std::string(plate.id);
      }
      complaint.about(
          table.node(),
          fmt::format("effect {}: this building has no meter {}; it has {}", name, meter, there));
    }
  }
  return choice;
}

class Reader {
 public:
  Reader(const toml::table& file, Complaint& complaint) : file_(file), complaint_(complaint) {}

  Scenario read() {
    TomlTable building = table("building");
    TomlTable climate = table("climate");
    TomlTable plant = table("plant");
    TomlTable controls = table("controls");
    TomlTable calendar = table("calendar");
    TomlTable meters = table("meters");
    TomlTable period = table("period");
    Scenario scenario;
    scenario.drawings = read_brief(building, climate, plant);
    read_constructions(building, scenario.drawings);
    size_services(scenario.drawings);
    read_controls(controls, scenario.drawings);
    plant.number("chiller_cop", 2.0, 9.0, scenario.drawings.chiller_cop);
    plant.number("heat_pump_cop", 1.5, 6.0, scenario.drawings.heat_pump_cop);
    plant.number("heating_efficiency", 0.5, 0.99, scenario.drawings.heating_efficiency);
    calendar.word("of", use_words(), scenario.drawings.calendar);
    meters.word("care", kCares, scenario.care);
    read_period(period, scenario);
    for (TomlTable* each : {&building, &climate, &plant, &controls, &calendar, &meters, &period}) {
      each->no_other_keys();
    }
    read_lists(scenario);
    no_other_tables();
    return scenario;
  }

 private:
  TomlTable table(std::string_view name) {
    names_.emplace(name);
    const toml::node* node = file_.get(name);
    if (node != nullptr && !node->is_table()) {
      complaint_.about(node, fmt::format("{} must be a table: write [{}]", name, name));
    }
    return {node == nullptr ? nullptr : node->as_table(), name, complaint_};
  }

  template <class Read>
  void each_in(std::string_view name, const Read& read) {
    names_.emplace(name);
    const toml::node* node = file_.get(name);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr || !list->is_array_of_tables()) {
      complaint_.about(node, fmt::format("{} must be a list: write [[{}]]", name, name));
      return;
    }
    for (const toml::node& entry : *list) {
      TomlTable table(entry.as_table(), name, complaint_);
      read(table);
      table.no_other_keys();
    }
  }

  void read_lists(Scenario& scenario) {
    each_in("effect", [&](TomlTable& table) {
      scenario.effects.push_back(read_effect(table, scenario.drawings, complaint_));
    });
    each_in("decoy", [&](TomlTable& table) {
      Decoy decoy = Decoy::neighbour_meter;
      table.word("name", kDecoys, decoy);
      scenario.decoys.push_back(decoy);
    });
  }

  void no_other_tables() {
    for (const auto& [key, node] : file_) {
      if (names_.contains(key.str())) continue;
      complaint_.about(
          &node, fmt::format("unknown table {}{}", key.str(), did_you_mean(key.str(), names_)));
    }
  }

  const toml::table& file_;
  Complaint& complaint_;
  Names names_;
};

}  // namespace

Result<Scenario> read_scenario(const std::filesystem::path& path) {
  const auto file = read_toml(path, "scenario");
  if (!file) return tl::unexpected(file.error());
  Complaint complaint(path.string());
  Scenario scenario = Reader(*file, complaint).read();
  if (!complaint.empty()) return failure(ErrorCode::invalid_value, complaint.sentence());
  if (const auto possible = check_effects(scenario); !possible) {
    return failure(ErrorCode::invalid_value, path.string() + ": " + possible.error().message);
  }
  return scenario;
}

}  // namespace recald::simulators
