/// What a store's file has, without writing anything, not even beside it.
#pragma once

#include <filesystem>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Whether a file has no log, so that nobody writes it now. Opened to read without saying so,
/// SQLite would make a log and its index and leave them.
[[nodiscard]] bool is_still(const std::filesystem::path& file);

/// Opens a file to read as it is. Its log, where it has one, is read too.
[[nodiscard]] Result<Database> open_untouched(const std::filesystem::path& file);

/// @return the summary; malformed: an empty file, or a damaged one; unsupported: written by a newer
///         recald, or by another program; io_failed: cannot be read.
[[nodiscard]] Result<StoreSummary> summary_of(const std::filesystem::path& file);

/// The same of an open database.
[[nodiscard]] Result<StoreSummary> summary_of(Database& database);

}  // namespace recald::sqlite
