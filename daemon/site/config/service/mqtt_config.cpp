#include "daemon/site/config/service/mqtt_config.hpp"

#include <fmt/format.h>

namespace recald::daemon {
namespace {

using std::chrono::seconds;

/// Topics under which something is published have no wildcards and no empty parts at their ends.
void check_topic(TomlReader& table, std::string_view key, const std::string& topic) {
  const bool is_one = !topic.empty() && topic.find_first_of(" \t\r\n+#") == std::string::npos &&
                      topic.front() != '/' && topic.back() != '/' && topic.front() != '$';
  if (is_one) return;
  table.problem_at(key, fmt::format("'{}' is \"{}\"; write a topic such as \"buildings/recald\", "
                                    "without blanks, + and #, and without a slash at its ends",
                                    key, topic));
}

void check_pointer(TomlReader& table, std::string_view key, const std::string& pointer) {
  if (!table.has(key) || pointer.starts_with('/')) return;
  table.problem_at(key, fmt::format("'{}' is \"{}\"; write a JSON pointer such as "
                                    "\"/energy/total\"",
                                    key, pointer));
}

struct Unit {
  std::string_view key;
  bool is_rate;
  const char* example;
};

/// The table of one value; nothing if it is absent.
std::optional<MqttValue> read_value(TomlReader& meter, const Unit& unit, metering::Utility utility,
                                    const metering::UnitFactors& factors) {
  auto table = meter.table(unit.key);
  if (!table) return {};
  MqttValue value{.topic = table->required_text("topic"),
                  .pointer = table->text_or("pointer", ""),
                  .time_pointer = table->text_or("time_pointer", "")};
  if (value.topic.find_first_of("+#") != std::string::npos) {
    table->problem_at("topic", "'topic' has a wildcard; a value comes from one topic");
  }
  check_pointer(*table, "pointer", value.pointer);
  check_pointer(*table, "time_pointer", value.time_pointer);
  const std::string name = table->required_text("unit");
  if (const auto conversion = metering::find_unit(name, utility, factors); !conversion) {
    if (!name.empty()) table->problem_at("unit", conversion.error().message);
  } else if (conversion->is_rate != unit.is_rate) {
    table->problem_at("unit", fmt::format("'unit' is \"{}\"; '{}' needs one such as {}", name,
                                          unit.key, unit.example));
  } else {
    value.factor = conversion->factor;
  }
  table->finish();
  return value;
}

modbus::RegisterField float64_at(std::string name, std::uint16_t address, std::string unit) {
  return {.name = std::move(name),
          .address = address,
          .format = {.type = modbus::RegisterType::f64},
          .unit = std::move(unit)};
}

void add_counter(modbus::RegisterMap& map) {
  map.fields.push_back(float64_at("energy", 0, "kWh"));
  map.energy = {"energy"};
}

}  // namespace

MqttConfig read_mqtt(TomlReader& table, const std::string& site_id,
                     const std::filesystem::path& site_file) {
  MqttConfig config;
  config.broker = read_broker(table, site_file, "recald-" + site_id);
  config.publishes = table.boolean("publish").value_or(config.publishes);
  config.topic = table.text_or("topic", config.topic);
  check_topic(table, "topic", config.topic);
  if (const auto prefix = table.text("home_assistant")) {
    config.home_assistant = *prefix;
    check_topic(table, "home_assistant", *prefix);
    if (!config.publishes) {
      table.problem_at("home_assistant", "'home_assistant' needs publish = true");
    }
  }
  table.finish();
  return config;
}

MqttMeterConfig sent_counter(seconds interval) {
  MqttMeterConfig config{.every = interval};
  config.map.name = "http";
  config.map.limits.one_request_per_field = true;
  add_counter(config.map);
  return config;
}

MqttMeterConfig read_mqtt_meter(TomlReader& table, metering::Utility utility,
                                const metering::UnitFactors& factors) {
  MqttMeterConfig config;
  config.energy = read_value(table, {"energy_from", false, "kWh or MWh"}, utility, factors);
  config.power = read_value(table, {"power_from", true, "W or kW"}, utility, factors);
  config.map.name = "mqtt";
  config.map.limits.one_request_per_field = true;
  if (config.energy) add_counter(config.map);
  if (config.power) {
    config.map.fields.push_back(float64_at("power", 4, "kW"));
    config.map.power = "power";
  }
  if (!table.has("energy_from") && !table.has("power_from")) {
    table.problem(
        "a meter with source = \"mqtt\" needs 'energy_from' (a counter), 'power_from' or both, "
        "such "
        "as energy_from = { topic = \"plant/heat\", pointer = \"/total\", unit = \"MWh\" }");
  }
  config.every = table.duration("every").value_or(config.every);
  const seconds longest{config.energy ? 900 : 120};
  if (config.every <= seconds{0} || config.every > longest) {
    table.problem_at("every", config.energy
                                  ? "'every' must lie between \"1s\" and \"15m\""
                                  : "'every' must lie between \"1s\" and \"2m\": the meter has no "
                                    "counter, so its power is averaged");
    config.every = seconds{60};
  }
  return config;
}

}  // namespace recald::daemon
