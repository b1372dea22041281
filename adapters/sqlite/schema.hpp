/// The tables of the store and how older files are brought up to date. README.md describes them.
#pragma once

#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

inline constexpr int kSchemaVersion = 5;

/// The version of a file's tables; 0: it has none yet. Its number stands in the header and is held
/// against the tables themselves: one flipped bit in either must not pass for another version.
/// @return or unsupported when the file was written by a newer version, or is another program's
///         database; malformed when it is recald's, and header and tables do not fit each other; or
///         as Database::execute.
[[nodiscard]] Result<int> schema_version(Database& database);

/// Creates the tables in a new file, upgrades an older one, each version in a transaction.
/// @param until  The version to stop at.
/// @return nothing, or as schema_version.
[[nodiscard]] Result<void> bring_up_to_date(Database& database, int until = kSchemaVersion);

/// For readers, who cannot upgrade anything. @return unsupported for an older file as well.
[[nodiscard]] Result<void> require_current(Database& database);

}  // namespace recald::sqlite
