#include "daemon/site/config/register_map_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <set>
#include <sstream>

#include "adapters/system/files/regular_file.hpp"
#include "core/metering/units.hpp"
#include "core/text/nearest.hpp"
#include "core/weather/sensor_quantities.hpp"
#include "daemon/site/config/shipped_register_maps.hpp"

namespace recald::daemon {
namespace {

using modbus::RegisterField;
using modbus::RegisterMap;

/// What holds for all registers of a map unless one says otherwise.
struct MapDefaults {
  int base = 0;
  modbus::WordOrder order = modbus::WordOrder::ABCD;
};

std::optional<std::uint64_t> parse_hex(std::string_view text) {
  if (!text.starts_with("0x")) return {};
  text.remove_prefix(2);
  std::uint64_t bits = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bits, 16);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return {};
  return bits;
}

std::optional<std::uint64_t> read_bits(TomlReader& table, std::string_view key, int width) {
  const auto text = table.text(key);
  if (!text) return {};
  const auto bits = parse_hex(*text);
  if (!bits) {
    table.problem_at(key, fmt::format("'{}' is \"{}\"; write its bits as \"0x8000\"", key, *text));
    return {};
  }
  if (width < 64 && *bits >> width != 0) {
    table.problem_at(key,
                     fmt::format("'{}' is {}, more than the type's {} bits", key, *text, width));
    return {};
  }
  return bits;
}

std::uint16_t read_address(TomlReader& table, int base, int words) {
  if (!table.has("at")) table.problem("'at' is missing: the address of the first register");
  const int at = table.whole_number_or("at", base, {0.0, 65'536.0});
  const int address = at - base;
  if (address < 0 || address + words > 65'536) {
    table.problem_at("at", fmt::format("'at' is {}; with base {} and {} registers it must lie "
                                       "between {} and {}",
                                       at, base, words, base, 65'536 - words + base));
    return 0;
  }
  return static_cast<std::uint16_t>(address);
}

modbus::ValueFormat read_format(TomlReader& table, const MapDefaults& defaults) {
  modbus::ValueFormat format{.order = defaults.order};
  if (const auto type = table.required_text("type"); !type.empty()) {
    if (const auto parsed = modbus::parse_register_type(type)) {
      format.type = *parsed;
    } else {
      table.problem_at("type", parsed.error().message);
    }
  }
  if (const auto order = table.text("order")) {
    if (const auto parsed = modbus::parse_word_order(*order)) {
      format.order = *parsed;
    } else {
      table.problem_at("order", parsed.error().message);
    }
  }
  format.scale = table.number_or("scale", 1.0);
  if (format.scale == 0.0) table.problem_at("scale", "'scale' is 0; every value would be 0");
  format.offset = table.number_or("offset", 0.0);
  const int width = 16 * modbus::word_count(format.type);
  format.absent = read_bits(table, "absent", width);
  format.mask = read_bits(table, "mask", width);
  const bool is_unsigned = format.type == modbus::RegisterType::u16 ||
                           format.type == modbus::RegisterType::u32 ||
                           format.type == modbus::RegisterType::u64;
  if (format.mask && !is_unsigned) {
    table.problem_at("mask", fmt::format("'mask' works on u16, u32 and u64, not on {}",
                                         modbus::to_string(format.type)));
  }
  return format;
}

RegisterField read_field(TomlReader& table, const std::string& name, const MapDefaults& defaults) {
  RegisterField field{.name = name};
  field.format = read_format(table, defaults);
  field.address = read_address(table, defaults.base, field.words());
  field.unit = table.text_or("unit", "");
  field.modulus = table.number("modulus", kPositive);
  field.scale_factor = table.text("scale_factor");
  table.finish();
  return field;
}

std::vector<RegisterField> read_fields(TomlReader& root, const MapDefaults& defaults) {
  std::vector<RegisterField> fields;
  auto registers = root.table("register");
  if (!registers) {
    if (!root.has("register")) root.problem("there is no [register.NAME]");
    return fields;
  }
  for (const std::string& name : registers->keys()) {
    if (auto table = registers->table(name)) fields.push_back(read_field(*table, name, defaults));
  }
  return fields;
}

/// The field that a key names, if it is there; a name without a field is a problem.
const RegisterField* require_field(TomlReader& root, std::string_view key, const std::string& name,
                                   const RegisterMap& map) {
  if (const RegisterField* field = map.find(name)) return field;
  root.problem_at(key,
                  fmt::format("'{}' names '{}', but there is no [register.{}]", key, name, name));
  return nullptr;
}

/// Energy fields must count an energy, the power field measure a power.
void require_unit(TomlReader& root, std::string_view key, const RegisterField& field,
                  bool is_rate) {
  const auto unit = metering::find_unit(field.unit, metering::Utility::electricity, {});
  if (unit && unit->is_rate == is_rate) return;
  root.problem_at(
      key, fmt::format("'{}' names '{}', whose unit is \"{}\"; it must be {}, such as {}", key,
                       field.name, field.unit, is_rate ? "a power" : "an energy",
                       is_rate ? "kW" : "kWh"));
}

/// A register of the weather is called like what it measures and has that unit.
void require_quantity(TomlReader& root, const std::string& name, const RegisterMap& map) {
  const weather::SensorQuantity* const quantity = weather::find_quantity(name);
  if (quantity == nullptr) {
    root.problem_at("weather", fmt::format("'weather' names '{}'; a weather sensor measures {}",
                                           name, weather::quantity_units()));
    return;
  }
  const RegisterField* const field = require_field(root, "weather", name, map);
  if (field == nullptr || field->unit == quantity->unit) return;
  root.problem_at("weather",
                  fmt::format("'weather' names '{}', whose unit is \"{}\"; it must be \"{}\" "
                              "('scale' and 'offset' convert others)",
                              name, field->unit, quantity->unit));
}

/// A counter that is named twice would be summed twice.
void require_once(TomlReader& root, const std::vector<std::string>& energy) {
  std::set<std::string> seen;
  for (const std::string& name : energy) {
    if (seen.insert(name).second) continue;
    root.problem_at("energy",
                    fmt::format("'energy' names '{}' twice, so it would count twice", name));
  }
}

/// A power of ten is a field of its own, and a plain one.
void require_scale_factor(TomlReader& root, const RegisterField& field, const RegisterMap& map) {
  if (!field.scale_factor) return;
  const RegisterField* factor = require_field(root, "register", *field.scale_factor, map);
  if (factor == nullptr || !factor->scale_factor) return;
  root.problem_at("register",
                  fmt::format("[register.{}] 'scale_factor' names '{}', which itself has a "
                              "'scale_factor'; a power of ten must be in a single register",
                              field.name, factor->name));
}

/// Whether the map's reads fit what it says of its device.
void require_plan(TomlReader& root, const RegisterMap& map) {
  const auto reads = plan_reads(metered_fields(map), map.function, map.limits);
  if (!reads) root.problem_at("registers_max", reads.error().message);
}

void read_uses(TomlReader& root, RegisterMap& map) {
  const auto energy = root.texts("energy");
  map.energy = energy.value_or(std::vector<std::string>{});
  map.power = root.text("power");
  map.weather = root.texts("weather").value_or(std::vector<std::string>{});
  map.identity = root.texts("identity").value_or(std::vector<std::string>{});
  for (const std::string& name : map.energy) {
    if (const auto* field = require_field(root, "energy", name, map)) {
      require_unit(root, "energy", *field, false);
    }
  }
  if (map.power) {
    if (const auto* field = require_field(root, "power", *map.power, map)) {
      require_unit(root, "power", *field, true);
    }
  }
  for (const std::string& name : map.identity) (void)require_field(root, "identity", name, map);
  for (const std::string& name : map.weather) require_quantity(root, name, map);
  const bool is_weather = root.has("weather");
  if (!root.has("energy") && !root.has("power") && !is_weather) {
    root.problem("has neither 'energy' nor 'power' nor 'weather', so there is nothing to meter");
  } else if (energy && energy->empty() && !root.has("power") && !is_weather) {
    root.problem_at("energy", "'energy' is empty, so there is nothing to meter");
  }
  require_once(root, map.energy);
  for (const RegisterField& field : map.fields) require_scale_factor(root, field, map);
}

modbus::ReadLimits read_limits(TomlReader& root) {
  modbus::ReadLimits limits;
  limits.registers_max =
      root.whole_number_or("registers_max", limits.registers_max, {4.0, modbus::kRegistersMax});
  limits.gap_max = root.whole_number_or("gap_max", limits.gap_max, {0.0, modbus::kRegistersMax});
  limits.one_request_per_field =
      root.boolean("one_request_per_field").value_or(limits.one_request_per_field);
  return limits;
}

std::vector<std::uint16_t> read_sunspec(TomlReader& root) {
  std::vector<std::uint16_t> models;
  for (const std::string& text :
       root.texts("sunspec_models").value_or(std::vector<std::string>{})) {
    std::uint16_t model = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), model);
    if (error == std::errc{} && end == text.data() + text.size()) {
      models.push_back(model);
    } else {
      root.problem_at(
          "sunspec_models",
          fmt::format("'sunspec_models' has \"{}\"; write numbers such as \"203\"", text));
    }
  }
  return models;
}

std::optional<modbus::Words> parse_words(std::string_view text) {
  modbus::Words words;
  std::istringstream in{std::string{text}};
  for (std::string word; in >> word;) {
    const auto bits = parse_hex("0x" + word);
    if (word.size() != 4 || !bits) return {};
    words.push_back(static_cast<std::uint16_t>(*bits));
  }
  if (words.empty()) return {};
  return words;
}

GoldenReply read_golden(TomlReader& table, const RegisterMap& map, int base) {
  GoldenReply golden{.address = read_address(table, base, 1)};
  const std::string words = table.required_text("words");
  if (const auto parsed = parse_words(words)) {
    golden.words = *parsed;
  } else {
    table.problem_at("words", fmt::format("'words' is \"{}\"; write registers as four hexadecimal "
                                          "digits each, such as \"0001 86A0\"",
                                          words));
  }
  if (auto values = table.table("values")) {
    for (const std::string& name : values->keys()) {
      const auto value = values->number(name);
      if (value && require_field(*values, name, name, map) != nullptr) golden.values[name] = *value;
    }
  } else {
    table.problem("'values' is missing: what the words mean, by register name");
  }
  table.finish();
  return golden;
}

modbus::Trust read_trust(TomlReader& root) {
  const auto word = root.word("trust", {"two_sources", "one_source", "local"});
  if (word == "two_sources") return modbus::Trust::two_sources;
  return word == "one_source" ? modbus::Trust::one_source : modbus::Trust::local;
}

RegisterMapFile read_map(TomlReader root, const std::string& name) {
  RegisterMapFile file;
  RegisterMap& map = file.map;
  map.name = name;
  map.title = root.text_or("title", name);
  map.source = root.required_text("source");
  map.trust = read_trust(root);
  MapDefaults defaults;
  if (!root.has("base")) {
    root.problem(
        "'base' is missing: 0 if the document's addresses are those on the wire, 1 if they are "
        "higher by one");
  }
  defaults.base = root.whole_number_or("base", 0, {0.0, 1.0});
  if (root.whole_number_or("fc", 3, {3.0, 4.0}) == 4) {
    map.function = modbus::Function::read_input_registers;
  }
  if (const auto order = root.text("order")) {
    if (const auto parsed = modbus::parse_word_order(*order)) {
      defaults.order = *parsed;
    } else {
      root.problem_at("order", parsed.error().message);
    }
  }
  map.limits = read_limits(root);
  map.sunspec_models = read_sunspec(root);
  map.fields = read_fields(root, defaults);
  read_uses(root, map);
  for (TomlReader& golden : root.tables("golden")) {
    file.golden.push_back(read_golden(golden, map, defaults.base));
  }
  root.finish();
  // Of a map with mistakes it is not known what would be read.
  if (!root.has_problems()) require_plan(root, map);
  return file;
}

}  // namespace

tl::expected<RegisterMapFile, Problems> parse_register_map(std::string_view text,
                                                           const std::string& name) {
  Problems problems;
  const std::string file_name = name.ends_with(".toml") ? name : name + ".toml";
  RegisterMapFile file;
  try {
    const toml::table root = parse_toml(text, file_name);
    file = read_map(TomlReader{root, file_name, "", problems}, name);
  } catch (const toml::parse_error& error) {
    problems.push_back(syntax_problem(file_name, error));
  }
  if (!problems.empty()) return tl::unexpected(problems);
  return file;
}

std::vector<std::string_view> shipped_register_maps() {
  std::vector<std::string_view> names;
  for (const ShippedRegisterMap& map : kShippedRegisterMaps) names.push_back(map.name);
  return names;
}

Result<std::string_view> shipped_register_map(std::string_view name) {
  const auto found =
      std::ranges::find(kShippedRegisterMaps, name, [](const auto& map) { return map.name; });
  if (found != std::end(kShippedRegisterMaps)) return found->text;
  const std::vector<std::string_view> names = shipped_register_maps();
  const std::string_view nearest = nearest_name(name, names);
  return failure(
      ErrorCode::not_found,
      fmt::format(
          "there is no register map '{}'{}; the maps are {}, or name a file that ends in .toml",
          name, nearest.empty() ? "" : fmt::format(", did you mean '{}'", nearest),
          fmt::join(names, ", ")));
}

Result<std::string> read_register_map(const std::string& name,
                                      const std::filesystem::path& folder) {
  const std::filesystem::path given{name};
  const std::filesystem::path path = given.is_absolute() ? given : folder / given;
  std::ifstream in;
  if (system::require_file(path, "register map")) in.open(path, std::ios::binary);
  if (in.is_open()) return std::string{std::istreambuf_iterator<char>{in}, {}};
  return failure(ErrorCode::not_found,
                 fmt::format("register map '{}' cannot be read; name a file next to the site "
                             "file or a shipped map: {}",
                             path.string(), fmt::join(shipped_register_maps(), ", ")));
}

tl::expected<RegisterMap, Problems> find_register_map(const std::string& name,
                                                      const std::filesystem::path& folder) {
  std::string text;
  if (name.ends_with(".toml")) {
    auto own = read_register_map(name, folder);
    if (!own) return tl::unexpected(Problems{own.error().message});
    text = std::move(*own);
  } else {
    const auto shipped = shipped_register_map(name);
    if (!shipped) return tl::unexpected(Problems{shipped.error().message});
    text = *shipped;
  }
  auto file = TRY(parse_register_map(text, name));
  return std::move(file.map);
}

const tl::expected<RegisterMap, Problems>& RegisterMaps::find(const std::string& name) {
  auto known = read_.find(name);
  if (known == read_.end()) known = read_.emplace(name, find_anew(name)).first;
  return known->second;
}

tl::expected<RegisterMap, Problems> RegisterMaps::find_anew(const std::string& name) const {
  if (given_ == nullptr || !name.ends_with(".toml")) return find_register_map(name, folder_);
  const auto text = given_->find(name);
  if (text == given_->end()) {
    return tl::unexpected(Problems{fmt::format("register map '{}' is not given", name)});
  }
  auto file = TRY(parse_register_map(text->second, name));
  return std::move(file.map);
}

}  // namespace recald::daemon
