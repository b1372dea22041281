#include "adapters/sqlite/schema.hpp"

#include <fmt/format.h>

#include <array>

namespace recald::sqlite {
namespace {

constexpr std::int64_t kApplicationId = 0x52434C44;  // "RCLD", in the file's header

/// One text a version: from the version before to this one.
constexpr std::array<const char*, kSchemaVersion> kUpgrades{
    R"sql(
CREATE TABLE meter (
  number     INTEGER PRIMARY KEY,
  id         TEXT    NOT NULL UNIQUE,
  interval_s INTEGER NOT NULL CHECK (interval_s > 0)
) STRICT;

CREATE TABLE interval (
  meter    INTEGER NOT NULL REFERENCES meter (number),
  t_start  INTEGER NOT NULL CHECK (t_start % 60 = 0),
  revision INTEGER NOT NULL CHECK (revision >= 0),
  mean_kW  REAL,
  validity INTEGER NOT NULL CHECK (validity BETWEEN 0 AND 4),
  late     INTEGER NOT NULL CHECK (late IN (0, 1)),
  reasons  INTEGER NOT NULL,
  PRIMARY KEY (meter, t_start, revision)
) STRICT, WITHOUT ROWID;

CREATE TABLE register (
  meter INTEGER NOT NULL REFERENCES meter (number),
  field TEXT    NOT NULL,
  state TEXT    NOT NULL,
  PRIMARY KEY (meter, field)
) STRICT, WITHOUT ROWID;

CREATE TABLE sample (
  meter INTEGER NOT NULL REFERENCES meter (number),
  t     INTEGER NOT NULL,
  field TEXT    NOT NULL,
  value REAL,
  PRIMARY KEY (meter, t, field)
) STRICT, WITHOUT ROWID;

CREATE TABLE month (
  meter                      INTEGER NOT NULL REFERENCES meter (number),
  month                      TEXT    NOT NULL,
  revision                   INTEGER NOT NULL CHECK (revision >= 0),
  closed_at                  INTEGER NOT NULL,
  tzdata                     TEXT    NOT NULL,
  daily_average_kWh          REAL,
  daily_average_variance     REAL,
  peak_kW                    REAL,
  peak_at                    INTEGER,
  peak_could_be_exceeded     INTEGER,
  peak_window_s              INTEGER NOT NULL,
  coverage                   REAL    NOT NULL,
  filled_share               REAL    NOT NULL,
  slots_ok                   INTEGER NOT NULL,
  slots_missing              INTEGER NOT NULL,
  slots_filled               INTEGER NOT NULL,
  slots_scaled               INTEGER NOT NULL,
  slots_suspect              INTEGER NOT NULL,
  slots                      INTEGER NOT NULL,
  unusable_because           TEXT,
  reasons                    INTEGER NOT NULL,
  PRIMARY KEY (meter, month, revision)
) STRICT, WITHOUT ROWID;

CREATE TABLE reopened (
  meter INTEGER NOT NULL REFERENCES meter (number),
  month TEXT    NOT NULL,
  PRIMARY KEY (meter, month)
) STRICT, WITHOUT ROWID;

CREATE TABLE event (
  number   INTEGER PRIMARY KEY,
  t        INTEGER NOT NULL,
  severity INTEGER NOT NULL CHECK (severity BETWEEN 0 AND 2),
  kind     TEXT    NOT NULL,
  subject  TEXT    NOT NULL,
  text     TEXT    NOT NULL
) STRICT;
CREATE INDEX event_by_time ON event (t);
)sql",
    R"sql(
CREATE TABLE job (
  number   INTEGER PRIMARY KEY AUTOINCREMENT,
  kind     INTEGER NOT NULL CHECK (kind BETWEEN 0 AND 1),
  state    INTEGER NOT NULL CHECK (state BETWEEN 0 AND 4),
  asked_by TEXT    NOT NULL,
  asked    INTEGER NOT NULL,
  started  INTEGER,
  ended    INTEGER,
  accepted INTEGER NOT NULL CHECK (accepted IN (0, 1)),
  message  TEXT    NOT NULL,
  folder   TEXT    NOT NULL,
  result   TEXT    NOT NULL
) STRICT;
CREATE INDEX job_by_state ON job (state);

CREATE TABLE edit (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  t      INTEGER NOT NULL,
  author TEXT    NOT NULL,
  reason TEXT    NOT NULL CHECK (reason <> ''),
  file   TEXT    NOT NULL,
  sha256 TEXT    NOT NULL
) STRICT;
ALTER TABLE interval ADD COLUMN edit INTEGER REFERENCES edit (number);
)sql",
    R"sql(
CREATE TABLE forecast (
  number        INTEGER PRIMARY KEY AUTOINCREMENT,
  output        TEXT    NOT NULL,
  month         TEXT    NOT NULL,
  revision      INTEGER NOT NULL,
  model_version TEXT    NOT NULL,
  data_revision TEXT    NOT NULL,
  made          INTEGER NOT NULL,
  mean          REAL    NOT NULL,
  sd            REAL    NOT NULL,
  q05           REAL    NOT NULL,
  q50           REAL    NOT NULL,
  q95           REAL    NOT NULL,
  measured      REAL    NOT NULL,
  pit           REAL    NOT NULL,
  standardised  REAL    NOT NULL,
  log_score     REAL    NOT NULL,
  crps          REAL    NOT NULL,
  UNIQUE (output, month, revision)
) STRICT;
)sql",
    R"sql(
