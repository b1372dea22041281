/// Registers as read, kept for a while in the store's `sample` table.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Samples of one field, in order of time.
[[nodiscard]] Result<void> for_each_sample(
    Database& database, std::uint32_t meter, const std::string& field,
    const std::function<void(const metering::RegisterSample&)>& visit);

/// Deletes samples from before `keep_from`, at most `rows_max` at a time.
/// @return how many; fewer than `rows_max` when none are left.
[[nodiscard]] Result<int> delete_old_samples(Database& database, metering::Instant keep_from,
                                             int rows_max);

}  // namespace recald::sqlite
