/// A meter that gives usable readings for much less of the time than it used to.
#pragma once

#include <optional>
#include <span>

#include "core/metering/monthly_figure.hpp"

namespace recald::metering {

/// It hangs, or the way to it does. Its months are still filled and their level may hardly show it.
struct LostReadings {
  Month since;          ///< First month that lost as much.
  Month seen;           ///< The month after it, which settled it.
  double share_before;  ///< Of the time with usable readings …
  double share_since;   ///< … and of all months from `since` on.
  bool stands_still;    ///< Readings came that did not change.
};

/// Two months in a row, each without more than 15 % of their readings and three times what the
/// worst of the first months was without.
/// @param figures  Ascending. @param first_months  Of them, what the meter used to be.
[[nodiscard]] std::optional<LostReadings> find_lost_readings(std::span<const MonthlyFigure> figures,
                                                             std::size_t first_months);

}  // namespace recald::metering
