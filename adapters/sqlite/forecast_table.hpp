/// What was forecast of each month and how it did, in the store's `forecast` table.
#pragma once

#include <span>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

/// As Store::add_forecasts, within a transaction of the caller.
[[nodiscard]] Result<void> insert_forecasts(Database& database,
                                            std::span<const StoredForecast> forecasts);
[[nodiscard]] Result<std::vector<StoredForecast>> stored_forecasts(Database& database);

}  // namespace recald::sqlite
