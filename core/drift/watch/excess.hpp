/// What a change adds to a meter, against what the meter did before it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/drift/watch/daily_reference.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::drift {

/// Of a meter, in order of the days on which it was noticed.
struct NoticedChange {
  metering::Day since;  ///< Likeliest first day.
  int direction;        ///< +1 more than expected, -1 less.
};

struct Excess {
  metering::Day since;  ///< Of the first notice of the same change.
  metering::Day until;  ///< The last measured day of it.
  bool has_ended;       ///< By another change.
  double so_far_kWh;    ///< From `since` to `until`; unmeasured days in proportion.
  /// Of a year like the last 365 days; absent: fewer are known, or it has ended.
  std::optional<double> year_kWh = {};

  bool operator==(const Excess&) const = default;
};

/// A fault shows again in the season that it changes most, so notices in one direction within 400
/// days are of one change, and each has the whole of it. A reference learnt from the days before
/// the change, and from none since, says what they would have been. What a year adds is the
/// difference between that reference and one that learns from the days since: of a few days hardly
/// more than a factor of the forecast's own season, of a year that year's. A change the other way
/// is against the days since the one before, unless those were as before it: a false alarm, or a
/// fault that came and went.
/// @param days  In order of time; unmeasured ones too.
/// @return one for each notice; nothing where no day is measured before it or none since.
[[nodiscard]] std::vector<std::optional<Excess>> excesses_of(
    std::span<const WatchedDay> days, std::span<const NoticedChange> notices);

}  // namespace recald::drift
