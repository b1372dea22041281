/// A meter that gives usable readings for much less of the time than before.
#pragma once

#include <optional>
#include <span>

#include "core/metering/months/monthly_figure.hpp"

namespace recald::metering {

/// The meter hangs, or its connection does. Its months are still filled, and their level
/// may hardly change.
struct LostReadings {
  Month since;          ///< First month with such a loss.
  Month seen;           ///< The month after it, which confirmed it.
  double share_before;  ///< Of the time with usable readings …
  double share_since;   ///< … and of all months from `since` on.
  bool stands_still;    ///< Readings arrived but did not change.
};

/// Finds two months in a row that each lack more than 15 % of their readings, and three times as
/// many as the worst of the first months.
/// @param figures  Ascending. @param first_months  Number of figures that show how the
///                 meter used to be.
[[nodiscard]] std::optional<LostReadings> find_lost_readings(std::span<const MonthlyFigure> figures,
                                                             std::size_t first_months);

}  // namespace recald::metering
