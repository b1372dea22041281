/// Rows straight from the pages of a database file, without asking SQLite, which gives up on a tree
/// where one of its pages is damaged. Every page that holds rows is read by itself.
///
/// Plain functions on bytes, so that they can be fuzzed.
/// @see SQLite, "Database File Format", 1.6 (b-tree pages), 2.1 (records), 4 (the log).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapters/sqlite/tables.hpp"
#include "core/result.hpp"

namespace recald::sqlite {

using Bytes = std::span<const std::uint8_t>;

/// A page by its number, from 1 on; empty: there is none.
using PageOf = std::function<std::vector<std::uint8_t>(std::uint32_t number)>;

/// A row as a page has it.
struct PageRow {
  std::optional<std::int64_t> rowid;  ///< Of a table that has such; then its first value is null.
  std::vector<Value> values;
};

/// All rows on one page that can be decoded, in the order of their cells. What is no page of rows
/// has none, and what looks like one may give nonsense: who takes the rows judges them.
/// @param page_of  Where a row goes on that is too long for its page.
[[nodiscard]] std::vector<PageRow> rows_on_page(Bytes page, bool is_first, const PageOf& page_of);

/// A database file with what its log has committed.
class PagedFile {
 public:
  /// @return not_found without a file, io_failed where it cannot be read. A damaged log is read as
  ///         far as its own sums hold.
  [[nodiscard]] static Result<PagedFile> open(const std::filesystem::path& file);

  [[nodiscard]] std::uint32_t pages() const { return pages_; }
  /// @return empty for a number that is none.
  [[nodiscard]] std::vector<std::uint8_t> page(std::uint32_t number) const;

 private:
  [[nodiscard]] Result<void> read_log();

  std::filesystem::path file_;
  std::filesystem::path log_;
  std::uint32_t pages_ = 0;
  std::map<std::uint32_t, std::uint64_t> in_log_;  ///< Place in the log by page.
};

}  // namespace recald::sqlite
