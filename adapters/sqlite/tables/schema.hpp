/// The tables of the store and the upgrade of older files. README.md describes them.
#pragma once

#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

inline constexpr int kSchemaVersion = 7;

/// The version of a file's tables; 0: it has none yet. The number in the header is compared with
/// the tables themselves, so that a flipped bit in either cannot pass for another version.
/// @return the version, or unsupported when the file was written by a newer version or is another
///         program's database; malformed when it is recald's but header and tables do not match; or
///         as Database::execute.
[[nodiscard]] Result<int> schema_version(Database& database);

/// Creates the tables in a new file, or upgrades an older one, each version in a transaction.
/// @param until  The version to stop at.
/// @return nothing, or as schema_version.
[[nodiscard]] Result<void> bring_up_to_date(Database& database, int until = kSchemaVersion);

/// For readers, which cannot upgrade. @return unsupported for an older file as well.
[[nodiscard]] Result<void> require_current(Database& database);

}  // namespace recald::sqlite
