#include "adapters/record/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace recald::record {
namespace {

using metering::Instant;

/// Whoever makes tables or partitions has this lock (pg_advisory_xact_lock).
constexpr auto kLock = 0x7265'6361;

constexpr std::chrono::year kYear_first{2000};
constexpr std::chrono::year kYear_last = metering::kLastKnownYear;

/// Months are text, "2024-03", so that they are the same in every place.
constexpr auto kTables = R"(
CREATE TABLE fleet (
  schema_version int NOT NULL,
  made timestamptz NOT NULL DEFAULT now());
CREATE TABLE audit (
  number bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  time timestamptz NOT NULL,
  who text NOT NULL,
  action text NOT NULL,
  subject text NOT NULL,
  text text NOT NULL);
CREATE TABLE file (
  sha256 text COLLATE "C" PRIMARY KEY,
  bytes bytea);  -- absent: in parts
CREATE TABLE file_part (
  sha256 text COLLATE "C" NOT NULL REFERENCES file,  -- of the whole
  place int NOT NULL,
  part text COLLATE "C" NOT NULL REFERENCES file,
  PRIMARY KEY (sha256, place));
CREATE VIEW whole_file AS SELECT f.sha256, coalesce(f.bytes,
  (SELECT string_agg(p.bytes, '' ORDER BY q.place) FROM file_part q JOIN file p ON p.sha256 = q.part
  WHERE q.sha256 = f.sha256)) AS bytes FROM file f;
CREATE TABLE site (
  number int GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  id text COLLATE "C" NOT NULL UNIQUE,
  version int NOT NULL,
  added timestamptz NOT NULL,
  retired timestamptz,
  heard timestamptz,
  newest timestamptz,
  seq bigint NOT NULL DEFAULT 0,
  event_seq bigint NOT NULL DEFAULT 0) WITH (fillfactor = 70);
CREATE TABLE site_version (
  site int NOT NULL REFERENCES site,
  number int NOT NULL,
  sha256 text NOT NULL,
  description jsonb NOT NULL,
  added timestamptz NOT NULL DEFAULT now(),
  by text NOT NULL,
  PRIMARY KEY (site, number));
CREATE TABLE site_file (
  site int NOT NULL,
  number int NOT NULL,
  name text COLLATE "C" NOT NULL,
  sha256 text COLLATE "C" NOT NULL REFERENCES file,
  PRIMARY KEY (site, number, name),
  FOREIGN KEY (site, number) REFERENCES site_version);
CREATE TABLE source (
  number bigint GENERATED ALWAYS AS IDENTITY,
  site int NOT NULL REFERENCES site,
  outbox bigint NOT NULL,
  entries bigint NOT NULL,
  events bigint NOT NULL,
  results bigint NOT NULL,
  begun timestamptz NOT NULL,
  PRIMARY KEY (site, outbox)) WITH (fillfactor = 70);
CREATE TABLE meter (
  site int NOT NULL REFERENCES site,
  number smallint NOT NULL,
  id text COLLATE "C" NOT NULL,
  interval_s int NOT NULL,
  PRIMARY KEY (site, number),
  UNIQUE (site, id, interval_s));
CREATE TABLE interval (
  t_start timestamptz NOT NULL,
  seq bigint NOT NULL,
  mean_kw float8,
  site int NOT NULL,
  reasons bigint NOT NULL,
  meter smallint NOT NULL,
  validity smallint NOT NULL,
  late boolean NOT NULL,
  PRIMARY KEY (site, meter, t_start, seq)) PARTITION BY RANGE (t_start);
CREATE INDEX interval_time ON interval USING brin (t_start);
CREATE TABLE month (
  site int NOT NULL,
  meter smallint NOT NULL,
  month text COLLATE "C" NOT NULL,
  seq bigint NOT NULL,
  figure jsonb NOT NULL,
  closed_at timestamptz NOT NULL,
  time_zone_release text NOT NULL,
  PRIMARY KEY (site, month, meter, seq),
  FOREIGN KEY (site, meter) REFERENCES meter);
CREATE TABLE event (
  site int NOT NULL REFERENCES site,
  number bigint NOT NULL,
  time timestamptz NOT NULL,
  severity smallint NOT NULL,
  kind text NOT NULL,
  subject text NOT NULL,
  text text NOT NULL,
  count int NOT NULL,
  last timestamptz,
  PRIMARY KEY (site, number));
CREATE TABLE job (
  number bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  site int NOT NULL REFERENCES site,
  version int NOT NULL,
  kind text COLLATE "C" NOT NULL,
  month text COLLATE "C" NOT NULL,
  until_seq bigint NOT NULL,
  now timestamptz NOT NULL,
  input_sha256 text COLLATE "C" NOT NULL UNIQUE,
  asked_by text NOT NULL,
  state_of bigint,  -- the job whose site_state this one begins with; 0: none; absent: not leased yet
  state text COLLATE "C" NOT NULL DEFAULT 'waiting',
  tries int NOT NULL DEFAULT 0,
  lease_until timestamptz,
  not_before timestamptz NOT NULL DEFAULT now(),
  worker text NOT NULL DEFAULT '',
  reason text NOT NULL DEFAULT '',
  asked timestamptz NOT NULL DEFAULT now(),
  ended timestamptz,
  FOREIGN KEY (site, version) REFERENCES site_version) WITH (fillfactor = 70);
CREATE UNIQUE INDEX job_running ON job (site) WHERE state = 'running';
CREATE INDEX job_waiting ON job (asked, number) WHERE state = 'waiting';
CREATE INDEX job_unfinished ON job (site, month, until_seq, number)
  WHERE state IN ('waiting', 'running');
CREATE INDEX job_order ON job (site, month, until_seq, number);
CREATE INDEX job_newest ON job (site, kind, number);
CREATE TABLE result (
  number bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  site int NOT NULL REFERENCES site,
  job bigint REFERENCES job,
  kind text COLLATE "C" NOT NULL,
  month text COLLATE "C" NOT NULL,
  at timestamptz NOT NULL,
  accepted boolean NOT NULL,
  named boolean NOT NULL,
  message text NOT NULL,
  summary text NOT NULL,
  sha256 text NOT NULL);
CREATE INDEX result_newest ON result (site, kind, (job IS NULL), month DESC, number DESC);
CREATE TABLE result_file (
  result bigint NOT NULL REFERENCES result,
  name text COLLATE "C" NOT NULL,
  sha256 text COLLATE "C" NOT NULL REFERENCES file,
  PRIMARY KEY (result, name));
CREATE TABLE site_state (
  job bigint NOT NULL REFERENCES job,
  name text COLLATE "C" NOT NULL,
  sha256 text COLLATE "C" NOT NULL REFERENCES file,
  PRIMARY KEY (job, name));
)";

