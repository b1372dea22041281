/// A calibration in the shape that the report shows.
#pragma once

#include <string>

#include "adapters/views/frame/report_data.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"

namespace recald::daemon {

/// @param generated_at  As it shall stand on the page.
[[nodiscard]] views::ReportData report_of(const SiteConfig& site,
                                          const metering::LocalCalendar& calendar,
                                          const Recording& recording, const SiteCalibration& result,
                                          const RunFacts& facts, std::string generated_at);

/// The same of a design, without what its folder cannot know: readings, hours, schedules, and how
/// much of a month was measured. Peaks are outputs like others.
[[nodiscard]] views::ReportData report_of(const FinishedDesign& done, std::string generated_at);

}  // namespace recald::daemon
