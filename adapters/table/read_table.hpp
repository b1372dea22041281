/// Exports to readings: any container and shape, the same rules as for recald's own CSV.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "adapters/csv/reading_intake.hpp"
#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

/// Opens the file as what its shape says.
/// @return not_found, io_failed, malformed (no workbook, no such sheet, no XML), all with its name.
[[nodiscard]] Result<std::unique_ptr<RowSource>> open_rows(const std::filesystem::path& file,
                                                           const TableShape& shape);

/// What was said of clocks while a table was read.
struct ClockFacts {
  std::uint64_t naive = 0;    ///< Stamps without an offset.
  std::uint64_t skipped = 0;  ///< Of them, times that the clock jumps over.
};

/// What an intake has to know of these meters.
[[nodiscard]] csv::ReadingsOptions intake_options(std::span<const TableMeter> meters);

/// Reads the rows once, in order of time; memory does not grow with their number, but for counters
/// and for tables whose first rows run from new to old, which are kept and read from their end. The
/// header is the first row with the time column's name; what stands above is left alone, and so are
/// blank rows, a row of units below the header and headers that come again. A bad row is reported
/// with its number and kept out. The last line of a text without a line end counts only when it is
/// surely whole: as many cells as before, the last one with as many decimals.
///
/// Stamps without an offset are on the clock of the shape's zone, else of `calendar`; see
/// `ClockReader` for the hour that comes twice. A time that the clock jumps over is a bad row.
///
/// @param name    Stands in messages.
/// @param intake  Of these meters; it may go on to further files of theirs.
/// @return malformed (no such column; the message lists those there are), not_found (no such
///         zone), or the source's failure.
[[nodiscard]] Result<void> read_table(RowSource& rows, std::string_view name,
                                      const TableShape& shape, std::span<const TableMeter> meters,
                                      const metering::LocalCalendar& calendar,
                                      csv::ReadingIntake& intake, ClockFacts* facts = nullptr);

[[nodiscard]] Result<void> read_table(const std::filesystem::path& file, const TableShape& shape,
                                      std::span<const TableMeter> meters,
                                      const metering::LocalCalendar& calendar,
                                      csv::ReadingIntake& intake, ClockFacts* facts = nullptr);

/// A table that is all there is of its meters.
[[nodiscard]] Result<csv::ReadingsReport> read_table(RowSource& rows, std::string_view name,
                                                     const TableShape& shape,
                                                     std::span<const TableMeter> meters,
                                                     const metering::LocalCalendar& calendar,
                                                     const csv::ReadingsSink& sink,
                                                     ClockFacts* facts = nullptr);

/// Where a column stands in a header: by its name, or "#3". None: it has no such one.
[[nodiscard]] std::optional<std::size_t> find_column(std::span<const std::string> header,
                                                     std::string_view column);

/// Of the first line of a text with cells: the sign that there is most of, a tab before a semicolon
/// before a comma where as many.
[[nodiscard]] char likely_separator(std::string_view line);

}  // namespace recald::table
