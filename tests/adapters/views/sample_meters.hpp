/// Invented data for the page of meters alone.
#pragma once

#include "adapters/views/meters/meters_page.hpp"

namespace recald::views {

/// Three meters of three years; the weather explains two of them, the third has none.
[[nodiscard]] MetersData sample_meters();

/// One meter of five months, without weather, and another that measured nothing.
[[nodiscard]] MetersData young_meters();

}  // namespace recald::views
