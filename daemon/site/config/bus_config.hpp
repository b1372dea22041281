/// Buses and what of a [[meter]] belongs to them, as the site file describes them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "adapters/modbus/connection.hpp"
#include "adapters/modbus/register_map.hpp"
#include "adapters/toml/toml_reader.hpp"
#include "daemon/site/config/register_map_file.hpp"

namespace recald::daemon {

/// [bus.NAME]: one TCP endpoint or serial port, shared by its meters.
struct BusConfig {
  std::string name;
  modbus::Endpoint endpoint;
  std::chrono::milliseconds request_gap{0};
  std::chrono::milliseconds timeout{0};  ///< Zero: learned for each device.
  int down_after = 3;
  std::chrono::seconds probe_max{300};

  bool operator==(const BusConfig&) const = default;
};

/// What a [[meter]] with source = "modbus" says.
struct LiveMeterConfig {
  std::string bus;
  std::uint8_t unit = 1;
  /// Its `energy` and `power` as the meter overrides them; of a weather sensor its `weather` alone.
  modbus::RegisterMap map;
  std::chrono::seconds poll{60};         ///< Default 15 s where the map has a power and no counter.
  std::chrono::milliseconds timeout{0};  ///< Zero: the bus's.

  bool operator==(const LiveMeterConfig&) const = default;
};

[[nodiscard]] BusConfig read_bus(TomlReader& table, const std::string& name);

/// Asks for the keys of a live meter; problems are recorded at the table.
[[nodiscard]] LiveMeterConfig read_live_meter(TomlReader& table, RegisterMaps& maps);

/// The same of a weather sensor that is polled.
[[nodiscard]] LiveMeterConfig read_live_sensor(TomlReader& table, RegisterMaps& maps);

/// Bus time that a poll of the meter takes if all goes well, for the budget that `recald check`
/// shows: line time of requests and replies, 3.5 silent characters each, 60 ms until the device
/// answers on a serial line and 20 ms on TCP.
[[nodiscard]] std::chrono::milliseconds poll_time(const BusConfig& bus,
                                                  const LiveMeterConfig& meter);

}  // namespace recald::daemon
