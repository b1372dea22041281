/// Turns exports into readings: any container and shape, with the same rules as recald's own CSV.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "adapters/csv/reading_intake.hpp"
#include "adapters/table/flags.hpp"
#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

/// The rows of a day on which the clock changes.
struct ClockChange {
  struct Counts {
    std::uint64_t skipped = 0;       ///< In the hour that the clock skips …
    std::uint64_t skipped_ends = 0;  ///< … or there if times are ends of intervals …
    std::uint64_t first = 0;         ///< … in the one that it shows twice, the first time …
    std::uint64_t second = 0;        ///< … and the second.
  };
  /// Rows; those in the hour that is skipped only if they have a number.
  Counts rows;
  /// Those with a value that is not zero: some programs fill an hour that was never measured.
  Counts values;
};

/// What was found out about clocks and flags while a table was read.
struct ClockFacts {
  std::uint64_t naive = 0;    ///< Stamps without an offset.
  std::uint64_t skipped = 0;  ///< Of these, times that the clock skips.
  std::map<metering::Day, ClockChange> changes;
  /// Days on which a time came again within an hour, as when a clock is put back, with the first
  /// such time; so many at most.
  static constexpr std::size_t kPutBackMax = 16;
  std::map<metering::Day, metering::Instant> put_back;
  std::uint64_t repeated = 0;         ///< Times that came again.
  std::uint64_t further_headers = 0;  ///< Of blocks further down with other columns.
  std::uint64_t words = 0;            ///< Cells with a word for no value, such as "n/a".
  std::string first_word;             ///< The first of them.

  void add_word(std::string_view word) {
    if (words++ == 0) first_word = word;
  }
  std::vector<FlagCount> flags = {};  ///< Of the flag column, the first `kFlagsMax`.
  std::vector<std::string> notes{};   ///< Of the row source.
};

/// The intake's settings for these meters.
[[nodiscard]] csv::ReadingsOptions intake_options(std::span<const TableMeter> meters);

/// Reads the rows once, in order of time. Memory does not grow with their number, except for
/// counters and for tables whose first rows run from new to old, which are kept and read from
/// their end. The header is the first row with the names of all columns. Rows above it are ignored,
/// as are blank rows, rows of units or more names below it, and repeated headers. A bad row is
/// reported with its number and skipped. If the last line of a text has no line end, it counts
/// only when it is certainly complete: it has as many cells as the lines before, and its last
/// cell as many decimals.
///
/// Stamps without an offset are on the clock of the shape's zone, or else of `calendar`;
/// `ClockReader` describes the hour that occurs twice. A time that the clock skips is a bad row,
/// and so is one whose zone has letters that stand for an offset far from the clock's. A cell with
/// a unit of its own, "12.3 kWh", is read in that unit.
///
/// @param name    Names the file in messages.
/// @param intake  For these meters; it may continue with further files of theirs.
/// @return malformed (no such column; the message lists those there are), not_found (no such zone),
///         or the source's failure.
[[nodiscard]] Result<void> read_table(RowSource& rows, std::string_view name,
                                      const TableShape& shape, std::span<const TableMeter> meters,
                                      const metering::LocalCalendar& calendar,
                                      csv::ReadingIntake& intake, ClockFacts* facts = nullptr);

/// As above, for a table that holds all readings of its meters.
[[nodiscard]] Result<csv::ReadingsReport> read_table(RowSource& rows, std::string_view name,
                                                     const TableShape& shape,
                                                     std::span<const TableMeter> meters,
                                                     const metering::LocalCalendar& calendar,
                                                     const csv::ReadingsSink& sink,
                                                     ClockFacts* facts = nullptr);

/// Index of the time column in what may be a table's header; nothing if it is none: without the
/// clock column, or a line above the table, "Date;11/12/2023".
[[nodiscard]] std::optional<std::size_t> find_time_in_header(std::span<const std::string> header,
                                                             const TableShape& shape);

/// Index of a column in a header, by name or as "#3"; nothing if there is no such column.
[[nodiscard]] std::optional<std::size_t> find_column(std::span<const std::string> header,
                                                     std::string_view column);

/// The most frequent separator in a header line. Of equally frequent ones, a tab comes before a
/// semicolon before a comma.
[[nodiscard]] char likely_separator(std::string_view line);

}  // namespace recald::table
