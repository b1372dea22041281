#include "adapters/sqlite/tables/job_table.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/results/job_result_json.hpp"
#include "adapters/sqlite/tables/rows.hpp"
#include "adapters/sqlite/tables/tables.hpp"
#include "core/text/limited.hpp"

namespace recald::sqlite {
namespace {

using metering::Instant;

constexpr auto kColumns =
    "number, kind, state, asked_by, asked, started, ended, accepted, message, folder, tries";

/// Binds all of a job except its number, which an update has at the end.
template <class... More>
Statement& bind_job(Statement& statement, const StoredJob& job, const More&... more) {
  return bound(statement, job.kind, job.state, job.asked_by, job.asked, job.started, job.ended,
               job.accepted, limited(job.message, kJobMessageMax), job.folder, job.result.document,
               job.tries, more...);
}

/// Reads columns as in `kColumns`.
StoredJob read_job(Columns columns) {
  return {.number = columns,
          .kind = columns,
          .state = columns,
          .asked_by = columns,
          .asked = columns,
          .started = columns.next<std::optional<Instant>>(),
          .ended = columns.next<std::optional<Instant>>(),
          .accepted = columns,
          .message = columns,
          .folder = columns,
          .tries = columns};
}

Result<std::vector<StoredJob>> read_jobs(Statement& query) { return all_rows(query, read_job); }

/// Reads the row of a query for `kColumns` and the result.
Result<std::optional<StoredJob>> read_whole_job(Statement& query) {
  const auto row = TRY(query.step());
  if (!row) return std::optional<StoredJob>{};
  StoredJob job = read_job(Columns{query});
  job.result = results::read_job_result(query.text(11));
  query.reset();
  return std::optional{std::move(job)};
}

}  // namespace

Result<std::int64_t> insert_job(Database& database, const StoredJob& job) {
  auto insert = TRY(database.prepare(fmt::format(
      "INSERT INTO job VALUES (NULL, ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, {}) RETURNING "
      "number",
      sum_of("job", 11))));
  TRY(bind_job(insert, job).step());
  const std::int64_t number = insert.integer(0);
  TRY(insert.run());
  return number;
}

Result<void> update_job(Database& database, const StoredJob& job) {
  auto update = TRY(database.prepare(fmt::format(
      "UPDATE job SET kind = ?1, state = ?2, asked_by = ?3, asked = ?4, started = ?5, ended = ?6, "
      "accepted = ?7, message = ?8, folder = ?9, result = ?10, tries = ?11, sum = {} "
      "WHERE number = ?12 RETURNING number",
      sum_of("job", 11))));
  const auto row = TRY(bind_job(update, job, job.number).step());
  if (!row) {
    return failure(ErrorCode::not_found, fmt::format("there is no job {}", job.number));
  }
  return update.run();
}

Result<std::optional<StoredJob>> find_job(Database& database, std::int64_t number) {
  auto query =
      TRY(database.prepare(fmt::format("SELECT {}, result FROM job WHERE number = ?", kColumns)));
  return read_whole_job(bound(query, number));
}

Result<std::vector<StoredJob>> newest_jobs(Database& database, JobKind kind, int limit) {
  auto query = TRY(database.prepare(
      fmt::format("SELECT {} FROM job WHERE kind = ? ORDER BY number DESC LIMIT ?", kColumns)));
  return read_jobs(bound(query, kind, limit));
}

Result<std::optional<StoredJob>> oldest_finished_job_beyond(Database& database, JobKind kind,
                                                            int kept) {
  auto query = TRY(database.prepare(fmt::format(
      "SELECT {} FROM job WHERE kind = ?1 AND ended IS NOT NULL AND number < "
      "(SELECT number FROM job WHERE kind = ?1 AND ended IS NOT NULL ORDER BY number DESC "
      "LIMIT 1 OFFSET ?2 - 1) AND number <> coalesce((SELECT max(number) FROM job WHERE kind = ?1 "
      "AND accepted = 1), 0) ORDER BY number LIMIT 1",
      kColumns)));
  auto jobs = TRY(read_jobs(bound(query, kind, kept)));
  return jobs.empty() ? std::nullopt : std::optional{std::move(jobs.front())};
}

Result<void> remove_job(Database& database, std::int64_t number) {
  auto remove = TRY(database.prepare("DELETE FROM job WHERE number = ?"));
  return remove.bind(0, number).run();
}

Result<std::optional<StoredJob>> last_accepted_job(Database& database, JobKind kind) {
  auto query =
      TRY(database.prepare(fmt::format("SELECT {}, result FROM job WHERE kind = ? AND accepted = 1 "
                                       "ORDER BY number DESC LIMIT 1",
                                       kColumns)));
  return read_whole_job(bound(query, kind));
}

Result<std::vector<StoredJob>> unfinished_jobs(Database& database) {
  auto query = TRY(database.prepare(
      fmt::format("SELECT {} FROM job WHERE state IN ({}, {}) ORDER BY number", kColumns,
                  static_cast<int>(JobState::waiting), static_cast<int>(JobState::running))));
  return read_jobs(query);
}

}  // namespace recald::sqlite
