/// Whether recorded temperatures are values at a stamp or means of an interval.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/weather/weather_series.hpp"

namespace recald::weather {

/// Of temperature, humidity, wind and pressure. Irradiance is the mean of its interval anyway.
enum class RecordedValues : std::uint8_t { mean, instant };

enum class KnownBy : std::uint8_t {
  declared,  ///< The site file says so.
  inferred,  ///< The record shows it.
  usage,     ///< As such files usually are.
};

struct ValuesTaken {
  RecordedValues values = RecordedValues::mean;
  KnownBy known_by = KnownBy::usage;
  bool operator==(const ValuesTaken&) const = default;
};

/// "instant (inferred)"
[[nodiscard]] std::string to_string(const ValuesTaken& taken);

/// What the sun shows. Where clouds come and go the air follows the sun with a delay of a quarter
/// of an hour to some hours. The record's irradiance says how such air would have warmed and
/// cooled, from instant to instant or from mean to mean; the changes of the recorded temperature,
/// with daily courses taken out of both, are compared with each, at the delay that suits it best.
/// @param records  In order of time.
/// @param instant  Where an instant would stand in its record. @pre not over_the_record
/// @return none where the record cannot tell: neither leaves 2 % less of the variance unexplained
///         than the other; no irradiance; less than a month of daylight.
[[nodiscard]] std::optional<RecordedValues> values_by_the_sun(
    std::span<const WeatherRecord> records, std::chrono::seconds step, ValuesStand instant);

}  // namespace recald::weather
