/// The tables of the store and how older files are brought up to date. README.md describes them.
#pragma once

#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

inline constexpr int kSchemaVersion = 5;

/// The version of a file's tables; 0: it has none yet.
/// @return or unsupported when the file was written by a newer version, or is another program's
///         database; or as Database::execute.
[[nodiscard]] Result<int> schema_version(Database& database);

/// Creates the tables in a new file, upgrades an older one, each version in a transaction.
/// @return nothing, or as schema_version.
[[nodiscard]] Result<void> bring_up_to_date(Database& database);

/// For readers, who cannot upgrade anything. @return unsupported for an older file as well.
[[nodiscard]] Result<void> require_current(Database& database);

}  // namespace recald::sqlite
