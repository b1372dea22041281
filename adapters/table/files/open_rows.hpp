/// Opens exports of any container and layout.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "adapters/table/read_table.hpp"

namespace recald::table {

/// Opens the file with the container and the layout that its shape names, as rows of one time each.
/// @param calendar  Of the table's clock, outlives the rows; for days with a clock change in a
///                  table with a row a day. Null: all days have 24 hours.
/// @return not_found, io_failed, malformed (not a workbook, no such sheet, not XML),
///         all with its name.
[[nodiscard]] Result<std::unique_ptr<RowSource>> open_rows(
    const std::filesystem::path& file, const TableShape& shape,
    const metering::LocalCalendar* calendar = nullptr);

/// As for rows that are open.
[[nodiscard]] Result<void> read_table(const std::filesystem::path& file, const TableShape& shape,
                                      std::span<const TableMeter> meters,
                                      const metering::LocalCalendar& calendar,
                                      csv::ReadingIntake& intake, ClockFacts* facts = nullptr);

}  // namespace recald::table
