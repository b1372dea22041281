/// From energy booked between register samples to intervals on the grid.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/metering/counter.hpp"
#include "core/metering/reading.hpp"

namespace recald::metering {

/// How a load usually runs: its mean power in the interval that starts then, >= 0, kW. Energy known
/// only as a sum is spread by it; without one, or where it is nowhere positive, evenly.
using LoadShape = std::function<double(Instant start)>;

struct BookingRules {
  std::chrono::seconds interval{900};
  /// Samples further apart than this say nothing about the register between them: intervals that
  /// they cut are estimates, `scaled` to the difference. Usually two poll periods.
  std::chrono::seconds sample_gap_max{900};
};

struct BookedInterval {
  Reading reading;
  bool supersedes;  ///< Takes the place of what was booked before, whatever its validity.
};

/// What is known of intervals that are not complete yet. A plain value that must survive a restart
/// together with its counter's state: the two describe the same samples.
struct IntervalBook {
  std::vector<CounterBooking> pieces;  ///< In order of time, each within one interval.
  std::optional<Instant> next;         ///< Start of the first interval not handed out.
};

/// Enters what one sample settled and hands out the intervals that it completes, in order of time.
///
/// An interval is `ok` where its energy is measured: samples on both boundaries, or close enough to
/// interpolate between them. A hole in the middle of an interval does no harm then. It is `scaled`
/// where a boundary lies in a hole: the counter knows the sum over the hole, the shape says how it
/// was spread. The sum over all intervals and the open rest is what was booked, to the last digit
/// that rounding leaves, so monthly energy is as good as measured through any silence.
/// An interval is missing where the counter could not be believed.
///
/// @param step  of this book's counter, as `advance` gave it.
[[nodiscard]] std::vector<BookedInterval> book_intervals(IntervalBook& book, std::uint32_t meter,
                                                         const CounterStep& step,
                                                         const BookingRules& rules,
                                                         const LoadShape& shape = {});

/// A recorded register as readings, one for each interval that starts within [first, last) sample.
/// What the register rose by between samples further apart than an interval is spread as the load
/// ran at the same time on the fourteen days before and after.
/// @param samples  in time order, off-grid times allowed. @pre interval divides a day.
[[nodiscard]] std::vector<Reading> readings_from_register(std::uint32_t meter,
                                                          std::span<const RegisterSample> samples,
                                                          std::chrono::seconds interval,
                                                          const CounterSettings& settings);

}  // namespace recald::metering
