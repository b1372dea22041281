/// A report made of invented numbers: three meters, three years, every kind of defect once.
#pragma once

#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

/// Invented from end to end and titled so; the same bytes every time.
[[nodiscard]] ReportData sample_report();

/// The awkward one: five months of readings from the end of a year, no model, one meter that
/// recorded nothing at all.
[[nodiscard]] ReportData readings_only_report();

/// A design of experiments: the same figures with months that have numbers and no calendar, a peak
/// among the outputs, one output without a unit, and nothing of the readings.
[[nodiscard]] ReportData design_report();

}  // namespace recald::views
