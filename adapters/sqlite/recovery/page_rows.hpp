/// Reads rows straight from the pages of a database file, without SQLite, which gives up on a tree
/// with one damaged page. Each page with rows is read on its own.
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

#include "adapters/sqlite/tables/tables.hpp"
#include "core/result.hpp"

namespace recald::sqlite {

using Bytes = std::span<const std::uint8_t>;

/// Returns a page by its number, from 1 on; empty: there is none.
using PageOf = std::function<std::vector<std::uint8_t>(std::uint32_t number)>;

/// A row as stored on a page.
struct PageRow {
  std::optional<std::int64_t> rowid;  ///< Of a table with rowids; then its first value is null.
  std::vector<Value> values;
};

/// All rows on one page that can be decoded, in the order of their cells. A page of another kind
/// has none. A page that only looks right may yield nonsense, so the caller must check the rows.
/// @param page_of  Finds the overflow pages of a row that is too long for its page.
[[nodiscard]] std::vector<PageRow> rows_on_page(Bytes page, bool is_first, const PageOf& page_of);

/// A database file together with the commits in its log.
class PagedFile {
 public:
  /// @return not_found without a file, io_failed if it cannot be read. A damaged log is read as far
  ///         as its checksums are right.
  [[nodiscard]] static Result<PagedFile> open(const std::filesystem::path& file);

  [[nodiscard]] std::uint32_t pages() const { return pages_; }
  /// @return the page, or empty for an invalid number.
  [[nodiscard]] std::vector<std::uint8_t> page(std::uint32_t number) const;

 private:
  [[nodiscard]] Result<void> read_log();

  std::filesystem::path file_;
  std::filesystem::path log_;
  std::uint32_t pages_ = 0;
  std::map<std::uint32_t, std::uint64_t> in_log_;  ///< Position in the log by page.
};

}  // namespace recald::sqlite
