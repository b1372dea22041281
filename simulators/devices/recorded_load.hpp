/// One meter of a readings file, `timestamp,meter,value,unit` as `recald-sim building` writes it,
/// as a load.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.hpp"
#include "simulators/devices/load_shape.hpp"

namespace recald::simulators {

/// Stamps are UTC with a Z and name the start of an interval; its length is the shortest distance
/// between two of them. A blank value, and an interval that is absent, go on with the one before.
///
/// @return the load;
///         not_found      no such file, or no reading of that meter in it;
///         malformed      a line that is no reading, with its number;
///         invalid_value  a unit that is no power and no energy;
///         not_enough_data  fewer than two readings, so that no length can be seen.
[[nodiscard]] Result<LoadShape> read_recorded_load(const std::filesystem::path& file,
                                                   std::string_view meter);

}  // namespace recald::simulators
