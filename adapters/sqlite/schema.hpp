/// The tables of the store and how older files are brought up to date. README.md describes them.
#pragma once

#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

inline constexpr int kSchemaVersion = 2;

/// Creates the tables in a new file, upgrades an older one, each version in a transaction.
/// @return unsupported when the file was written by a newer version; malformed when it is another
///         program's database; or as Database::execute.
[[nodiscard]] Result<void> bring_up_to_date(Database& database);

}  // namespace recald::sqlite