CREATE TABLE closing (
  meter INTEGER PRIMARY KEY REFERENCES meter (number),
  rules TEXT    NOT NULL
) STRICT;
)sql",
    R"sql(
ALTER TABLE event ADD COLUMN count INTEGER NOT NULL DEFAULT 1 CHECK (count > 0);
ALTER TABLE event ADD COLUMN last INTEGER;
ALTER TABLE job ADD COLUMN tries INTEGER NOT NULL DEFAULT 0;
ALTER TABLE meter ADD COLUMN sum INTEGER;
ALTER TABLE edit ADD COLUMN sum INTEGER;
ALTER TABLE interval ADD COLUMN sum INTEGER;
ALTER TABLE register ADD COLUMN sum INTEGER;
ALTER TABLE sample ADD COLUMN sum INTEGER;
ALTER TABLE month ADD COLUMN sum INTEGER;
ALTER TABLE event ADD COLUMN sum INTEGER;
ALTER TABLE job ADD COLUMN sum INTEGER;
ALTER TABLE forecast ADD COLUMN sum INTEGER;
)sql"};

Result<std::int64_t> ask(Database& database, std::string_view sql) {
  auto statement = database.prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  const auto row = statement->step();
  if (!row) return tl::unexpected(row.error());
  const std::int64_t value = *row ? statement->integer(0) : 0;
  statement->reset();
  return value;
}

}  // namespace

Result<int> schema_version(Database& database) {
  const auto version = ask(database, "PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  const auto application = ask(database, "PRAGMA application_id");
  if (!application) return tl::unexpected(application.error());
  const auto tables = ask(database, "SELECT count(*) FROM sqlite_schema");
  if (!tables) return tl::unexpected(tables.error());
  // With our tables in it the mark was damaged.
  const auto ours =
      ask(database, "SELECT count(*) FROM sqlite_schema WHERE name IN ('interval', 'sample')");
  if (!ours) return tl::unexpected(ours.error());
  if (*tables > 0 && *application != kApplicationId && *ours < 2) {
    return failure(ErrorCode::unsupported,
                   "the store file is a database of another program; name another file");
  }
  if (*version > kSchemaVersion) {
    return failure(
        ErrorCode::unsupported,
        fmt::format("the store file has schema version {}, this recald knows {}; use the "
                    "newer recald that wrote it, or a backup from before",
                    *version, kSchemaVersion));
  }
  return static_cast<int>(*version);
}

Result<void> bring_up_to_date(Database& database) {
  const auto version = schema_version(database);
  if (!version) return tl::unexpected(version.error());
  for (auto next = static_cast<std::size_t>(*version); next < kUpgrades.size(); ++next) {
    const std::string text = fmt::format("{}PRAGMA application_id={};PRAGMA user_version={};",
                                         kUpgrades[next], kApplicationId, next + 1);
    const auto upgraded = database.transaction([&] { return database.execute(text); });
    if (!upgraded) return upgraded;
  }
  return {};
}

Result<void> require_current(Database& database) {
  const auto version = schema_version(database);
  if (!version) return tl::unexpected(version.error());
  if (*version == kSchemaVersion) return {};
  return failure(ErrorCode::unsupported,
                 fmt::format("the store file has schema version {}, this recald reads {}; the "
                             "daemon brings it up to date when it starts",
                             *version, kSchemaVersion));
}

}  // namespace recald::sqlite