/// Ingesters own no tables, so the owner's function makes partitions for them. Attached, a
/// partition keeps nobody from writing to the others meanwhile.
constexpr auto kPartitions = R"(
CREATE FUNCTION recald_make_partition(name text, first timestamptz, beyond timestamptz) RETURNS void
LANGUAGE plpgsql SECURITY DEFINER SET search_path FROM CURRENT SET timezone = 'UTC' AS $$
BEGIN
  PERFORM pg_advisory_xact_lock({0});
  IF name !~ '^interval_[a-z0-9_]+$' OR to_regclass(name) IS NOT NULL THEN
    RETURN;
  END IF;
  EXECUTE format('CREATE TABLE %I (LIKE interval INCLUDING ALL)', name);
  EXECUTE format('ALTER TABLE interval ATTACH PARTITION %I FOR VALUES FROM (%s) TO (%s)', name,
    coalesce(quote_literal(first), 'MINVALUE'), coalesce(quote_literal(beyond), 'MAXVALUE'));
END $$;
REVOKE EXECUTE ON FUNCTION recald_make_partition FROM PUBLIC;
SELECT recald_make_partition('interval_before', NULL, '{1:04}-01-01');
SELECT recald_make_partition('interval_beyond', '{2:04}-01-01', NULL);
)";

