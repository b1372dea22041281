#include "daemon/site/config/weather_sensors.hpp"

#include <algorithm>
#include <utility>

namespace recald::daemon {

std::vector<const weather::SensorQuantity*> quantities_of(const MeterConfig& sensor) {
  std::vector<const weather::SensorQuantity*> quantities;
  for (const weather::SensorQuantity& quantity : weather::kSensorQuantities) {
    const auto is_it = [&](const std::string& name) { return name == quantity.name; };
    if (!sensor.live || std::ranges::any_of(sensor.live->map.weather, is_it)) {
      quantities.push_back(&quantity);
    }
  }
  return quantities;
}

std::vector<WeatherChannel> channels_of(const MeterConfig& sensor) {
  std::vector<WeatherChannel> channels;
  for (const auto* quantity : quantities_of(sensor))
    channels.push_back({sensor.meter.id, quantity});
  return channels;
}

metering::Meter stored_meter(const MeterConfig& sensor, const WeatherChannel& channel) {
  return {.id = channel.id(), .interval = sensor.meter.interval};
}

std::optional<WeatherChannel> find_channel(const SiteConfig& site, std::string_view id) {
  const std::size_t dot = id.find('.');
  if (dot == std::string_view::npos) return {};
  const MeterConfig* const sensor = site.find_sensor(id.substr(0, dot));
  if (sensor == nullptr) return {};
  for (WeatherChannel& channel : channels_of(*sensor)) {
    if (channel.quantity->name == id.substr(dot + 1)) return std::move(channel);
  }
  return {};
}

std::string sensor_words(std::span<const MeterConfig> sensors) {
  std::string words = sensors.size() == 1 ? "sensor " : "sensors ";
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (i > 0) words += i + 1 == sensors.size() ? " and " : ", ";
    words += "'" + sensors[i].meter.id + "'";
  }
  return words;
}

}  // namespace recald::daemon
