/// Copies rows out of a partly damaged database file.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "adapters/sqlite/recovery/page_rows.hpp"

namespace recald::sqlite {

struct SalvagedRows {
  std::map<std::string, std::int64_t> rows;  ///< By table: rows that `to` did not have.
  std::int64_t refused = 0;                  ///< Refused by their checksum or the schema.
};

/// Copies every row on a readable page of `from`, even if the tree above it is damaged. A row
/// found twice, for example on an old copy of a page, is copied once; of rows that change,
/// the newest is kept.
/// @pre `to` has the current schema and its foreign keys are off: rows come in
///      order of their pages.
/// @return the counts, or as Database::execute when `to` cannot be written.
[[nodiscard]] Result<SalvagedRows> salvage(const PagedFile& from, Database& to,
                                           const OnProgress& on_progress);

/// Repairs references: lost meters and edits get a placeholder, revisions are renumbered without
/// gaps. Rows of a meter with hardly any rows are dropped.
[[nodiscard]] Result<void> mend_references(Database& database);

}  // namespace recald::sqlite