/// What a later version of the tables changed: the first makes version 2 of version 1. New tables
/// go through all of them, too.
constexpr auto kUpgrades = std::to_array<const char*>({
    // Whoever may write the audit can claim any name in `who`. The server fills in `role`, and
    // nobody's grants have it; of earlier rows it is not known.
    "ALTER TABLE audit ADD COLUMN role text NOT NULL DEFAULT '';"
    "ALTER TABLE audit ALTER COLUMN role SET DEFAULT session_user;"
    "ALTER TABLE audit ALTER COLUMN time SET DEFAULT now();"
    // Years were known to 2037 only.
    "ALTER TABLE interval DETACH PARTITION interval_beyond;"
    "ALTER TABLE interval_beyond RENAME TO interval_beyond_2037;"
    "SELECT recald_make_partition('interval_beyond', '2101-01-01', NULL);"
    "INSERT INTO interval SELECT * FROM interval_beyond_2037;"
    "DROP TABLE interval_beyond_2037",
});
static_assert(kUpgrades.size() + 1 == kSchemaVersion);

struct Role {
  const char* name;
  const char* grants;
};
/// What a leaked password of an ingester is good for: rows as gateways send them. It names no site,
/// changes no version, reads no file of one, and gives no result for a worker's. A worker's row in
/// the audit says whose it is and when it came. What an earlier release granted is taken back.
constexpr auto kRoles = std::to_array<Role>({
    {"recald_ingest",
     "REVOKE ALL ON ALL TABLES IN SCHEMA {schema} FROM recald_ingest;"
     "GRANT SELECT ON fleet, site, site_version, source, meter, interval, month, event, result, "
     "job "
     "TO recald_ingest;"
     "GRANT INSERT ON source, meter, interval, month, event TO recald_ingest;"
     "GRANT INSERT (site, kind, month, at, accepted, named, message, summary, sha256) ON result "
     "TO recald_ingest;"
     "GRANT INSERT (site, version, kind, month, until_seq, now, input_sha256, asked_by) ON job "
     "TO recald_ingest;"
     "GRANT UPDATE (heard, seq, event_seq, newest) ON site TO recald_ingest;"
     "GRANT UPDATE (outbox, entries, events, results) ON source TO recald_ingest;"
     "GRANT EXECUTE ON FUNCTION recald_make_partition TO recald_ingest"},
    {"recald_worker",
     "REVOKE ALL ON ALL TABLES IN SCHEMA {schema} FROM recald_worker;"
     "GRANT SELECT ON ALL TABLES IN SCHEMA {schema} TO recald_worker;"
     "GRANT INSERT ON job, result, result_file, site_state, file, file_part TO recald_worker;"
     "GRANT INSERT (who, action, subject, text) ON audit TO recald_worker;"
     "GRANT UPDATE ON job TO recald_worker;"
     "GRANT DELETE ON site_state TO recald_worker"},
    {"recald_read", "GRANT SELECT ON ALL TABLES IN SCHEMA {schema} TO recald_read"},
});

/// 0: there are no tables.
Result<int> version_of(postgres::Connection& connection) {
  const auto has_any = TRY(connection.run("SELECT to_regclass('fleet') IS NOT NULL"));
  if (!has_any.boolean(0, 0)) return 0;
  const auto version = TRY(connection.run("SELECT schema_version FROM fleet"));
  return version.size() == 1 ? static_cast<int>(version.integer(0, 0)) : 0;
}

Error newer(int version) {
  return {
      ErrorCode::unsupported,
      fmt::format("the record has schema {}, and this recald knows {}: use the recald that made "
                  "it, or a newer one",
                  version, kSchemaVersion)};
}

/// Version 1.
Result<void> make_tables(postgres::Connection& connection) {
  TRY(connection.run_all(kTables));
  TRY(connection.run_all(fmt::format(fmt::runtime(kPartitions), kLock,
                                     static_cast<int>(kYear_first),
                                     static_cast<int>(kYear_last) + 1)));
  return connection.run_all("INSERT INTO fleet VALUES (1)");
}

