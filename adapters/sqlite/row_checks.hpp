/// Whether the store's tables agree with each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Faults in the rows of an undamaged database, one sentence each.
[[nodiscard]] Result<std::vector<std::string>> row_problems(Database& database);

/// Number of interval rows, including all revisions.
[[nodiscard]] Result<std::uint64_t> count_intervals(Database& database);

}  // namespace recald::sqlite
