/// Requested calibrations and diagnoses, in the store's `job` table.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Inserts a job. @return its number, set by the table, or the database's errors.
[[nodiscard]] Result<std::int64_t> insert_job(Database& database, const StoredJob& job);
/// @return not_found when no job has this number.
[[nodiscard]] Result<void> update_job(Database& database, const StoredJob& job);
[[nodiscard]] Result<std::optional<StoredJob>> find_job(Database& database, std::int64_t number);
[[nodiscard]] Result<std::vector<StoredJob>> newest_jobs(Database& database, JobKind kind,
                                                         int limit);
[[nodiscard]] Result<std::optional<StoredJob>> oldest_finished_job_beyond(Database& database,
                                                                          JobKind kind, int kept);
[[nodiscard]] Result<void> remove_job(Database& database, std::int64_t number);
[[nodiscard]] Result<std::optional<StoredJob>> last_accepted_job(Database& database, JobKind kind);
[[nodiscard]] Result<std::vector<StoredJob>> unfinished_jobs(Database& database);

}  // namespace recald::sqlite
