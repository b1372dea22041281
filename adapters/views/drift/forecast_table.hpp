/// The months of a forecast as a table, for who cannot see its figure.
#pragma once

#include <string_view>

#include "adapters/views/drift/drift_page.hpp"
#include "adapters/views/frame/html.hpp"

namespace recald::views {

/// @param what  Stands in the caption: "forecast", "expected".
[[nodiscard]] Table forecast_table(const ForecastSeries& series, std::string_view what);

}  // namespace recald::views
