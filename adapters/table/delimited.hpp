/// Text with cells separated by commas, semicolons, tabs or bars.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/line_reader.hpp"
#include "adapters/table/row_source.hpp"

namespace recald::table {

struct RowLimits {
  std::size_t line_bytes = csv::kLineMax;
  std::size_t cells = kCellsMax;
};
/// For tables whose times run across: a year of quarters of an hour.
inline constexpr RowLimits kWideRows{.line_bytes = 2u << 20, .cells = 40'000};

/// Splits a line into cells by RFC 4180 with another separator, without blanks around them and out
/// of a spreadsheet's ="0123".
/// @param unquoted   Keeps the contents of quoted cells alive.
/// @param cells_max  What is behind them is left out.
/// @return false when a quote stays open, or text follows a closing one.
[[nodiscard]] bool split_cells(std::string_view line, char separator,
                               std::vector<std::string_view>& cells, std::string& unquoted,
                               std::size_t cells_max = kCellsMax);

/// Lines up to a limit, LF, CRLF or CR; UTF-8 or UTF-16. A line break within quotes becomes a
/// blank, in a row of up to 20 lines; a quote that none of them closes makes its own line a bad
/// one. Rows have the number of their first line.
[[nodiscard]] std::unique_ptr<RowSource> delimited_rows(csv::ByteSource bytes, char separator,
                                                        const RowLimits& limits = {});

/// Converts UTF-16 to UTF-8, since some spreadsheets write "Unicode text", and line ends of old
/// kinds; other text passes unchanged.
[[nodiscard]] csv::ByteSource as_utf8(csv::ByteSource bytes);

}  // namespace recald::table
