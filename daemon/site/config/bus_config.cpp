#include "daemon/site/config/bus_config.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr NumberRange kPorts{1.0, 65'535.0};
constexpr NumberRange kUnits{0.0, 255.0};

modbus::TcpEndpoint read_tcp(TomlReader& table) {
  modbus::TcpEndpoint tcp;
  tcp.host = table.required_text("host");
  tcp.port = static_cast<std::uint16_t>(table.whole_number_or("port", tcp.port, kPorts));
  tcp.has_rtu_frames = table.word("framing", {"tcp", "rtu"}) == "rtu";
  tcp.connect_delay = table.milliseconds("connect_delay").value_or(tcp.connect_delay);
  tcp.connect_timeout = table.milliseconds("connect_timeout").value_or(tcp.connect_timeout);
  return tcp;
}

/// "8E1": data bits, parity, stop bits.
void read_format(TomlReader& table, modbus::SerialPort& serial) {
  const std::string format = table.text_or("format", "8E1");
  const bool is_right = format.size() == 3 && (format[0] == '7' || format[0] == '8') &&
                        std::string_view{"NEO"}.find(format[1]) != std::string_view::npos &&
                        (format[2] == '1' || format[2] == '2');
  if (!is_right) {
    table.problem_at("format", fmt::format("'format' is \"{}\"; write data bits, parity and stop "
                                           "bits such as \"8E1\" or \"8N2\"",
                                           format));
    return;
  }
  serial.data_bits = format[0] - '0';
  serial.parity = static_cast<modbus::Parity>(format[1]);
  serial.stop_bits = format[2] - '0';
}

modbus::SerialPort read_serial(TomlReader& table) {
  constexpr std::array kBauds{1200, 2400, 4800, 9600, 19'200, 38'400, 57'600, 115'200};
  modbus::SerialPort serial;
  serial.device = table.required_text("port");
  if (!serial.device.empty() && !serial.device.starts_with('/')) {
    serial.device = "/dev/" + serial.device;
  }
  serial.baud = table.whole_number_or("baud", serial.baud, {1.0, 1e6});
  if (std::ranges::find(kBauds, serial.baud) == kBauds.end()) {
    table.problem_at("baud", fmt::format("'baud' is {}; it must be one of {}", serial.baud,
                                         fmt::join(kBauds, ", ")));
  }
  read_format(table, serial);
  return serial;
}

/// Registers that the site file names in the place of the map's.
void read_overrides(TomlReader& table, modbus::RegisterMap& map) {
  const auto require = [&](std::string_view key, const std::string& name) {
    if (map.find(name) != nullptr) return true;
    std::vector<std::string> names;
    for (const modbus::RegisterField& field : map.fields) names.push_back(field.name);
    table.problem_at(key, fmt::format("'{}' names '{}', but map '{}' has {}", key, name, map.name,
                                      fmt::join(names, ", ")));
    return false;
  };
  if (const auto energy = table.texts("energy")) {
    const bool all = std::ranges::all_of(
        *energy, [&](const std::string& name) { return require("energy", name); });
    if (all) map.energy = *energy;
  }
  if (const auto power = table.text("power")) {
    if (require("power", *power)) map.power = *power;
  }
}

/// A counter may be read seldom, for it counts meanwhile. A power says nothing of the time between.
seconds read_poll(TomlReader& table, const modbus::RegisterMap& map) {
  const bool counts = !map.energy.empty() || !map.power;
  const seconds usual{counts ? 60 : 15};
  const seconds poll = table.duration("poll").value_or(usual);
  if (poll > seconds{0} && poll <= seconds{counts ? 900 : 120}) return poll;
  table.problem_at("poll", counts ? "'poll' must lie between \"1s\" and \"15m\""
                                  : "'poll' must lie between \"1s\" and \"2m\": the meter has no "
                                    "counter, so its power is averaged");
  return usual;
}

