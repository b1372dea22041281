/// The numbers that the page's script draws, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

[[nodiscard]] nlohmann::json report_json(const ReportData& data);

/// The data as compact JSON, safe inside a script tag. Numbers carry six significant digits, loads
/// four; absent ones are null.
[[nodiscard]] std::string figure_json(const ReportData& data);

}  // namespace recald::views
