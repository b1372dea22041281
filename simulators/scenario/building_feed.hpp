/// `recald-sim building`: one simulated building, written as the files that a gateway would record.
#pragma once

#include <cstdint>
#include <filesystem>

#include "simulators/scenario/scenario.hpp"

namespace recald::simulators {

struct BuildingFeedOptions {
  std::filesystem::path out;  ///< Created if absent; files of the same name are replaced.
  Scenario scenario;
  std::uint64_t seed = 1;
  /// Also writes what the building would show without its hidden effects (twin_readings.csv), and
  /// what the effects add to each meter, free of noise (footprint.csv).
  bool twin = false;
};

/// Writes readings.csv, weather.csv, site.toml and truth.json. Same options, same bytes.
/// @return the number of 15-minute intervals, or
///         io_failed  the folder cannot be created or a file cannot be written;
///         not_found  the system has no zone files.
[[nodiscard]] Result<std::size_t> write_building_feed(const BuildingFeedOptions& options);

}  // namespace recald::simulators
