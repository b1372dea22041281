/// Which units of a bus answer, and what they say of themselves. Reads only, and slowly.
#pragma once

#include "adapters/modbus/device_identification.hpp"
#include "adapters/modbus/sunspec.hpp"
#include "daemon/commands/meters/bus_access.hpp"

namespace recald::daemon {

struct UnitRange {
  int first;
  int last;
};

/// "1-247", "17".
/// @return invalid_value  anything else, 0, more than 247, or a range that goes backwards.
[[nodiscard]] Result<UnitRange> parse_units(std::string_view text);

/// One unit that answers.
struct FoundUnit {
  int unit;
  /// How functions 3 and 4 were answered at address 0: "yes", or the exception in words.
  std::string holding_registers;
  std::string input_registers;
  std::vector<modbus::SunSpecModel> models;
  std::optional<modbus::DeviceIdentity> identity;
};

struct BusScan {
  std::vector<FoundUnit> found;
  std::optional<std::string> ended_by;  ///< Why it did not come to its end.
};

/// Asks each unit for one register with functions 3 and 4; those that answer are asked for a
/// SunSpec chain and for their identification as well. A unit that is silent costs two time-outs.
/// A bus that cannot be reached ends the scan.
/// @param tell  Called before each unit, with how many were found so far.
[[nodiscard]] BusScan scan_bus(const BusConfig& bus, const UnitRange& units,
                               const std::function<void(int unit, std::size_t found)>& tell);

}  // namespace recald::daemon
