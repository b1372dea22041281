/// Rows of text cells from any container.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/text/printable.hpp"

namespace recald::table {

inline constexpr std::size_t kCellsMax = 1024;  ///< Per row; further cells are ignored.

struct TableRow {
  std::uint64_t number =
      0;  ///< From 1: the line of a text, the row of a sheet, a reading of a feed.
  std::vector<std::string_view> cells;  ///< Trimmed; valid until the next row.
  std::string_view text;                ///< The unchanged row, for messages.
  std::string_view problem;             ///< Why it has no cells: a quote stays open.
  bool is_terminated = true;            ///< False for a last line that may be cut off.
};

class RowSource {
 public:
  virtual ~RowSource() = default;

  /// @return false at the end, and when the source fails; then `error` says why.
  virtual bool next(TableRow& row) = 0;
  [[nodiscard]] virtual const std::optional<Error>& error() const = 0;

  /// What readers should be told, a sentence each, once all rows have been read; names that the
  /// file chose are printable in it.
  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> sentences = said();
    for (std::string& sentence : sentences) sentence = printable(sentence);
    return sentences;
  }

 private:
  /// The notes, with names as the file writes them.
  [[nodiscard]] virtual std::vector<std::string> said() const { return {}; }
};

}  // namespace recald::table
