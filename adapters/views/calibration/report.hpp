/// The report: one self-contained HTML page that loads nothing from the network.
#pragma once

#include <string>

#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

/// Renders the page: words and tables as HTML, figures drawn by the embedded script.
///
/// Every text of `data` is escaped; numbers that are NaN or absent appear as a dash. The same data
/// give the same bytes. The caller writes the file.
///
/// @pre each load grid holds whole days and as many statuses as values.
/// @note Size: about 0.7 MB of script and style, plus 30 bytes per hour and meter of load.
[[nodiscard]] std::string render_report(const ReportData& data);

}  // namespace recald::views
