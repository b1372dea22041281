/// The files of a store, and the names under which it is put aside.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "adapters/sqlite/tables/database.hpp"
#include "core/metering/reading.hpp"

namespace recald::sqlite {

/// The log goes first, since it is useless without its file.
inline constexpr std::array kStoreParts{"-wal", "-shm", ""};

/// False also for what cannot be looked at.
[[nodiscard]] bool is_there(const std::filesystem::path& file);

/// "20240301T051500Z", for a file name.
[[nodiscard]] std::string stamp_of(metering::Instant t);

/// `wanted`, or with "-2", "-3" … after it, so that no file of a store has that name. Files put
/// aside may hold the only copy of some rows, and time stamps repeat on a machine whose clock
/// starts at the same time after each power cut.
[[nodiscard]] std::filesystem::path free_name(const std::filesystem::path& wanted);

/// Removes a store that nobody needs, with its log.
void remove_store(const std::filesystem::path& file);

/// The time of an event that recald enters while it puts a store in place. A clock that has not
/// been set yet shows a time before everything stored, and an event of 1970 would be deleted as
/// old.
[[nodiscard]] Result<metering::Instant> time_of_event(Database& store, metering::Instant now);

}  // namespace recald::sqlite
