/// Closed months, in the store's `month` table; months to be closed again, in `reopened`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Inserts a month as revision 0 or the next, and removes it from `reopened`. @return the revision.
[[nodiscard]] Result<int> insert_month(Database& database, std::uint32_t meter,
                                       const StoredMonth& month);

/// One revision of a month; nothing if it is not there.
[[nodiscard]] Result<std::optional<StoredMonth>> stored_month(Database& database,
                                                              std::uint32_t meter,
                                                              const std::string& month,
                                                              int revision);

/// The latest revision of each month, ascending. @return malformed when a month's name is invalid.
[[nodiscard]] Result<std::vector<StoredMonth>> stored_months(Database& database,
                                                             std::uint32_t meter);

[[nodiscard]] Result<std::vector<MeterMonth>> reopened_months(Database& database);

/// As Store::closing_rules and Store::put_closing_rules.
[[nodiscard]] Result<std::string> closing_rules_of(Database& database, std::uint32_t meter);
[[nodiscard]] Result<int> replace_closing_rules(Database& database, std::uint32_t meter,
                                                const std::string& rules);

}  // namespace recald::sqlite
