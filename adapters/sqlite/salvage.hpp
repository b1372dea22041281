/// Rows out of a database file that is damaged somewhere.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "adapters/sqlite/page_rows.hpp"

namespace recald::sqlite {

struct SalvagedRows {
  std::map<std::string, std::int64_t> rows;  ///< By table: those that `to` did not have.
  std::int64_t refused = 0;  ///< Their check sum, or the schema, spoke against them.
};

/// Copies every row that stands on a page of `from` that can be read, whatever of the tree above it
/// is damaged. What lies there twice, as an old copy of a page, is taken once; of what changes, the
/// newest.
/// @pre `to` has the current schema and its foreign keys are off: rows come in order of their
/// pages.
/// @return or as Database::execute when `to` cannot be written.
[[nodiscard]] Result<SalvagedRows> salvage(const PagedFile& from, Database& to,
                                           const OnProgress& on_progress);

/// Makes whole what rows refer to: meters and edits that are lost get a place holder, revisions
/// close up. Rows of a meter that hardly has any are dropped.
[[nodiscard]] Result<void> mend_references(Database& database);

}  // namespace recald::sqlite
