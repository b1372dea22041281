/// Decides between two readings of one interval.
#pragma once

#include <cstdint>
#include <optional>

#include "core/metering/reading.hpp"

namespace recald::metering {

/// What happens to a reading whose interval may already have one.
enum class Placement : std::uint8_t {
  first,      ///< The interval had none: it is stored.
  replaces,   ///< Better than the stored one, or a correction: it is stored as a new revision.
  duplicate,  ///< Equal to the stored one: nothing changes. Everything may arrive twice.
  weaker,     ///< Worse than the stored one: it is dropped.
  conflict,   ///< Equally good, but another value: the first stays, and an event reports it.
};

/// ok > scaled > filled > suspect > missing, and never the reverse: an estimate must not replace a
/// measurement. Only corrections from the meter's own counter replace anything.
///
/// @param known       The stored reading of the interval, if any.
/// @param supersedes  `arriving` corrects what was booked before (BookedInterval).
[[nodiscard]] Placement place(const std::optional<Reading>& known, const Reading& arriving,
                              bool supersedes = false);

}  // namespace recald::metering
