/// Manual changes: who, when, why, and from which file. Rows of `interval` from an
/// edit refer to it.
#pragma once

#include <cstdint>
#include <set>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Inserts an edit. @return its number, set by the table, or invalid_value without a reason.
[[nodiscard]] Result<std::int64_t> insert_edit(Database& database, const StoreEdit& edit);

[[nodiscard]] Result<void> delete_edit(Database& database, std::int64_t number);

/// As Store::edited_days.
[[nodiscard]] Result<std::set<metering::Instant>> edited_days(Database& database,
                                                              std::uint32_t meter);

}  // namespace recald::sqlite