/// Slower than a load, but averaged as well.
seconds read_sensor_poll(TomlReader& table) {
  constexpr seconds kUsual{60};
  const seconds poll = table.duration("poll").value_or(kUsual);
  if (poll > seconds{0} && poll <= seconds{120}) return poll;
  table.problem_at("poll", "'poll' must lie between \"1s\" and \"2m\": the weather is averaged");
  return kUsual;
}

/// Bus, address and map of any device.
LiveMeterConfig read_device(TomlReader& table, RegisterMaps& maps) {
  LiveMeterConfig device;
  device.bus = table.required_text("bus");
  if (!table.has("unit")) table.problem("'unit' is missing: the device's Modbus address");
  device.unit = static_cast<std::uint8_t>(table.whole_number_or("unit", 1, kUnits));
  if (const std::string name = table.required_text("map"); !name.empty()) {
    if (const auto& map = maps.find(name)) {
      device.map = *map;
    } else {
      for (const std::string& problem : map.error()) table.problem_at("map", problem);
    }
  }
  device.timeout = table.milliseconds("timeout").value_or(device.timeout);
  return device;
}

}  // namespace

BusConfig read_bus(TomlReader& table, const std::string& name) {
  BusConfig bus{.name = name};
  const auto type = table.word("type", {"tcp", "rtu"});
  if (!table.has("type")) table.problem("'type' is missing: \"tcp\" or \"rtu\"");
  if (type == "rtu") {
    bus.endpoint = read_serial(table);
  } else {
    bus.endpoint = read_tcp(table);
  }
  bus.request_gap = table.milliseconds("request_gap").value_or(bus.request_gap);
  bus.timeout = table.milliseconds("timeout").value_or(bus.timeout);
  bus.down_after = table.whole_number_or("down_after", bus.down_after, {1.0, 100.0});
  bus.probe_max = table.duration("probe_max").value_or(bus.probe_max);
  table.finish();
  return bus;
}

LiveMeterConfig read_live_meter(TomlReader& table, RegisterMaps& maps) {
  LiveMeterConfig meter = read_device(table, maps);
  read_overrides(table, meter.map);
  const bool is_metered = !meter.map.energy.empty() || meter.map.power;
  if (!is_metered && !meter.map.weather.empty()) {
    table.problem_at(
        "map",
        fmt::format("map '{}' describes a weather sensor; add role = \"weather\"", meter.map.name));
  }
  meter.map.weather.clear();
  meter.poll = read_poll(table, meter.map);
  return meter;
}

LiveMeterConfig read_live_sensor(TomlReader& table, RegisterMaps& maps) {
  LiveMeterConfig sensor = read_device(table, maps);
  if (!sensor.map.name.empty() && sensor.map.weather.empty()) {
    table.problem_at(
        "map",
        fmt::format(
            "map '{}' has no weather registers; see 'weather' in adapters/modbus/maps/README.md",
            sensor.map.name));
  }
  sensor.map.energy.clear();
  sensor.map.power.reset();
  sensor.poll = read_sensor_poll(table);
  return sensor;
}

milliseconds poll_time(const BusConfig& bus, const LiveMeterConfig& meter) {
  constexpr int kRequestCharacters = 8;
  constexpr int kReplyCharacters = 5;  // beside the registers
  constexpr int kSilences = 7;         // twice 3.5 characters
  const auto reads = plan_reads(metered_fields(meter.map), meter.map.function, meter.map.limits);
  if (!reads) return milliseconds{0};
  milliseconds whole{0};
  for (const modbus::PlannedRead& read : *reads) {
    whole += bus.request_gap;
    if (const auto* serial = std::get_if<modbus::SerialPort>(&bus.endpoint)) {
      const int characters = kRequestCharacters + kReplyCharacters + 2 * read.count + kSilences;
      whole += milliseconds{60} + std::chrono::ceil<milliseconds>(line_time(*serial, characters));
    } else {
      whole += milliseconds{20};
    }
  }
  return whole;
}

}  // namespace recald::daemon
