/// Revenue meters: gain error, noise, resolution, and faults on the way to the file.
#pragma once

#include <string_view>
#include <vector>

#include "simulators/feed/faults.hpp"
#include "simulators/feed/recording.hpp"

namespace recald::simulators {

/// The nameplate of a meter.
struct MeterPlate {
  Utility utility;
  std::string_view id;
  std::string_view kind;  ///< The utility, as in site files.
  std::string_view unit;
  double unit_kW;     ///< Mean power over an interval with a reading of 1.
  double resolution;  ///< In its unit.
  int decimals;
  double noise_share;       ///< One standard deviation of the reading.
  double noise_floor;       ///< In addition, in its unit.
  double gain_error_share;  ///< One standard deviation of the constant gain error.
  bool counts;              ///< Carries the unread remainder over, like a pulse counter.
  double spike_min;         ///< In its unit; beyond 1.2 times the rating in the site file.
  double spike_max;
  double rated_kW;    ///< `rated_kW` in the site file.
  bool in_steam_pit;  ///< Has more faults.
};

/// The building's meters in the order of files: chilled water (except with packaged units),
/// electricity, and heat (steam, hot water or gas; not with a heat pump).
[[nodiscard]] std::vector<MeterPlate> plates_of(const Drawings& drawings);

/// The meter of the building next door, which is in the file by mistake.
[[nodiscard]] MeterPlate neighbour_plate();

/// Faults of meters besides noise and resolution.
enum class MeterCare {
  perfect,  ///< None.
  usual,    ///< One or two per cent lost; for a steam meter a fifth.
  gaps,     ///< About five per cent lost in gaps of hours to days, and nothing else.
};

enum class CellState : std::uint8_t { value, blank, absent };

/// One row of the file, or its absence.
struct Cell {
  double value;
  CellState state;
};

struct MeterFeed {
  MeterPlate plate;
  double gain;  ///< The meter's constant factor, near 1.
  std::vector<Fault> faults;
  std::vector<Cell> cells;
};

/// @param effects  Those in the meters act between display and file.
[[nodiscard]] MeterFeed read_meter(const Recording& recording, const MeterPlate& plate,
                                   MeterCare care, std::uint64_t seed, const HiddenEffects& effects,
                                   const metering::LocalCalendar& calendar);

struct WeatherCell {
  WeatherMean reading;
  bool absent;
  bool humidity_blank;  ///< Only the humidity probe has failed.
};

struct WeatherFeed {
  double dry_bulb_bias_K;
  double humidity_bias;  ///< 0…1
  double pyranometer_gain;
  std::vector<Fault> faults;
  std::vector<WeatherCell> cells;
};

[[nodiscard]] WeatherFeed read_weather_station(const Recording& recording, MeterCare care,
                                               std::uint64_t seed);

}  // namespace recald::simulators
