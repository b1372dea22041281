#include "adapters/record/jobs.hpp"

#include <fmt/format.h>

#include <array>
#include <sstream>
#include <utility>

#include "adapters/record/files.hpp"
#include "adapters/record/job_rows.hpp"
#include "adapters/record/values.hpp"

namespace recald::record {
namespace {

using postgres::Array;
using postgres::Connection;
using postgres::integer;
using postgres::Parameter;
using postgres::Rows;

constexpr std::array<std::string_view, 5> kStates{"waiting", "running", "done", "failed",
                                                  "set_aside"};

/// Of `job j JOIN site s`.
constexpr auto kColumns =
    "j.number, s.id, j.version, j.kind, j.month, j.until_seq, extract(epoch FROM j.now)::bigint, "
    "j.input_sha256, j.asked_by, j.state, j.tries, j.worker, j.reason";

/// The last job done before `j`, in the order of the site's jobs. It is looked up once: what is
/// done or corrected later changes nothing for a job that runs again.
constexpr auto kJobBefore =
    "(SELECT b.number FROM job b WHERE b.site = j.site AND b.state = 'done' AND "
    "(b.month, b.until_seq, b.number) < (j.month, j.until_seq, j.number) "
    "ORDER BY b.month DESC, b.until_seq DESC, b.number DESC LIMIT 1)";

Result<FleetJobState> parse_state(std::string_view name) {
  for (std::size_t i = 0; i < kStates.size(); ++i) {
    if (kStates[i] == name) return static_cast<FleetJobState>(i);
  }
  return failure(ErrorCode::malformed, fmt::format("the record has a job in state '{}'", name));
}

/// Columns as in kColumns.
Result<FleetJob> read_job(const Rows& rows, int row) {
  const auto kind = TRY(parse_job_kind(rows.text(row, 3)));
  const auto month = TRY(metering::parse_month(rows.text(row, 4)));
  const auto state = TRY(parse_state(rows.text(row, 9)));
  return FleetJob{.number = rows.integer(row, 0),
                  .site = std::string{rows.text(row, 1)},
                  .site_version = static_cast<int>(rows.integer(row, 2)),
                  .kind = kind,
                  .month = month,
                  .until_seq = rows.integer(row, 5),
                  .now = instant(rows, row, 6),
                  .input_sha256 = std::string{rows.text(row, 7)},
                  .asked_by = std::string{rows.text(row, 8)},
                  .state = state,
                  .tries = static_cast<int>(rows.integer(row, 10)),
                  .worker = std::string{rows.text(row, 11)},
                  .reason = std::string{rows.text(row, 12)}};
}

Result<std::vector<FleetJob>> read_jobs(const Result<Rows>& rows) {
  if (!rows) return tl::unexpected(rows.error());
  std::vector<FleetJob> found;
  for (int i = 0; i < rows->size(); ++i) {
    auto job = TRY(read_job(*rows, i));
    found.push_back(std::move(job));
  }
  return found;
}

/// When a job may be tried again after its last try failed at `from`.
/// @param seconds, from  SQL
std::string next_try(const char* from, const char* seconds) {
  return fmt::format("{} + make_interval(secs => {} * 2 ^ (tries - 1))", from, seconds);
}

/// Jobs whose worker let the lease run out wait again, or are set aside.
Result<void> end_leases(Connection& connection, const LeaseRules& rules) {
  TRY(connection.run(
      fmt::format("UPDATE job SET state = CASE WHEN tries >= $1 THEN 'set_aside' ELSE 'waiting' "
                  "END, ended = CASE WHEN tries >= $1 THEN now() END, not_before = {}, "
                  "reason = format('the lease of %s ran out in try %s of %s: it was ended or lost "
                  "the record', worker, tries, $1) WHERE number IN (SELECT number FROM job WHERE "
                  "state = 'running' AND lease_until < now() ORDER BY number FOR UPDATE SKIP "
                  "LOCKED)",
                  next_try("lease_until", "$2::int")),
      {integer(rules.tries_max), integer(rules.wait_after_try.count())}));
  return {};
}

/// The lease by which a worker has a job, in a statement whose first three parameters are these.
constexpr auto kOwn = "number = $1 AND worker = $2 AND tries = $3 AND state = 'running'";
std::vector<Parameter> own(const FleetJob& job) {
  return {integer(job.number), job.worker, integer(job.tries)};
}

Result<bool> changed(const Result<Rows>& rows) {
  if (!rows) return tl::unexpected(rows.error());
  return rows->affected() > 0;
}

Result<void> put_result(Connection& connection, const FleetJob& job, std::int64_t site,
                        const FleetResult& result) {
  const auto sums = TRY(put_files(connection, result.files));
  const auto put = TRY(connection.run(
      "INSERT INTO result (site, job, kind, month, at, accepted, named, message, summary, sha256) "
      "VALUES ($1, $2, $3, $4, now(), $5, $6, $7, $8, $9) RETURNING number",
      {integer(site), integer(job.number), std::string{recald::name_of(job.kind)},
       metering::to_string(job.month), result.accepted ? "true" : "false",
       result.named ? "true" : "false", text_of(result.message), text_of(result.summary),
       sha256_of(result.files)}));
  for (const auto& [name, sum] : sums) {
    TRY(connection.run("INSERT INTO result_file VALUES ($1, $2, $3)",
                       {integer(put.integer(0, 0)), name, sum}));
  }
  return {};
}

Result<void> put_state(Connection& connection, const FleetJob& job,
                       const std::map<std::string, std::string>& state) {
  const auto sums = TRY(put_files(connection, state));
  TRY(connection.run("DELETE FROM site_state WHERE job = $1", {integer(job.number)}));
  for (const auto& [name, sum] : sums) {
    TRY(connection.run("INSERT INTO site_state VALUES ($1, $2, $3)",
                       {integer(job.number), name, sum}));
  }
  return {};
}

/// What the job's row says, not the caller.
Result<void> put_next(Connection& connection, const FleetJob& job, JobKind kind,
                      const std::string& asked_by) {
  const auto rows = TRY(connection.run(
      "SELECT s.number, j.version, v.sha256 FROM job j JOIN site s ON s.number = j.site "
      "JOIN site_version v ON v.site = j.site AND v.number = j.version WHERE j.number = $1",
      {integer(job.number)}));
  const NewJob next{.input = {.site = job.site,
                              .version_sha256 = std::string{rows.text(0, 2)},
                              .kind = kind,
                              .month = job.month,
                              .until_seq = job.until_seq,
                              .now = job.now},
                    .site = rows.integer(0, 0),
                    .version = static_cast<int>(rows.integer(0, 1)),
                    .asked_by = asked_by};
  TRY(put_jobs(connection, {next}, IfThere::leave));
  return {};
}

struct PresentVersion {
  std::int64_t site = 0;
  int number = 0;
  std::string sha256;
};

/// Of each site that is not retired, by its id.
Result<std::map<std::string, PresentVersion>> present_versions(Connection& connection) {
  const auto rows = TRY(
      connection.run("SELECT s.id, s.number, v.number, v.sha256 FROM site s JOIN site_version v "
                     "ON v.site = s.number AND v.number = s.version WHERE s.retired IS NULL"));
  std::map<std::string, PresentVersion> found;
  for (int i = 0; i < rows.size(); ++i) {
    found.emplace(rows.text(i, 0), PresentVersion{.site = rows.integer(i, 1),
                                                  .number = static_cast<int>(rows.integer(i, 2)),
                                                  .sha256 = std::string{rows.text(i, 3)}});
  }
  return found;
}

JobInput input_of(const FleetJob& job, const PresentVersion& version) {
  return {.site = job.site,
          .version_sha256 = version.sha256,
          .kind = job.kind,
          .month = job.month,
          .until_seq = job.until_seq,
          .now = job.now};
}

}  // namespace

std::string_view name_of(FleetJobState state) {
  return kStates.at(static_cast<std::size_t>(state));
}

Result<std::optional<FleetJob>> lease(Connection& connection, const std::string& worker,
                                      const LeaseRules& rules) {
  std::optional<FleetJob> taken;
  const auto done = connection.transaction([&]() -> Result<void> {
    taken.reset();
    if (auto ended = end_leases(connection, rules); !ended) return ended;
    // What another worker takes at this moment is skipped, and its site is not free either: to us
    // its job waits still. Should a site become busy in between, its index refuses a second job.
    const auto rows = TRY(connection.run(
        fmt::format("UPDATE job j SET state = 'running', tries = tries + 1, worker = $1, "
                    "lease_until = now() + make_interval(secs => $2::int), "
                    "state_of = coalesce(j.state_of, {}, 0) FROM site s "
                    "WHERE s.number = j.site AND j.number = (SELECT w.number FROM job w "
                    "JOIN site t ON t.number = w.site WHERE w.state = 'waiting' AND "
                    "w.not_before <= now() AND t.retired IS NULL AND NOT EXISTS (SELECT 1 FROM job "
                    "o WHERE o.site = w.site AND (o.state = 'running' OR o.state = 'waiting' AND "
                    "(o.month, o.until_seq, o.number) < (w.month, w.until_seq, w.number))) "
                    "ORDER BY w.asked, w.number LIMIT 1 FOR UPDATE OF w SKIP LOCKED) RETURNING {}",
                    kJobBefore, kColumns),
        {worker, integer(rules.lease.count())}));
    if (rows.size() == 0) return {};
    taken = TRY(read_job(rows, 0));
    return {};
  });
  if (!done) return tl::unexpected(done.error());
  return taken;
}

Result<bool> renew(Connection& connection, const FleetJob& job, const LeaseRules& rules) {
  auto parameters = own(job);
  parameters.push_back(integer(rules.lease.count()));
  return changed(connection.run(
      fmt::format("UPDATE job SET lease_until = now() + make_interval(secs => $4::int) WHERE {}",
                  kOwn),
      parameters));
}

Result<bool> finish(Connection& connection, const FleetJob& job, const FleetResult& result) {
  bool is_ours = false;
  TRY(connection.transaction([&]() -> Result<void> {
    is_ours = false;
    const auto ended = TRY(connection.run(
        fmt::format("UPDATE job SET state = 'done', ended = now(), reason = '' WHERE {} "
                    "RETURNING site",
                    kOwn),
        own(job)));
    if (ended.size() == 0) return {};
    is_ours = true;
    if (auto put = put_result(connection, job, ended.integer(0, 0), result); !put) return put;
    if (auto put = put_state(connection, job, result.state); !put) return put;
    return result.next ? put_next(connection, job, *result.next, result.next_asked_by)
                       : Result<void>{};
  }));
  return is_ours;
}

Result<bool> fail(Connection& connection, const FleetJob& job, const std::string& reason) {
  auto parameters = own(job);
  parameters.push_back(text_of(reason));
  return changed(connection.run(
      fmt::format("UPDATE job SET state = 'failed', ended = now(), reason = $4 WHERE {}", kOwn),
      parameters));
}

Result<bool> give_back(Connection& connection, const FleetJob& job, const std::string& reason,
                       const LeaseRules& rules) {
  auto parameters = own(job);
  parameters.push_back(text_of(reason));
  parameters.push_back(integer(rules.tries_max));
  parameters.push_back(integer(rules.wait_after_try.count()));
  return changed(connection.run(
      fmt::format("UPDATE job SET state = CASE WHEN tries >= $5 THEN 'set_aside' ELSE 'waiting' "
                  "END, ended = CASE WHEN tries >= $5 THEN now() END, not_before = {}, reason = $4 "
                  "WHERE {}",
                  next_try("now()", "$6::int"), kOwn),
      parameters));
}

Result<bool> hand_back(Connection& connection, const FleetJob& job) {
  return changed(connection.run(
      fmt::format("UPDATE job SET state = 'waiting', tries = tries - 1 WHERE {}", kOwn), own(job)));
}

Result<std::map<std::string, std::string>> state_before(Connection& connection,
                                                        const FleetJob& job) {
  const auto rows = TRY(connection.run(
      fmt::format(
          "SELECT n.name, f.bytes FROM job j JOIN site_state n ON n.job = "
          "coalesce(j.state_of, {}) JOIN whole_file f ON f.sha256 = n.sha256 WHERE j.number = $1",
          kJobBefore),
      {integer(job.number)}));
  return named_bytes(rows);
}

Result<std::vector<FleetJob>> would_rerun(Connection& connection, const RerunWhat& what) {
  Array sites;
  for (const std::string& site : what.sites) sites.add(site);
  Parameter state, kind, month;
  if (what.state) state = name_of(*what.state);
  if (what.kind) kind = recald::name_of(*what.kind);
  if (what.month) month = metering::to_string(*what.month);
  // Of a month that was corrected only the newest: the others are what it was then.
  auto found = read_jobs(connection.run(
      fmt::format("SELECT {} FROM (SELECT DISTINCT ON (site, kind, month) * FROM job WHERE "
                  "($3::text IS NULL OR kind = $3) ORDER BY site, kind, month, until_seq DESC, "
                  "number DESC) j JOIN site s ON s.number = j.site WHERE s.retired IS NULL AND "
                  "($1::text[] = '{{}}' OR s.id = ANY($1::text[])) AND "
                  "($2::text IS NULL OR j.state = $2) AND j.state NOT IN ('waiting', 'running') "
                  "AND j.month = coalesce($4::text, (SELECT max(x.month) FROM job x WHERE "
                  "x.site = j.site AND ($3::text IS NULL OR x.kind = $3))) "
                  "ORDER BY s.id, j.month, j.until_seq, j.number",
                  kColumns),
      {sites.parameter(), state, kind, month}));
  if (!found) return found;
  const auto versions = TRY(present_versions(connection));
  for (FleetJob& job : *found) {
    const PresentVersion& version = versions.at(job.site);
    job.site_version = version.number;
    job.input_sha256 = input_of(job, version).sha256();
  }
  return found;
}

Result<int> rerun(Connection& connection, const std::vector<FleetJob>& jobs,
                  const std::string& who) {
  int count = 0;
  const auto done = connection.transaction([&]() -> Result<void> {
    const auto versions = TRY(present_versions(connection));
    std::vector<NewJob> again;
    Array subjects, texts;
    for (const FleetJob& job : jobs) {
      const auto version = versions.find(job.site);
      if (version == versions.end()) continue;  // retired meanwhile
      again.push_back({.input = input_of(job, version->second),
                       .site = version->second.site,
                       .version = version->second.number,
                       .asked_by = "rerun"});
      subjects.add(job.site);
      texts.add(fmt::format("{} of {}", recald::name_of(job.kind), metering::to_string(job.month)));
    }
    count = TRY(put_jobs(connection, again, IfThere::run_again));
    TRY(
        connection.run("INSERT INTO audit (who, action, subject, text) SELECT $1, 'rerun', * "
                       "FROM unnest($2::text[], $3::text[])",
                       {who, subjects.parameter(), texts.parameter()}));
    return {};
  });
  if (!done) return tl::unexpected(done.error());
  return count;
}

Result<std::vector<FleetJob>> jobs(Connection& connection, const std::string& site, int limit) {
  return read_jobs(
      connection.run(fmt::format("SELECT {} FROM job j JOIN site s ON s.number = j.site "
                                 "WHERE ($1 = '' OR s.id = $1) ORDER BY j.number DESC LIMIT $2",
                                 kColumns),
                     {site, integer(limit)}));
}

Result<std::vector<FleetJob>> troubled_jobs(Connection& connection) {
  Array kinds;
  for (const JobKind kind : {JobKind::calibration, JobKind::diagnosis}) {
    kinds.add(std::string{recald::name_of(kind)});
  }
  return read_jobs(connection.run(
      fmt::format("SELECT {} FROM site s CROSS JOIN unnest($1::text[]) k (kind) "
                  "CROSS JOIN LATERAL (SELECT * FROM job n WHERE n.site = s.number AND "
                  "n.kind = k.kind ORDER BY n.number DESC LIMIT 1) j WHERE s.retired IS NULL AND "
                  "j.state IN ('failed', 'set_aside') ORDER BY s.id, j.kind",
                  kColumns),
      {kinds.parameter()}));
}

Result<std::map<FleetJobState, std::int64_t>> job_counts(Connection& connection) {
  const auto rows = TRY(connection.run("SELECT state, count(*) FROM job GROUP BY state"));
  std::map<FleetJobState, std::int64_t> counts;
  for (int i = 0; i < rows.size(); ++i) {
    const auto state = TRY(parse_state(rows.text(i, 0)));
    counts[state] = rows.integer(i, 1);
  }
  return counts;
}

Result<std::vector<FleetResultRow>> newest_results(Connection& connection, JobKind kind,
                                                   const std::string& site) {
  // A gateway's summary is its whole document, which no list needs.
  const auto rows = TRY(connection.run(
      "SELECT s.id, r.month, r.job IS NULL, extract(epoch FROM r.at)::bigint, r.accepted, r.named, "
      "r.message, CASE WHEN r.job IS NULL THEN '' ELSE r.summary END, "
      "coalesce((SELECT input_sha256 FROM job WHERE number = r.job), ''), r.sha256, "
      "(SELECT string_agg(name, chr(10) ORDER BY name) FROM result_file WHERE result = r.number) "
      "FROM site s CROSS JOIN LATERAL (SELECT * FROM result n WHERE n.site = s.number AND "
      "n.kind = $1 ORDER BY n.job IS NULL, n.month DESC, n.number DESC LIMIT 1) r "
      "WHERE s.retired IS NULL AND ($2 = '' OR s.id = $2) ORDER BY s.id",
      {std::string{recald::name_of(kind)}, site}));
  std::vector<FleetResultRow> found;
  for (int i = 0; i < rows.size(); ++i) {
    const auto month = TRY(metering::parse_month(rows.text(i, 1)));
    FleetResultRow row{.site = std::string{rows.text(i, 0)},
                       .kind = kind,
                       .month = month,
                       .from = rows.boolean(i, 2) ? "gateway" : "worker",
                       .at = instant(rows, i, 3),
                       .accepted = rows.boolean(i, 4),
                       .named = rows.boolean(i, 5),
                       .message = std::string{rows.text(i, 6)},
                       .summary = std::string{rows.text(i, 7)},
                       .input_sha256 = std::string{rows.text(i, 8)},
                       .sha256 = std::string{rows.text(i, 9)},
                       .files = {}};
    std::istringstream names{std::string{rows.text(i, 10)}};
    for (std::string name; std::getline(names, name);) row.files.push_back(name);
    found.push_back(std::move(row));
  }
  return found;
}

Result<std::string> result_file(Connection& connection, const std::string& site, JobKind kind,
                                metering::Month month, const std::string& name) {
  const auto rows = TRY(connection.run(
      "SELECT f.bytes FROM result r JOIN site s ON s.number = r.site "
      "JOIN result_file n ON n.result = r.number JOIN whole_file f ON f.sha256 = n.sha256 "
      "WHERE s.id = $1 AND r.kind = $2 AND r.month = $3 AND n.name = $4 "
      "ORDER BY r.number DESC LIMIT 1",
      {site, std::string{recald::name_of(kind)}, metering::to_string(month), name}));
  if (rows.size() > 0) return rows.bytes(0, 0);
  return failure(ErrorCode::not_found,
                 fmt::format("the record has no {} of the {} of {} in {}", name,
                             recald::name_of(kind), site, metering::to_string(month)));
}

}  // namespace recald::record
