/// Which of two readings of one interval holds.
#pragma once

#include <cstdint>
#include <optional>

#include "core/metering/reading.hpp"

namespace recald::metering {

/// What becomes of a reading whose interval may be known already.
enum class Placement : std::uint8_t {
  first,      ///< Nothing was known: it is taken.
  replaces,   ///< Better than what was known, or puts it right: it is taken, as a new revision.
  duplicate,  ///< Says what is known: nothing changes. Everything may arrive twice.
  weaker,     ///< Known better already: it is left.
  conflict,   ///< As good, with another value: the first stays, and people are told.
};

/// ok > scaled > filled > suspect > missing, and never the reverse: an estimate cannot take the
/// place of a measurement. Only what the meter's own counter puts right replaces anything.
///
/// @param known       what stands for the interval, if anything.
/// @param supersedes  `arriving` puts right what was booked before (BookedInterval).
[[nodiscard]] Placement place(const std::optional<Reading>& known, const Reading& arriving,
                              bool supersedes = false);

}  // namespace recald::metering
