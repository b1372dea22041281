/// The numbers that the page's script draws, as JSON safe to stand inside an HTML page.
#pragma once

#include <string>

#include "adapters/report/report_data.hpp"

namespace recald::report {

/// @return compact JSON: absent and non-finite numbers are null, numbers have six significant
///         digits (load four), and no "<" occurs, so no text can close the surrounding script tag.
[[nodiscard]] std::string figure_json(const ReportData& data);

}  // namespace recald::report
