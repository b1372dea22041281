/// Forecasts of each month and how they compared, in the store's `forecast` table.
#pragma once

#include <span>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// As Store::add_forecasts, within the caller's transaction.
[[nodiscard]] Result<void> insert_forecasts(Database& database,
                                            std::span<const StoredForecast> forecasts);
[[nodiscard]] Result<std::vector<StoredForecast>> stored_forecasts(Database& database);

}  // namespace recald::sqlite
