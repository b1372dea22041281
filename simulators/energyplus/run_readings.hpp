/// What meters would have recorded of a building that EnergyPlus simulated.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace recald::simulators::energyplus {

struct RunMeter {
  std::string id;        ///< Of the meter: "chilled_water".
  std::string reported;  ///< By EnergyPlus: "DistrictCooling:Facility".
};

/// The meters that the models of this folder have.
[[nodiscard]] std::vector<RunMeter> district_meters();

struct ReadingOptions {
  std::vector<std::filesystem::path> runs;  ///< `eplusout.sql`, one a calendar year, ascending.
  std::vector<RunMeter> meters;
  std::chrono::seconds standard_offset;  ///< Of the zone from UTC; the runs' stamps are in it.
  std::uint64_t seed = 1;
  double noise_share = 0.02;  ///< One standard deviation of a reading.
  double lost_share = 0.01;   ///< Expected, in gaps of a quarter of an hour to a day.
};

/// `timestamp,meter,value,unit`: kWh a time step, start stamps in UTC, ordered by time, then meter.
/// @return not_found: a run does not report a meter at its time steps; io_failed: no such file, or
///         none of SQLite.
[[nodiscard]] Result<std::string> readings_csv(const ReadingOptions& options);

}  // namespace recald::simulators::energyplus
