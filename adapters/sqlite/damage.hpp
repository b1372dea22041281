/// Finds damage in a store's file: in its header, tables, structure and rows.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Reads the whole file: checks that header and tables match, then runs `quick_check`, then
/// compares the rows' checksums.
/// @param stop  Stops the check from another thread.
/// @return what is damaged; empty: nothing, or there is no file. Another program's database and a
///         newer version are errors (unsupported), not damage; io_failed when the file cannot be
///         read; cancelled when the check was stopped.
[[nodiscard]] Result<std::string> damage_of(const std::filesystem::path& file,
                                            const OnProgress& on_progress = {},
                                            const std::stop_token& stop = {});

}  // namespace recald::sqlite
