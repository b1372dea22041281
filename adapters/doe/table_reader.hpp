/// A small CSV table with a header, row by row, and the sentences for what is wrong in it.
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

/// Empty lines and lines that start with # are skipped. A table of a design is small and every
/// number of it counts, so unlike readings a single bad line is an error.
class TableReader {
 public:
  /// Opens the file and reads its header. Column names are trimmed.
  /// @return not_found, io_failed; malformed for an empty file, semicolons, a column without name
  ///         or one that comes twice; unsupported for more columns than a table may have.
  [[nodiscard]] static Result<TableReader> open(const std::filesystem::path& file);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// Index of a column; none where the file lacks it.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const;
  /// Index of a column that has to be there; malformed names the file, the nearest column and all.
  [[nodiscard]] Result<std::size_t> require(std::string_view column) const;

  /// Goes to the next row. @return false at the end; malformed for a row that is none; io_failed.
  [[nodiscard]] Result<bool> next();

  /// Of the row, trimmed. Valid until the next row.
  [[nodiscard]] std::string_view text(std::size_t column) const {
    return csv::trimmed(fields_[column]);
  }
  /// @return malformed for a blank or anything else that is no finite number.
  [[nodiscard]] Result<double> number(std::size_t column) const;
  /// The same, but none for a blank.
  [[nodiscard]] Result<std::optional<double>> number_or_blank(std::size_t column) const;
  /// A whole number from 0 to 999 999 999.
  [[nodiscard]] Result<int> whole_number(std::size_t column) const;

  /// "'FILE':LINE: sentence", about the row.
  [[nodiscard]] tl::unexpected<Error> wrong(const std::string& sentence) const;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// The last line had no line end, as in a file that was cut.
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

/// "a, b and c"; from the ninth on only how many more: "a, b, c, d, e, f, g, h and 12 more".
[[nodiscard]] std::string listed(std::span<const std::string> names);

}  // namespace recald::doe
