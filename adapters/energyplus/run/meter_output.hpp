/// Meters of a finished run, from `eplusout.sql`.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/metering/reading.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

/// One meter's energy at the model's own time step.
struct MeterOutput {
  std::string name;  ///< "Electricity:Facility"
  std::vector<metering::Instant> starts;
  std::vector<double> energy_kWh;
};

/// @param names       As EnergyPlus calls them; letter case does not matter.
/// @param utc_offset  Of the model's standard time, which its stamps are in.
/// @return one per name, in their order, of the days of weather only (no design days, no warm-up);
///         not_found: the run does not report such a meter (the nearest is named); malformed,
///         io_failed: no such file.
[[nodiscard]] Result<std::vector<MeterOutput>> read_meters(const std::filesystem::path& file,
                                                           const std::vector<std::string>& names,
                                                           std::chrono::seconds utc_offset);

}  // namespace recald::energyplus
