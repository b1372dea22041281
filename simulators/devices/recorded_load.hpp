/// The load of one meter from a readings file, `timestamp,meter,value,unit` as written by
/// `recald-sim building`.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.hpp"
#include "simulators/devices/load_shape.hpp"

namespace recald::simulators {

/// Stamps are UTC with a Z and mark the start of an interval; its length is the shortest distance
/// between two of them. A blank or missing interval repeats the one before.
///
/// @return the load;
///         not_found      no such file, or no reading of that meter in it;
///         malformed      a line that is not a reading, with its number;
///         invalid_value  a unit that is neither power nor energy;
///         not_enough_data  fewer than two readings, so that the length is unknown.
[[nodiscard]] Result<LoadShape> read_recorded_load(const std::filesystem::path& file,
                                                   std::string_view meter);

}  // namespace recald::simulators
