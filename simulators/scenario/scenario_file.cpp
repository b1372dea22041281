#include "simulators/scenario/scenario_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "adapters/toml/toml_reader.hpp"
#include "core/text/nearest.hpp"
#include "simulators/scenario/archetypes.hpp"
#include "simulators/scenario/sizing.hpp"

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

template <class Value>
void set_number(TomlReader& table, std::string_view key, double min, double max, Value& value) {
  if (const auto given = table.number(key, {min, max})) value = *given;
}

template <class T, std::size_t N>
void set_word(TomlReader& table, std::string_view key, const std::array<Word<T>, N>& words,
              T& value) {
  value = table.word(key, words).value_or(value);
}

/// First come the keys that decide the sizes of everything else.
Drawings read_brief(TomlReader& building, TomlReader& climate, TomlReader& plant) {
  Brief brief;
  set_word(building, "use", use_words(), brief.use);
  brief = typical_brief(brief.use);
  brief.storeys = static_cast<std::size_t>(
      building.whole_number_or("storeys", static_cast<int>(brief.storeys), {1, 40}));
  set_number(building, "length_m", 15.0, 300.0, brief.length_m);
  set_number(building, "width_m", 10.0, 200.0, brief.width_m);
  set_number(building, "window_share", 0.02, 0.95, brief.window_share);
  set_number(building, "skylight_share", 0.0, 0.5, brief.skylight_share);
  set_word(building, "mass", kMasses, brief.heavy);
  set_word(building, "vintage", kVintages, brief.vintage);
  set_word(climate, "name", climate_words(), brief.climate);
  set_word(plant, "cooling", kCoolings, brief.cooling);
  set_word(plant, "heating", kHeatings, brief.heating);
  return draw_up(brief);
}

void read_constructions(TomlReader& building, Drawings& drawings) {
  set_number(building, "storey_height_m", 2.5, 12.0, drawings.storey_height_m);
  set_number(building, "wall_u_W_m2K", 0.08, 2.5, drawings.wall_u_W_m2K);
  set_number(building, "roof_u_W_m2K", 0.05, 2.0, drawings.roof_u_W_m2K);
  set_number(building, "window_u_W_m2K", 0.5, 5.0, drawings.window_u_W_m2K);
  set_number(building, "window_shgc", 0.1, 0.8, drawings.window_shgc);
  set_number(building, "leakage_cm2_m2", 0.1, 10.0, drawings.leakage_cm2_m2);
  set_number(building, "occupancy_person_m2", 0.0, 0.5, drawings.occupancy_person_m2);
  set_number(building, "lighting_W_m2", 1.0, 40.0, drawings.perimeter_rooms.lighting_W_m2);
  set_number(building, "plugs_W_m2", 0.5, 150.0, drawings.perimeter_rooms.plugs_W_m2);
  set_number(building, "core_plugs_W_m2", 0.5, 150.0, drawings.core_rooms.plugs_W_m2);
}

void read_controls(TomlReader& controls, Drawings& drawings) {
  set_number(controls, "cooling_setpoint_C", 21.0, 27.5, drawings.cooling_setpoint_C);
  set_number(controls, "heating_setpoint_C", drawings.heating_setpoint_min_C,
             drawings.heating_setpoint_max_C, drawings.heating_setpoint_C);
  set_number(controls, "night_cooling_C", 24.0, 35.0, drawings.night_cooling_C);
  set_number(controls, "night_heating_C", 10.0, 20.0, drawings.night_heating_C);
  if (!drawings.never_stops()) {
    set_number(controls, "occupied_from_h", 2.0, 12.0, drawings.occupied_from_h);
    set_number(controls, "occupied_to_h", 13.0, 23.0, drawings.occupied_to_h);
  }
  set_number(controls, "supply_C", 11.0, 16.0, drawings.supply_C);
  set_number(controls, "economiser_limit_C", 5.0, 30.0, drawings.economiser_limit_C);
}

void read_period(TomlReader& period, Scenario& scenario) {
  scenario.period = {period.whole_number_or("start", scenario.period.start_year, {1972, 2036}),
                     period.whole_number_or("years", scenario.period.years, {1, 20})};
  set_word(period, "step", kSteps, scenario.step);
}

