#include "adapters/sqlite/tables/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace recald::sqlite {
namespace {

constexpr std::int64_t kApplicationId = 0x52434C44;  // "RCLD", in the file's header

/// One text per version: the step from the version before. Each changes tables or indexes.
/// Never edit one afterwards, not even its spaces: a file's tables are compared with what
/// these texts create.
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
)sql",
    R"sql(
CREATE TABLE cursor (
  destination TEXT    NOT NULL PRIMARY KEY,
  position    INTEGER NOT NULL CHECK (position >= 0),
  sum         INTEGER
) STRICT, WITHOUT ROWID;
)sql",
    R"sql(
CREATE TABLE outbox (
  number   INTEGER PRIMARY KEY,
  meter    INTEGER NOT NULL REFERENCES meter (number),
  t_start  INTEGER,
  month    TEXT,
  revision INTEGER NOT NULL,
  sum      INTEGER,
  CHECK ((t_start IS NULL) <> (month IS NULL))
) STRICT;
)sql"};

Result<std::int64_t> ask(Database& database, std::string_view sql) {
  auto statement = TRY(database.prepare(sql));
  const auto row = TRY(statement.step());
  const std::int64_t value = row ? statement.integer(0) : 0;
  statement.reset();
  return value;
}

/// For each entry of a file, such as "table interval": its table, and the SQL that created it.
using SchemaTexts = std::map<std::string, std::string>;

Result<SchemaTexts> schema_of(Database& database) {
  auto query = TRY(database.prepare(
      "SELECT type || ' ' || name, tbl_name || ': ' || coalesce(sql, '') FROM sqlite_schema"));
  SchemaTexts texts;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return texts;
    texts[query.text(0)] = query.text(1);
  }
}

/// The tables of each version; version 0 has none.
Result<std::vector<SchemaTexts>> make_known_schemas() {
  auto database = TRY(Database::open(":memory:", {}));
  std::vector<SchemaTexts> known{{}};
  for (const char* upgrade : kUpgrades) {
    TRY(database.execute(upgrade));
    auto texts = TRY(schema_of(database));
    known.push_back(std::move(texts));
  }
  return known;
}

const Result<std::vector<SchemaTexts>>& known_schemas() {
  static const Result<std::vector<SchemaTexts>> known = make_known_schemas();
  return known;
}

/// The newest version whose tables and indexes are all in the file, exactly as that
/// version created them.
int version_of(const SchemaTexts& file, const std::vector<SchemaTexts>& known) {
  auto version = static_cast<int>(known.size()) - 1;
  while (version > 0 && !std::ranges::includes(file, known[static_cast<std::size_t>(version)])) {
    --version;
  }
  return version;
}

/// Whether a file is recald's even if its header or some tables do not show it.
bool has_our_tables(const SchemaTexts& file) {
  return std::ranges::count_if(
             std::array{"interval", "register", "reopened", "sample"},
             [&](const char* name) { return file.contains(std::string{"table "} + name); }) >= 3;
}

/// How a file of ours differs from every version.
std::string misfit(int named, int version, const SchemaTexts& file,
                   const std::vector<SchemaTexts>& known) {
  if (version > 0) {
    return fmt::format("its header says schema version {}, but its tables are those of version {}",
                       named, version);
  }
  const SchemaTexts& meant = known[static_cast<std::size_t>(std::clamp(named, 1, kSchemaVersion))];
  for (const auto& [name, text] : meant) {
    const auto found = file.find(name);
    if (found == file.end()) return fmt::format("its {} is missing", name);
    if (found->second != text) return fmt::format("its {} differs from what recald creates", name);
  }
  return "its tables do not match any version of recald";
}

}  // namespace

Result<int> schema_version(Database& database) {
  const auto header = TRY(ask(database, "PRAGMA user_version"));
  const auto named = static_cast<int>(header);
  const auto application = TRY(ask(database, "PRAGMA application_id"));
  const auto tables = TRY(schema_of(database));
  const auto& known = known_schemas();
  if (!known) return tl::unexpected(known.error());
  const int version = version_of(tables, *known);
  if (tables.empty() && named == 0) return 0;
  if (version == 0 && application != kApplicationId && !has_our_tables(tables)) {
    return failure(ErrorCode::unsupported,
                   "the store file is a database of another program; name another file");
  }
  // A newer version would have other tables. If all tables match a known version but the header has
  // a newer number, the number is damaged.
  const bool is_known = tables.size() == (*known)[static_cast<std::size_t>(version)].size();
  if (named > kSchemaVersion && !is_known) {
    return failure(ErrorCode::unsupported,
                   fmt::format("the store file has schema version {}, but this recald only knows "
                               "{}; use the newer recald that wrote it, or an earlier backup",
                               named, kSchemaVersion));
  }
  if (version != named) {
    return failure(ErrorCode::malformed, misfit(named, version, tables, *known));
  }
  return version;
}

Result<void> bring_up_to_date(Database& database, int until) {
  const auto version = TRY(schema_version(database));
  for (int next = version; next < until; ++next) {
    const std::string text =
        fmt::format("{}PRAGMA application_id={};PRAGMA user_version={};",
                    kUpgrades[static_cast<std::size_t>(next)], kApplicationId, next + 1);
    const auto upgraded = database.transaction([&] { return database.execute(text); });
    if (!upgraded) return upgraded;
  }
  return {};
}

Result<void> require_current(Database& database) {
  const auto version = TRY(schema_version(database));
  if (version == kSchemaVersion) return {};
  return failure(ErrorCode::unsupported,
                 fmt::format("the store file has schema version {}, but this recald reads {}; the "
                             "daemon upgrades the file when it starts",
                             version, kSchemaVersion));
}

}  // namespace recald::sqlite
