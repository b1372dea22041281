#include "adapters/sqlite/job_table.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/results/job_result_json.hpp"
#include "adapters/sqlite/tables.hpp"

namespace recald::sqlite {
namespace {

using metering::Instant;

constexpr auto kColumns =
    "number, kind, state, asked_by, asked, started, ended, accepted, message, folder, tries";

void bind_instant(Statement& statement, int parameter, const std::optional<Instant>& t) {
  if (t) {
    statement.bind(parameter, std::int64_t{t->time_since_epoch().count()});
  } else {
    statement.bind_null(parameter);
  }
}

std::optional<Instant> instant_at(const Statement& row, int column) {
  if (row.is_null(column)) return {};
  return Instant{std::chrono::seconds{row.integer(column)}};
}

/// Binds parameters 0 to 10: all of a job except its number.
void bind_job(Statement& statement, const StoredJob& job) {
  statement.bind(0, static_cast<std::int64_t>(job.kind))
      .bind(1, static_cast<std::int64_t>(job.state))
      .bind(2, std::string_view{job.asked_by})
      .bind(3, std::int64_t{job.asked.time_since_epoch().count()});
  bind_instant(statement, 4, job.started);
  bind_instant(statement, 5, job.ended);
  statement.bind(6, std::int64_t{job.accepted})
      .bind(7, std::string_view{job.message})
      .bind(8, std::string_view{job.folder})
      .bind(9, std::string_view{job.result.document})
      .bind(10, std::int64_t{job.tries});
}

/// Reads columns as in `kColumns`.
StoredJob read_job(const Statement& row) {
  StoredJob job{.number = row.integer(0),
                .kind = static_cast<JobKind>(row.integer(1)),
                .state = static_cast<JobState>(row.integer(2)),
                .asked_by = row.text(3),
                .asked = Instant{std::chrono::seconds{row.integer(4)}},
                .started = instant_at(row, 5),
                .ended = instant_at(row, 6)};
  job.accepted = row.integer(7) != 0;
  job.message = row.text(8);
  job.folder = row.text(9);
  job.tries = static_cast<int>(row.integer(10));
  return job;
}

Result<std::vector<StoredJob>> read_jobs(Statement& query) {
  std::vector<StoredJob> jobs;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return jobs;
    jobs.push_back(read_job(query));
  }
}

/// Reads the row of a query for `kColumns` and the result.
Result<std::optional<StoredJob>> read_whole_job(Statement& query) {
  const auto row = TRY(query.step());
  if (!row) return std::optional<StoredJob>{};
  StoredJob job = read_job(query);
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
  bind_job(insert, job);
  TRY(insert.step());
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
  bind_job(update, job);
  const auto row = TRY(update.bind(11, job.number).step());
  if (!row) {
    return failure(ErrorCode::not_found, fmt::format("there is no job {}", job.number));
  }
  return update.run();
}

Result<std::optional<StoredJob>> find_job(Database& database, std::int64_t number) {
  auto query =
      TRY(database.prepare(fmt::format("SELECT {}, result FROM job WHERE number = ?", kColumns)));
  query.bind(0, number);
  return read_whole_job(query);
}

Result<std::vector<StoredJob>> newest_jobs(Database& database, JobKind kind, int limit) {
  auto query = TRY(database.prepare(
      fmt::format("SELECT {} FROM job WHERE kind = ? ORDER BY number DESC LIMIT ?", kColumns)));
  query.bind(0, static_cast<std::int64_t>(kind)).bind(1, std::int64_t{limit});
  return read_jobs(query);
}

Result<std::optional<StoredJob>> oldest_finished_job_beyond(Database& database, JobKind kind,
                                                            int kept) {
  auto query = TRY(database.prepare(fmt::format(
      "SELECT {} FROM job WHERE kind = ?1 AND ended IS NOT NULL AND number < "
      "(SELECT number FROM job WHERE kind = ?1 AND ended IS NOT NULL ORDER BY number DESC "
      "LIMIT 1 OFFSET ?2 - 1) AND number <> coalesce((SELECT max(number) FROM job WHERE kind = ?1 "
      "AND accepted = 1), 0) ORDER BY number LIMIT 1",
      kColumns)));
  query.bind(0, static_cast<std::int64_t>(kind)).bind(1, std::int64_t{kept});
  auto jobs = TRY(read_jobs(query));
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
  query.bind(0, static_cast<std::int64_t>(kind));
  return read_whole_job(query);
}

Result<std::vector<StoredJob>> unfinished_jobs(Database& database) {
  auto query = TRY(database.prepare(
      fmt::format("SELECT {} FROM job WHERE state IN ({}, {}) ORDER BY number", kColumns,
                  static_cast<int>(JobState::waiting), static_cast<int>(JobState::running))));
  return read_jobs(query);
}

}  // namespace recald::sqlite
