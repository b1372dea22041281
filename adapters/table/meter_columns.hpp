/// Which columns of an export are no meters: what their headers and their cells say.
#pragma once

#include <string>
#include <string_view>

#include "adapters/table/cells/column_kinds.hpp"

namespace recald::table {

/// Why a column of numbers is no meter's: "money", "an identifier"; empty: it may be one.
/// @param below  Its cell in a row of units below the header, if there is one.
[[nodiscard]] std::string_view why_no_meter(std::string_view header, std::string_view below,
                                            const ColumnKinds& kinds);

/// Whether all cells are units, one of them at least of a meter.
[[nodiscard]] bool is_column_of_units(std::string_view header, const ColumnKinds& kinds);

/// Whether all cells are dates or times of day.
[[nodiscard]] bool is_column_of_times(const ColumnKinds& kinds);

}  // namespace recald::table
