/// What a weather sensor measures, in which unit, and what of it can be.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "core/weather/weather_series.hpp"

namespace recald::weather {

struct SensorQuantity {
  std::string_view name;  ///< Of its column in `WeatherHour`: "dry_bulb_C".
  std::string_view unit;  ///< "degC": no other quantity has it.
  double WeatherHour::*member;
  double min;  ///< In `unit`; what lies outside cannot have been measured on the ground.
  double max;
};

/// In order of `kWeatherVariables`.
inline constexpr std::array<SensorQuantity, 5> kSensorQuantities{{
    {"dry_bulb_C", "degC", &WeatherHour::dry_bulb_C, -60.0, 60.0},
    {"rel_humidity_pct", "%", &WeatherHour::rel_humidity_pct, 0.0, 105.0},
    {"wind_speed_m_s", "m/s", &WeatherHour::wind_speed_m_s, 0.0, 75.0},
    {"wind_dir_deg", "deg", &WeatherHour::wind_dir_deg, 0.0, 360.0},
    {"ghi_W_m2", "W/m2", &WeatherHour::ghi_W_m2, -10.0, 1600.0},
}};

/// A dry bulb that shows the same value to the last digit for longer than this, and this often in a
/// row, is a frozen one. Of hourly values some are often equal: on foggy days, or in whole degrees.
inline constexpr std::chrono::hours kSameDryBulbMax{6};
inline constexpr int kSameDryBulbValuesMin = 24;
/// @param length  Of a run of equal values, one an interval.
[[nodiscard]] constexpr bool is_frozen(std::chrono::seconds length, std::chrono::seconds interval) {
  return length > kSameDryBulbMax && length / interval >= kSameDryBulbValuesMin;
}

/// Null where no quantity has that name, or that unit.
[[nodiscard]] const SensorQuantity* find_quantity(std::string_view name);
[[nodiscard]] const SensorQuantity* find_quantity_of_unit(std::string_view unit);

[[nodiscard]] inline bool is_dry_bulb(const SensorQuantity& quantity) {
  return quantity.member == &WeatherHour::dry_bulb_C;
}
[[nodiscard]] inline bool is_wind_direction(const SensorQuantity& quantity) {
  return quantity.member == &WeatherHour::wind_dir_deg;
}

/// NaN is not.
[[nodiscard]] inline bool is_plausible(const SensorQuantity& quantity, double value) {
  return quantity.min <= value && value <= quantity.max;
}

/// "850 degC cannot be dry_bulb_C, which lies between -60 and 60".
[[nodiscard]] std::string why_not_plausible(const SensorQuantity& quantity, double value);

/// "degC (dry_bulb_C), % (rel_humidity_pct), …", for messages.
[[nodiscard]] std::string quantity_units();

/// Whether two means are the same to the last digit that a sensor shows: sums round.
[[nodiscard]] bool is_same_value(double a, double b);

/// One interval's mean as a sensor gave it.
struct SensorValue {
  Instant start;
  double value;  ///< In the quantity's unit; NaN: none that is believed.
};

/// Takes the values away that a frozen dry bulb has shown: all of each run that `is_frozen`. A hole
/// ends a run.
/// @param values  In order of time.
/// @return how many were taken away.
std::size_t forget_frozen(std::span<SensorValue> values, std::chrono::seconds interval);

}  // namespace recald::weather
