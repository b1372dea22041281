/// How an export is written, as far as its first rows show: sheet, layout, columns.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adapters/table/sniff.hpp"
#include "core/result.hpp"

namespace recald::daemon {

struct FileGuess {
  table::TableGuess table;
  std::string layout_because;      ///< Empty for a table of rows.
  std::vector<std::string> notes;  ///< Of other sheets that have tables too.
};

/// The first lines of a text, for its separator; of wide tables the first few.
[[nodiscard]] Result<std::vector<std::string>> first_lines(const std::filesystem::path& file);

/// @param container  Text, a workbook or JSON.
/// @param lines      Of a text.
/// @param hints      What somebody says of it is not guessed.
/// @return or malformed: what cannot be understood, without the file's name.
[[nodiscard]] Result<FileGuess> guess_file(const std::filesystem::path& file,
                                           table::Container container,
                                           std::span<const std::string> lines,
                                           const table::TableHints& hints);

/// Of blocks that stand below each other, each with a header of its own: the columns of values that
/// the first one lacks.
[[nodiscard]] Result<std::vector<table::GuessedColumn>> columns_of_further_blocks(
    const std::filesystem::path& file, const table::TableShape& shape);

}  // namespace recald::daemon
