/// Values that cannot be, and which of the usual mistakes in a register map would explain them.
///
/// People get wrong, in this order: the order of words, the base of addresses, the sign, the scale.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "adapters/modbus/register_map.hpp"

namespace recald::daemon {

/// What is known of the load, so that a value can be judged.
struct LoadLimits {
  double rated_kW;
  double multiplier = 1.0;  ///< Of a current transformer; values here are before it.
};

/// One read as it came.
struct ReadWords {
  int address;  ///< Of the first word, as the map counts.
  std::span<const std::uint16_t> words;
};

/// A sentence where the field's value cannot be: a power above 1.2 times the rating, an energy of
/// more than forty years at it or below zero, a float that is next to nothing, no number at all. It
/// names each other reading of the same registers, or of those one address away, that could be.
/// Empty: nothing to say. Fields that are neither a power nor an energy are not judged.
///
/// @pre the field lies within the read.
[[nodiscard]] std::string doubt_about(const modbus::RegisterField& field, const ReadWords& read,
                                      double power_of_ten, const LoadLimits& limits);

/// A sentence where one step of a counter is more than 1 % of what the load takes in an interval;
/// else empty.
/// @param load_kW  Usual load.
[[nodiscard]] std::string coarseness_of(const modbus::RegisterField& field, double resolution,
                                        double load_kW, std::chrono::seconds interval,
                                        const LoadLimits& limits);

}  // namespace recald::daemon
