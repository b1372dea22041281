/// `recald-sim building`: one invented building, written as the files a gateway would record.
#pragma once

#include <cstdint>
#include <filesystem>

#include "simulators/feed/recording.hpp"

namespace recald::simulators {

struct BuildingFeedOptions {
  std::filesystem::path out;  ///< Created if absent; files of the same name are replaced.
  Period period;
  std::uint64_t seed = 1;
  bool with_faults = true;
};

/// Writes readings.csv, weather.csv, site.toml and truth.json. Same options, same bytes.
/// @return the number of 15-minute intervals, or
///         io_failed  the folder cannot be made or a file cannot be written;
///         not_found  the system has no zone files.
[[nodiscard]] Result<std::size_t> write_building_feed(const BuildingFeedOptions& options);

}  // namespace recald::simulators
