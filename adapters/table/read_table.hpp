/// Turns exports into readings: any container and shape, with the same rules as recald's own CSV.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "adapters/csv/reading_intake.hpp"
#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

/// Opens the file with the container and the layout that its shape names, as rows of one time each.
/// @param calendar  Of the table's clock, outlives the rows; for days with a clock change in a
///                  table with a row a day. Null: all days have 24 hours.
/// @return not_found, io_failed, malformed (not a workbook, no such sheet, not XML),
///         all with its name.
[[nodiscard]] Result<std::unique_ptr<RowSource>> open_rows(
    const std::filesystem::path& file, const TableShape& shape,
    const metering::LocalCalendar* calendar = nullptr);

/// What was found out about clocks while a table was read.
struct ClockFacts {
  std::uint64_t naive = 0;           ///< Stamps without an offset.
  std::uint64_t skipped = 0;         ///< Of these, times that the clock skips.
  std::vector<std::string> notes{};  ///< Of the row source.
};

/// The intake's settings for these meters.
[[nodiscard]] csv::ReadingsOptions intake_options(std::span<const TableMeter> meters);

/// Reads the rows once, in order of time. Memory does not grow with their number, except for
/// counters and for tables whose first rows run from new to old, which are kept and read from
/// their end. The header is the first row with the time column's name. Rows above it are ignored,
/// as are blank rows, a row of units below the header, and repeated headers. A bad row is
/// reported with its number and skipped. If the last line of a text has no line end, it counts
/// only when it is certainly complete: it has as many cells as the lines before, and its last
/// cell as many decimals.
///
/// Stamps without an offset are on the clock of the shape's zone, or else of `calendar`;
/// `ClockReader` describes the hour that occurs twice. A time that the clock skips is a bad row.
///
/// @param name    Names the file in messages.
/// @param intake  For these meters; it may continue with further files of theirs.
/// @return malformed (no such column; the message lists those there are), not_found (no such zone),
///         or the source's failure.
[[nodiscard]] Result<void> read_table(RowSource& rows, std::string_view name,
                                      const TableShape& shape, std::span<const TableMeter> meters,
                                      const metering::LocalCalendar& calendar,
                                      csv::ReadingIntake& intake, ClockFacts* facts = nullptr);

[[nodiscard]] Result<void> read_table(const std::filesystem::path& file, const TableShape& shape,
                                      std::span<const TableMeter> meters,
                                      const metering::LocalCalendar& calendar,
                                      csv::ReadingIntake& intake, ClockFacts* facts = nullptr);

/// As above, for a table that holds all readings of its meters.
[[nodiscard]] Result<csv::ReadingsReport> read_table(RowSource& rows, std::string_view name,
                                                     const TableShape& shape,
                                                     std::span<const TableMeter> meters,
                                                     const metering::LocalCalendar& calendar,
                                                     const csv::ReadingsSink& sink,
                                                     ClockFacts* facts = nullptr);

/// Index of a column in a header, by name or as "#3"; nothing if there is no such column.
[[nodiscard]] std::optional<std::size_t> find_column(std::span<const std::string> header,
                                                     std::string_view column);

/// The most frequent separator in a header line. Of equally frequent ones, a tab comes before a
/// semicolon before a comma.
[[nodiscard]] char likely_separator(std::string_view line);

}  // namespace recald::table
