/// Revenue meters: gain error, noise, resolution, and faults on the way to the file.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "simulators/feed/faults.hpp"
#include "simulators/feed/recording.hpp"

namespace recald::simulators {

enum class MeterKind : std::size_t { chilled_water, electricity, steam };  ///< In file order.
inline constexpr std::size_t kMeters = 3;

/// What is written on the meter.
struct MeterPlate {
  std::string_view id;
  std::string_view unit;
  double unit_kW;     ///< Mean power over an interval that reads as 1.
  double resolution;  ///< In its unit.
  int decimals;
  double noise_share;       ///< One standard deviation of the reading.
  double noise_floor;       ///< Besides, in its unit.
  double gain_error_share;  ///< One standard deviation of the constant gain error.
  bool counts;              ///< Carries the unread remainder over, as pulses do.
  double spike_min;         ///< In its unit; beyond 1.2 times the rating in the site file.
  double spike_max;
  bool in_steam_pit;  ///< Suffers accordingly.
};

[[nodiscard]] const MeterPlate& plate_of(MeterKind kind);
[[nodiscard]] double power_of(const UtilityPower& power, MeterKind kind);

enum class CellState : std::uint8_t { value, blank, absent };

/// One row of the file, or its absence.
struct Cell {
  double value;
  CellState state;
};

struct MeterFeed {
  MeterKind kind;
  double gain;  ///< The meter's constant factor, near 1.
  std::vector<Fault> faults;
  std::vector<Cell> cells;
};

/// @param with_faults false leaves noise and resolution only.
[[nodiscard]] MeterFeed read_meter(const Recording& recording, MeterKind kind, std::uint64_t seed,
                                   bool with_faults);

struct WeatherCell {
  WeatherMean reading;
  bool absent;
  bool humidity_blank;  ///< The humidity probe alone is out.
};

struct WeatherFeed {
  double dry_bulb_bias_K;
  double humidity_bias;  ///< 0…1
  double pyranometer_gain;
  std::vector<Fault> faults;
  std::vector<WeatherCell> cells;
};

[[nodiscard]] WeatherFeed read_weather_station(const Recording& recording, std::uint64_t seed,
                                               bool with_faults);

}  // namespace recald::simulators
