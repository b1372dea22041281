/// Whether the store's tables agree with each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

/// What is wrong with rows of a database that is not damaged, a sentence each.
[[nodiscard]] Result<std::vector<std::string>> row_problems(Database& database);

/// Rows of intervals, all revisions.
[[nodiscard]] Result<std::uint64_t> count_intervals(Database& database);

}  // namespace recald::sqlite