/// The meter must exist under the name it has in the readings.
std::optional<Utility> meter_named(const std::string& name, const Drawings& drawings) {
  for (const MeterPlate& plate : plates_of(drawings)) {
    if (plate.id == name) return plate.utility;
  }
  return std::nullopt;
}

/// @return nothing, with a problem, for an effect that there is not
std::optional<HiddenChoice> read_effect(TomlReader& table, const Drawings& drawings) {
  const std::string name = table.required_text("name");
  const EffectKind* const kind = find_effect_kind(name);
  if (kind == nullptr) {
    std::vector<std::string_view> names;
    for (const EffectKind& each : effect_kinds()) names.push_back(each.id);
    const std::string_view meant = nearest_name(name, names);
    table.problem(
        fmt::format("unknown effect {}{}; recald-sim building --list-effects explains them all",
                    name, meant.empty() ? "" : fmt::format(" (did you mean {}?)", meant)));
    return {};
  }
  HiddenChoice choice{.kind = kind,
                      .strength = table.number_or("strength", kind->strength.typical),
                      .from = table.day("from"),
                      .to = table.day("to"),
                      .meter = {}};
  if (const std::string meter = table.text_or("meter", ""); !meter.empty()) {
    choice.meter = meter_named(meter, drawings);
    std::vector<std::string_view> there;
    for (const MeterPlate& plate : plates_of(drawings)) there.push_back(plate.id);
    if (!choice.meter) {
      table.problem(fmt::format("effect {}: this building has no meter {}; it has {}", name, meter,
                                fmt::join(there, ", ")));
    }
  }
  return choice;
}

class Reader {
 public:
  explicit Reader(TomlReader file) : file_(std::move(file)) {}

  Scenario read() {
    TomlReader building = table("building");
    TomlReader climate = table("climate");
    TomlReader plant = table("plant");
    TomlReader controls = table("controls");
    TomlReader calendar = table("calendar");
    TomlReader meters = table("meters");
    TomlReader period = table("period");
    Scenario scenario;
    scenario.drawings = read_brief(building, climate, plant);
    read_constructions(building, scenario.drawings);
    size_services(scenario.drawings);
    read_controls(controls, scenario.drawings);
    set_number(plant, "chiller_cop", 2.0, 9.0, scenario.drawings.chiller_cop);
    set_number(plant, "heat_pump_cop", 1.5, 6.0, scenario.drawings.heat_pump_cop);
    set_number(plant, "heating_efficiency", 0.5, 0.99, scenario.drawings.heating_efficiency);
    set_word(calendar, "of", use_words(), scenario.drawings.calendar);
    set_word(meters, "care", kCares, scenario.care);
    read_period(period, scenario);
    for (TomlReader* each : {&building, &climate, &plant, &controls, &calendar, &meters, &period}) {
      each->finish();
    }
    for (TomlReader& effect : file_.tables("effect")) {
      if (const auto choice = read_effect(effect, scenario.drawings)) {
        scenario.effects.push_back(*choice);
        effect.finish();
      }
    }
    for (TomlReader& decoy : file_.tables("decoy")) {
      scenario.decoys.push_back(decoy.word("name", kDecoys).value_or(Decoy::neighbour_meter));
      decoy.finish();
    }
    file_.finish();
    return scenario;
  }

 private:
  /// Without keys where the file does not have it.
  TomlReader table(std::string_view name) {
    static const toml::table kEmpty;
    auto found = file_.table(name);
    return found ? *found : TomlReader{kEmpty, "", "", unread_};
  }

  TomlReader file_;
  Problems unread_;
};

}  // namespace

Result<Scenario> read_scenario(const std::filesystem::path& path) {
  const auto file = TRY(read_toml(path, "scenario"));
  Problems problems;
  Scenario scenario = Reader{TomlReader{file, path.string(), "", problems}}.read();
  if (!problems.empty()) return failure(ErrorCode::invalid_value, problems.front());
  if (const auto possible = check_effects(scenario); !possible) {
    return failure(ErrorCode::invalid_value, path.string() + ": " + possible.error().message);
  }
  return scenario;
}

}  // namespace recald::simulators
