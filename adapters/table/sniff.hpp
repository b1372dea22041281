/// Guesses how to read an export that nobody described.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/table/cells/column_kinds.hpp"
#include "adapters/table/cells/header_units.hpp"
#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

inline constexpr std::size_t kSniffedRows = 2000;  ///< The guess is based on these.

/// What somebody says of a table; nothing of that is guessed.
struct TableHints {
  std::string time_column;           ///< By name or "#3"; empty: found.
  std::string meter_column;          ///< Likewise.
  std::vector<std::string> columns;  ///< With values; empty: found.
  std::optional<TimeFormat> dates;   ///< The order of a date's parts.
  std::optional<char> decimal;
  std::string sheet;  ///< Of a workbook.
};

struct GuessedColumn {
  std::string name;          ///< As in the header, without the unit.
  std::string column;        ///< How a site file names it: the header's text, or "#3".
  std::string unit;          ///< Empty: nothing says it.
  std::string unit_because;  ///< "as the header says"; where it is from.
};

/// A guessed shape, with a short reason for each part.
struct TableGuess {
  TableShape shape;
  std::vector<GuessedColumn> values;  ///< One column per meter, or the values of a long table.
  std::vector<std::string> ignored;   ///< Unused columns: "Status (text)".
  std::vector<std::string> notes;     ///< A sentence each, on what else was decided.
  std::string time_format_because;
  bool is_time_format_open = false;  ///< Day or month first: the data do not tell.
  std::string decimal_because;
  std::string flag_column;            ///< That says how good values are, whatever its flags mean.
  std::string unit_column;            ///< With units, of a table whose rows do not name meters.
  bool has_offsets = false;           ///< Stamps include their offset from UTC.
  std::optional<csv::Stamps> stamps;  ///< What a stamp marks, if that is certain.
  std::string stamps_because;
  /// Labels of the clock column count to this many in a day, and `read_clock_labels` has to tell
  /// what they count. 0: its times are those of a clock.
  int labels_a_day = 0;
};

/// Finds header, times, numbers, meters and units in the first rows of a table.
/// @return malformed: a sentence on what cannot be understood, without the file's name: no times,
///         no numbers, two headers, formats that change.
[[nodiscard]] Result<TableGuess> guess_table(std::span<const KeptRow> rows,
                                             const TableHints& hints = {});

/// The container, from a file's first bytes. @return or malformed: what the file
/// seems to be instead
[[nodiscard]] Result<Container> guess_container(std::string_view first_bytes);

/// The separator that splits most of a text's first lines into the same number of cells.
[[nodiscard]] char guess_separator(std::span<const std::string> lines);

}  // namespace recald::table
