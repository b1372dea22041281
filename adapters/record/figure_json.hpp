/// A month's figure as the record keeps it.
#pragma once

#include <string>
#include <string_view>

#include "core/metering/monthly_figure.hpp"
#include "core/result.hpp"

namespace recald::record {

/// Values that are NaN are null; parsing gives the same figure, to the last bit.
[[nodiscard]] std::string figure_json(const metering::MonthlyFigure& figure);

/// @return malformed: somebody else wrote it.
[[nodiscard]] Result<metering::MonthlyFigure> parse_figure(std::string_view json);

}  // namespace recald::record
