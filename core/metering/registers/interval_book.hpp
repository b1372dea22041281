/// Forms intervals on the grid from the energy booked between register samples.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/metering/reading.hpp"
#include "core/metering/registers/counter.hpp"

namespace recald::metering {

/// The usual load: its mean power in the interval that starts then, >= 0, kW. It distributes energy
/// of which only the sum is known. Without a shape, or if it is nowhere positive, the energy is
/// distributed evenly.
using LoadShape = std::function<double(Instant start)>;

struct BookingRules {
  std::chrono::seconds interval{900};
  /// Samples further apart say nothing about the register between them: intervals with a boundary
  /// in between are estimates, `scaled` to the difference. Usually two poll periods.
  std::chrono::seconds sample_gap_max{900};
};

struct BookedInterval {
  Reading reading;
  bool supersedes;  ///< Replaces what was booked before, whatever its validity.
};

/// The state of intervals that are not complete yet. A plain value that must survive a restart
/// together with its counter's state: the two describe the same samples.
struct IntervalBook {
  std::vector<CounterBooking> pieces;  ///< In order of time, each within one interval.
  std::optional<Instant> next;         ///< Start of the first interval not yet completed.
};

/// Enters the energy that one sample decides, and returns the intervals that it completes,
/// in order of time.
///
/// An interval is `ok` if its energy is measured: there are samples on both boundaries, or close
/// enough to interpolate between them. A hole in the middle of the interval then does no harm. It
/// is `scaled` if a boundary lies in a hole: the counter gives the sum over the hole, the shape its
/// distribution. The sum over all intervals and the open rest equals the booked energy up to
/// rounding, so monthly energy is as good as measured through any silence. An interval is missing
/// if the counter could not be trusted, and suspect if that shows only afterwards.
///
/// @param step  From `advance` for this book's counter.
[[nodiscard]] std::vector<BookedInterval> book_intervals(IntervalBook& book, std::uint32_t meter,
                                                         const CounterStep& step,
                                                         const BookingRules& rules,
                                                         const LoadShape& shape = {});

/// What a recorded register did besides counting.
struct RegisterNote {
  CounterEvent event;
  RegisterSample before;  ///< The last sample on its old line.
  RegisterSample after;   ///< The first one on the new line.
};

/// Readings from a recorded register, one for each interval that starts within [first, last)
/// sample. If samples are further apart than an interval, the rise between them is distributed like
/// the load at the same time on the fourteen days before and after.
/// @param samples  In time order, off-grid times allowed. @pre interval divides a day.
/// @param resets   Of the register's `settings.resets`.
/// @param notes    Receives resets, jumps and the like, if not null; of many the first hundred.
[[nodiscard]] std::vector<Reading> readings_from_register(
    std::uint32_t meter, std::span<const RegisterSample> samples, std::chrono::seconds interval,
    const CounterSettings& settings, const ResetTimes& resets = {},
    std::vector<RegisterNote>* notes = nullptr);

}  // namespace recald::metering
