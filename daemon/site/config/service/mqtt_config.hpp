/// What is published to an MQTT broker, and what of a [[meter]] belongs to it, as a site file says
/// it.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "adapters/modbus/register_map.hpp"
#include "core/metering/units.hpp"
#include "daemon/site/config/service/broker_config.hpp"

namespace recald::daemon {

/// [mqtt]
struct MqttConfig {
  BrokerConfig broker;
  bool publishes = true;
  std::string topic = "recald";  ///< Results are under "recald/SITE/".
  std::string home_assistant;    ///< Prefix of its discovery topics; empty: no discovery.

  bool operator==(const MqttConfig&) const = default;
};

/// Where a number is in the messages of a broker.
struct MqttValue {
  std::string topic;
  std::string pointer;       ///< JSON pointer (RFC 6901); empty: the payload is the number.
  std::string time_pointer;  ///< To when it was measured; empty: when the message came.
  double factor = 1.0;       ///< To kWh or kW.

  bool operator==(const MqttValue&) const = default;
};

/// What a [[meter]] with source = "mqtt" says.
struct MqttMeterConfig {
  std::optional<MqttValue> energy;  ///< A counter.
  std::optional<MqttValue> power;
  /// Both as registers, so that a counter in messages is treated as one that is polled: `energy`
  /// is a 64-bit float at address 0, `power` one at 4.
  modbus::RegisterMap map;
  std::chrono::seconds every{60};  ///< Longest usual time between two messages.

  bool operator==(const MqttMeterConfig&) const = default;
};

[[nodiscard]] MqttConfig read_mqtt(TomlReader& table, const std::string& site_id,
                                   const std::filesystem::path& site_file);

/// Asks for the keys of such a meter; problems are recorded at the table.
[[nodiscard]] MqttMeterConfig read_mqtt_meter(TomlReader& table, metering::Utility utility,
                                              const metering::UnitFactors& factors);

/// Of a meter whose counter is sent to the API instead of a broker.
[[nodiscard]] MqttMeterConfig sent_counter(std::chrono::seconds interval);

}  // namespace recald::daemon