Result<void> upgrade(postgres::Connection& connection, int version) {
  for (; version < kSchemaVersion; ++version) {
    TRY(connection.run_all(kUpgrades[static_cast<std::size_t>(version - 1)]));
    TRY(connection.run_all(fmt::format("UPDATE fleet SET schema_version = {}", version + 1)));
  }
  return {};
}

/// Each role by itself: without the right to make one, the others may be there.
Result<std::string> grant_roles(postgres::Connection& connection) {
  const auto schema = TRY(connection.run("SELECT quote_ident(current_schema())"));
  std::string left_out;
  for (const Role& role : kRoles) {
    const auto known = TRY(
        connection.run("SELECT EXISTS (SELECT 1 FROM pg_roles WHERE rolname = $1)", {role.name}));
    // Two at once would change the same rows of the catalogue.
    const std::string statements =
        fmt::format("SELECT pg_advisory_xact_lock({}); {}{}", kLock,
                    known.boolean(0, 0) ? "" : fmt::format("CREATE ROLE {}; ", role.name),
                    fmt::format(fmt::runtime(role.grants), fmt::arg("schema", schema.text(0, 0))));
    const auto done = connection.run_all(statements);
    if (done) continue;
    if (done.error().code != ErrorCode::malformed) return tl::unexpected(done.error());
    left_out += fmt::format("{}the role {} has no rights here: {}", left_out.empty() ? "" : "; ",
                            role.name, done.error().message);
  }
  return left_out;
}

}  // namespace

Result<std::string> make_schema(postgres::Connection& connection) {
  TRY(connection.transaction([&]() -> Result<void> {
    if (auto locked = connection.run_all(fmt::format("SELECT pg_advisory_xact_lock({})", kLock));
        !locked) {
      return locked;
    }
    const auto version = TRY(version_of(connection));
    if (version > kSchemaVersion) return tl::unexpected(newer(version));
    if (version == 0) TRY(make_tables(connection));
    return upgrade(connection, std::max(version, 1));
  }));
  return grant_roles(connection);
}

Result<void> check_schema(postgres::Connection& connection) {
  const auto version = TRY(version_of(connection));
  if (version == kSchemaVersion) return {};
  if (version > kSchemaVersion) return tl::unexpected(newer(version));
  if (version > 0) {
    return failure(ErrorCode::unsupported,
                   fmt::format("the record has schema {}, and this recald needs {}: bring it up to "
                               "date with recald fleet init",
                               version, kSchemaVersion));
  }
  return failure(ErrorCode::unsupported,
                 "the database has no record of a fleet yet: make it with recald fleet init");
}

std::string partition_of(Instant start) {
  const std::chrono::year_month_day day{std::chrono::floor<std::chrono::days>(start)};
  if (day.year() < kYear_first) return "interval_before";
  if (day.year() > kYear_last) return "interval_beyond";
  return fmt::format("interval_{:04}_{:02}", static_cast<int>(day.year()),
                     static_cast<unsigned>(day.month()));
}

Result<void> make_partitions(postgres::Connection& connection, const metering::TimeSpan& span) {
  using std::chrono::year_month_day;
  const auto month_of = [](Instant t) {
    const year_month_day day{std::chrono::floor<std::chrono::days>(t)};
    return std::clamp(day.year() / day.month(), kYear_first / std::chrono::January,
                      kYear_last / std::chrono::December);
  };
  if (span.begin >= span.end) return {};
  const auto last = month_of(span.end - std::chrono::seconds{1});
  for (auto month = month_of(span.begin); month <= last; month += std::chrono::months{1}) {
    const Instant first = std::chrono::sys_days{month / 1};
    const Instant beyond = std::chrono::sys_days{(month + std::chrono::months{1}) / 1};
    const auto made = connection.run(
        "SELECT recald_make_partition($1, $2, $3) WHERE to_regclass($1) IS NULL",
        {partition_of(first), metering::to_string(first), metering::to_string(beyond)});
    if (made) continue;
    // Somebody else may have made it at the same moment.
    const auto is_there =
        connection.run("SELECT to_regclass($1) IS NOT NULL", {partition_of(first)});
    if (!is_there || !is_there->boolean(0, 0)) return tl::unexpected(made.error());
  }
  return {};
}

}  // namespace recald::record
