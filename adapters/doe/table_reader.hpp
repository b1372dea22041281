/// Reads a small CSV table with a header row by row, and words the errors in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"
#include "core/result.hpp"

namespace recald::doe {

/// Empty lines and lines that start with # are skipped. A design's tables are small and every
/// number counts, so unlike in readings a single bad line is an error.
class TableReader {
 public:
  /// Opens the file and reads its header. Column names are trimmed.
  /// @return not_found, io_failed; malformed for an empty file, semicolons, a column without a name
  ///         or a repeated name; unsupported for more columns than a table may have.
  [[nodiscard]] static Result<TableReader> open(const std::filesystem::path& file);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// Index of a column, or nothing if the file lacks it.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const;
  /// Index of a required column; the malformed error names the file, the nearest column and all
  /// columns.
  [[nodiscard]] Result<std::size_t> require(std::string_view column) const;

  /// Moves to the next row. @return false at the end; malformed for a broken row; io_failed.
  [[nodiscard]] Result<bool> next();

  /// The trimmed text of a cell in this row. Valid until the next row.
  [[nodiscard]] std::string_view text(std::size_t column) const {
    return csv::trimmed(fields_[column]);
  }
  /// @return malformed for a blank cell or anything else that is not a finite number.
  [[nodiscard]] Result<double> number(std::size_t column) const;
  /// As above, but returns nothing for a blank cell.
  [[nodiscard]] Result<std::optional<double>> number_or_blank(std::size_t column) const;
  /// A whole number from 0 to 999 999 999.
  [[nodiscard]] Result<int> whole_number(std::size_t column) const;

  /// The error "'FILE':LINE: sentence" about this row.
  [[nodiscard]] tl::unexpected<Error> wrong(const std::string& sentence) const;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Whether the last line has no line end, as in a truncated file.
  [[nodiscard]] bool ends_open() const { return ends_open_; }

 private:
  TableReader(std::filesystem::path file, csv::ByteSource source)
      : file_{std::move(file)}, lines_{std::move(source)} {}

  Result<void> read_header();
  Result<bool> next_line(csv::Line& line);
  [[nodiscard]] tl::unexpected<Error> wrong_header(const std::string& sentence) const;

  std::filesystem::path file_;
  csv::LineReader lines_;
  csv::FieldSplitter fields_;
  std::vector<std::string> columns_;
  std::uint64_t line_ = 0;
  bool ends_open_ = false;
};

/// "a, b and c"; with more than nine, the rest is counted: "a, b, c, d, e, f, g, h and 12 more".
[[nodiscard]] std::string listed(std::span<const std::string> names);

}  // namespace recald::doe
