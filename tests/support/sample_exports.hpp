/// Exports as portals and spreadsheets write them, made from a truth that is known by month.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::testing {

/// One meter's use in each interval, and what it was in each local month.
struct ExportTruth {
  struct Interval {
    metering::Instant start;
    double value;  ///< As written, in the export's unit.
  };
  std::vector<Interval> intervals;
  std::map<std::string, double> month_sums;  ///< By "2024-03", in the export's unit.
};

struct ExportSpan {
  metering::Day first;  ///< Local days, both included.
  metering::Day last;
  std::chrono::minutes step;
};

/// A load with days, nights, weekends and noise, written with three decimals. The same seed, the
/// same load.
[[nodiscard]] ExportTruth made_up_use(const metering::LocalCalendar& calendar,
                                      const ExportSpan& span, unsigned seed, double mean);

/// A stamp of the zone's clock by the letters of `pattern`: "%d.%m.%Y %H:%M" as strftime.
[[nodiscard]] std::string clock_text(const metering::LocalCalendar& calendar, metering::Instant t,
                                     const std::string& pattern);

/// 1234.5 as "1234,500".
[[nodiscard]] std::string with_comma(double value);
[[nodiscard]] std::string with_point(double value);

/// A workbook of one sheet. Cells of the first column below the header are days of a spreadsheet
/// with a date format, the others numbers; headers are texts.
struct WorkbookRow {
  double day;  ///< As a spreadsheet counts it.
  std::vector<double> values;
};
void write_workbook(const std::filesystem::path& file, const std::vector<std::string>& header,
                    const std::vector<WorkbookRow>& rows);

/// A time on the zone's clock as a spreadsheet counts days.
[[nodiscard]] double spreadsheet_day(const metering::LocalCalendar& calendar, metering::Instant t);

}  // namespace recald::testing
