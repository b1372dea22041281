/// How an export that nobody described is probably to be read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"

namespace recald::table {

inline constexpr std::size_t kSniffedRows = 2000;  ///< From whose cells a shape is guessed.

/// A row, kept.
struct KeptRow {
  std::uint64_t number;
  std::vector<std::string> cells;  ///< UTF-8.
};

struct GuessedColumn {
  std::string name;    ///< As the header has it, without the unit.
  std::string column;  ///< How a site file names it: the header's text, or "#3".
  std::string unit;    ///< Empty: neither the header nor a row of units says it.
};

/// A shape, with the reason for each guess in a few words.
struct TableGuess {
  TableShape shape;
  std::vector<GuessedColumn> values;  ///< A column a meter, or the values of a long table.
  std::vector<std::string> ignored;   ///< Columns that are not used: "Status (text)".
  std::string time_format_because;
  bool is_time_format_open = false;  ///< Nothing decides between days and months.
  std::string decimal_because;
  bool has_offsets = false;  ///< Stamps say their offset from UTC.
};

/// Finds header, times, numbers, meters and units in the first rows of a table.
/// @return malformed: a sentence of what cannot be understood, without the file's name: no times,
///         no numbers, two headers, formats that change.
[[nodiscard]] Result<TableGuess> guess_table(std::span<const KeptRow> rows);

/// The container by a file's first bytes. @return or malformed: what else it seems to be
[[nodiscard]] Result<Container> guess_container(std::string_view first_bytes);

/// Of the first lines of a text: the sign that cuts most of them into as many cells.
[[nodiscard]] char guess_separator(std::span<const std::string> lines);

/// "Main (kWh)", "Main [kWh]", "Main kWh", "Main_kWh": the name and the unit; without one the unit
/// is empty.
struct NameAndUnit {
  std::string name;
  std::string unit;
};
[[nodiscard]] NameAndUnit split_unit(std::string_view header);

/// Whether a text is a unit that some meter may have.
[[nodiscard]] bool is_unit(std::string_view text);

}  // namespace recald::table
