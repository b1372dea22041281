/// Weather sensors among the meters of a site: what each measures, and how the store calls it.
///
/// The store keeps a sensor like a meter for each of its quantities, of which an interval's "mean
/// power" is the mean in the quantity's own unit.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/weather/sensor_quantities.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// One quantity of one weather sensor.
struct WeatherChannel {
  std::string sensor;                       ///< Its id.
  const weather::SensorQuantity* quantity;  ///< Of `kSensorQuantities`.

  /// "roof.dry_bulb_C"; ids of meters have no dot.
  [[nodiscard]] std::string id() const { return sensor + "." + std::string{quantity->name}; }
};

/// What the registers of its map give, or, of a sensor that sends, all that there is; in order of
/// `kSensorQuantities`. @pre a weather sensor
[[nodiscard]] std::vector<const weather::SensorQuantity*> quantities_of(const MeterConfig& sensor);

/// The same, as the store keeps them.
[[nodiscard]] std::vector<WeatherChannel> channels_of(const MeterConfig& sensor);

/// As what the store knows a channel of this sensor.
[[nodiscard]] metering::Meter stored_meter(const MeterConfig& sensor,
                                           const WeatherChannel& channel);

/// The channel that an id such as "roof.dry_bulb_C" names; nothing for what no sensor of the site
/// measures.
[[nodiscard]] std::optional<WeatherChannel> find_channel(const SiteConfig& site,
                                                         std::string_view id);

/// "sensor 'roof'", "sensors 'roof' and 'sun'". @pre there is one
[[nodiscard]] std::string sensor_words(std::span<const MeterConfig> sensors);

}  // namespace recald::daemon
