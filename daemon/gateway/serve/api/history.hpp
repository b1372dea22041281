/// A meter's intervals summed up to as many points as a chart has room for.
#pragma once

#include <vector>

#include "adapters/ports/interval_store.hpp"

namespace recald::daemon {

/// What a meter read from `start` on for the length of a point.
struct HistoryPoint {
  metering::Instant start;
  double least_kW;  ///< Of valid intervals, as the next two; NaN: there is none.
  double mean_kW;
  double most_kW;
  double valid_share;  ///< Of the intervals that there should be, 0…1.
};

struct History {
  std::chrono::seconds step;
  std::vector<HistoryPoint> points;  ///< One after the other from the span's begin; none if the
                                     ///< meter was never read in it.
};

/// The shortest of the usual steps (the interval, then an hour, six, a day, a week, four weeks,
/// years of 52 weeks) that makes at most `points_max` points.
/// @param origin  Not after the span begins; points begin whole steps after it.
/// @pre points_max > 0
[[nodiscard]] std::chrono::seconds history_step(const metering::TimeSpan& span,
                                                metering::Instant origin,
                                                std::chrono::seconds interval, int points_max);

/// @param meter  Its number in the store.
/// @param span   Cut to what the store has of the meter, by whole steps.
/// @return or the store's failure.
[[nodiscard]] Result<History> read_history(IntervalStore& store, std::uint32_t meter,
                                           std::chrono::seconds interval,
                                           const metering::TimeSpan& span, int points_max);

}  // namespace recald::daemon
