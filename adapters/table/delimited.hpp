/// Text whose cells are separated by commas, semicolons, tabs or bars.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/line_reader.hpp"
#include "adapters/table/row_source.hpp"

namespace recald::table {

/// Cells of one line by RFC 4180 with another separator, trimmed. Up to kCellsMax.
/// @param unquoted  Keeps the contents of quoted cells alive.
/// @return false when a quote stays open, or text follows a closing one.
[[nodiscard]] bool split_cells(std::string_view line, char separator,
                               std::vector<std::string_view>& cells, std::string& unquoted);

/// Lines up to 64 KiB, LF or CRLF; UTF-8, or UTF-16 with a byte order mark. A line break within
/// quotes is a bad line.
[[nodiscard]] std::unique_ptr<RowSource> delimited_rows(csv::ByteSource bytes, char separator);

/// UTF-16 with a byte order mark as UTF-8, as some spreadsheets write "Unicode text"; anything else
/// as it is.
[[nodiscard]] csv::ByteSource as_utf8(csv::ByteSource bytes);

/// Text that is no UTF-8 is taken for Latin-1, as older programs write "m³" and "°C".
[[nodiscard]] std::string utf8_of(std::string_view text);

}  // namespace recald::table
