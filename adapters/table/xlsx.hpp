/// Sheets of .xlsx workbooks (ECMA-376) as rows of text.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "adapters/table/row_source.hpp"

namespace recald::table {

/// Names of the sheets, in order; those that are hidden only where all are.
[[nodiscard]] Result<std::vector<std::string>> sheet_names(const std::filesystem::path& file);

/// Reads the rows of one sheet, one at a time, with up to 16 384 cells each. Numbers keep their
/// stored value, with a decimal point; cells formatted as dates come as "2024-03-31 14:15:00",
/// "2024-03-31" or "14:15:00". Shared texts are held in memory, up to 64 MiB.
/// @param sheet  The name; empty: the first sheet.
/// @return the rows, or not_found, io_failed, malformed (not a workbook; no such sheet: the message
///         lists the sheets).
[[nodiscard]] Result<std::unique_ptr<RowSource>> open_sheet(const std::filesystem::path& file,
                                                            const std::string& sheet);

}  // namespace recald::table
