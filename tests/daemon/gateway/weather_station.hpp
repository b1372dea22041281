/// A weather station on a bus whose weather is known at any instant.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "core/weather/weather_series.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon::testing {

/// Its registers, tenths in i16, and no value where they hold 0x8000.
inline constexpr const char* kStationMap = R"(
source = "the test"
base = 0
weather = ["dry_bulb_C", "rel_humidity_pct", "wind_speed_m_s", "wind_dir_deg", "ghi_W_m2"]
register.dry_bulb_C = { at = 0, type = "i16", scale = 0.1, unit = "degC", absent = "0x8000" }
register.rel_humidity_pct = { at = 1, type = "i16", scale = 0.1, unit = "%", absent = "0x8000" }
register.wind_speed_m_s = { at = 2, type = "i16", scale = 0.1, unit = "m/s", absent = "0x8000" }
register.wind_dir_deg = { at = 3, type = "i16", scale = 0.1, unit = "deg", absent = "0x8000" }
register.ghi_W_m2 = { at = 4, type = "i16", scale = 0.1, unit = "W/m2", absent = "0x8000" }
)";

/// Unit 3 of the rig's bus. @param more  Of its table.
inline std::string station(const std::string& more = "") {
  return R"(
[[meter]]
id = "roof"
role = "weather"
source = "modbus"
bus = "plant"
unit = 3
map = "station.toml"
)" + more;
}

inline modbus::Words station_registers(const weather::WeatherHour& now) {
  const auto word = [](double value) {
    if (std::isnan(value)) return std::uint16_t{0x8000};
    return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(10.0 * value)));
  };
  return {word(now.dry_bulb_C), word(now.rel_humidity_pct), word(now.wind_speed_m_s),
          word(now.wind_dir_deg), word(now.ghi_W_m2)};
}

/// A day like any other, `hours` after midnight: 10 ± 8 °C, sun by day, wind that turns through
/// north.
inline weather::WeatherHour usual_weather(double hours) {
  const double angle = hours / 24.0 * 6.283185307;
  weather::WeatherHour now;
  now.dry_bulb_C = 10.0 - 8.0 * std::cos(angle) + 0.5 * std::sin(hours);
  now.rel_humidity_pct = 70.0 + 20.0 * std::cos(angle);
  now.wind_speed_m_s = 3.0 + std::sin(angle);
  now.wind_dir_deg = std::fmod(360.0 + 30.0 * std::sin(angle), 360.0);
  now.ghi_W_m2 = std::max(0.0, -800.0 * std::cos(angle));
  return now;
}

}  // namespace recald::daemon::testing
