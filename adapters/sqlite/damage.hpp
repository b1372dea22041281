/// What is wrong with a store's file: its header, its tables, its structure, its rows.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

/// Reads all of a file: whether header and tables fit each other, then `quick_check`, then the
/// rows' check sums.
/// @param stop  Ends it from another thread.
/// @return what is damaged; empty: nothing, or there is no file. Another program's database and a
///         newer version are errors (unsupported), not damage; io_failed when it cannot be read;
///         cancelled when it was stopped.
[[nodiscard]] Result<std::string> damage_of(const std::filesystem::path& file,
                                            const OnProgress& on_progress = {},
                                            const std::stop_token& stop = {});

}  // namespace recald::sqlite
