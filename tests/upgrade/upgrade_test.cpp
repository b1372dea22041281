/// Stores of every schema version, and site files of every release, as today's recald takes them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/sqlite/tables/tables.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/site/config/site_config.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::upgrade_test {
namespace {

namespace fs = std::filesystem;

using recald::testing::BackgroundProcess;
using recald::testing::eventually;
using recald::testing::read_text;
using recald::testing::run_in_shell;
using recald::testing::write_text;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const fs::path kHere = fs::path{RECALD_SOURCE_DIR} / "tests/upgrade";

constexpr const char* kSite = R"([site]
id = "tower"
timezone = "Etc/UTC"

[http]
listen = "127.0.0.1:0"

[[meter]]
id = "main"
utility = "electricity"
source = "http"
interval = "1h"
)";

using Rows = std::multiset<std::string>;

/// The columns of a table, without the sums that a row may get when it is written again.
std::vector<std::string> columns_of(sqlite::Database& database, const std::string& table) {
  auto columns = sqlite::columns_of(database, table).value();
  std::erase(columns, "sum");
  return columns;
}

std::vector<std::string> tables_of(sqlite::Database& database) {
  auto query = database
                   .prepare(
                       "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT "
                       "LIKE 'sqlite_%' ORDER BY name")
                   .value();
  std::vector<std::string> tables;
  while (query.step().value()) tables.push_back(query.text(0));
  return tables;
}

/// Every value of a table's rows as SQL writes it, which tells text from numbers.
Rows rows_of(sqlite::Database& database, const std::string& table,
             const std::vector<std::string>& columns) {
  std::string list;
  for (const std::string& column : columns) {
    list += fmt::format("{}quote({})", list.empty() ? "" : " || ', ' || ", column);
  }
  auto query = database.prepare(fmt::format("SELECT {} FROM {}", list, table)).value();
  Rows rows;
  while (query.step().value()) rows.insert(query.text(0));
  return rows;
}

/// What `recald export` says of the readings of `rows`.
std::string expected_readings(bool is_edited) {
  std::string text = "timestamp,meter,value,unit,validity,late,reasons\n";
  const metering::Instant start = std::chrono::sys_days{std::chrono::year{2024} / 1 / 1};
  for (int i = 0; i < 960; ++i) {
    const metering::Instant t = start + std::chrono::hours{i};
    const bool is_edit = is_edited && i == 864;
    text += fmt::format("{},main,{},kW,ok,{},\n", metering::to_string(t),
                        is_edit      ? 99
                        : i % 2 == 0 ? 40
                                     : 60,
                        is_edit ? 1 : 0);
  }
  return text;
}

class Upgrade : public ::testing::TestWithParam<int> {
 protected:
  Upgrade() {
    write_text(folder_ / "site.toml", kSite);
    auto database = sqlite::Database::open(file(), {}).value();
    EXPECT_TRUE(sqlite::bring_up_to_date(database, GetParam()).has_value());
    for (int version = 1; version <= GetParam(); ++version) {
      const fs::path rows = kHere / "rows" / fmt::format("{}.sql", version);
      EXPECT_TRUE(fs::exists(rows)) << rows << ": a new schema version leaves rows behind";
      const auto filled = database.execute(read_text(rows));
      EXPECT_TRUE(filled.has_value()) << rows << ": " << filled.error().message;
    }
  }

  [[nodiscard]] fs::path file() const { return folder_ / "site.db"; }
  [[nodiscard]] recald::testing::ShellEnd recald(const std::string& words) const {
    return run_in_shell(
        fmt::format("{} {} {}/site.toml 2>&1", RECALD_PROGRAM, words, folder_.path().string()));
  }
  /// A daemon for which it is the 10th of February, until it has closed what there is to close.
  void run_daemon() const {
    const auto now = std::chrono::duration_cast<std::chrono::seconds>(
        std::chrono::system_clock::now().time_since_epoch());
    const fs::path said = folder_ / "said.txt";
    write_text(said, "");
    BackgroundProcess daemon{{RECALD_PROGRAM, "run", folder_ / "site.toml", "--clock",
                              fmt::format("2024-02-10T00:30:00Z@{}x1", now.count())},
                             said};
    ASSERT_TRUE(eventually([&] {
      return read_text(said).find("event=started") != std::string::npos &&
             recald("export --months")
                     .said.find(
                         "\n2024-01,main,1200,kWh/day,1,0,60,"
                         "2024-01-01T01:00:00Z,block-3600s,1,") != std::string::npos;
    })) << read_text(said)
        << recald("export --months").said;
    EXPECT_EQ(daemon.end(SIGTERM), 0) << read_text(said);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_P(Upgrade, EveryTableHasARow) {
  auto database = sqlite::Database::open(file(), {}).value();
  ASSERT_EQ(sqlite::schema_version(database), GetParam());
  const auto tables = tables_of(database);
  EXPECT_THAT(tables, Contains("interval"));
  for (const std::string& table : tables) {
    EXPECT_THAT(rows_of(database, table, columns_of(database, table)), Not(IsEmpty()))
        << "rows/" << GetParam() << ".sql should have a row of table " << table;
  }
  EXPECT_EQ(sqlite::wrong_sums(database).value(), "");
}

TEST_P(Upgrade, TheDaemonTakesItAndEverythingIsStillThere) {
  std::map<std::string, std::vector<std::string>> columns;
  std::map<std::string, Rows> before;
  {
    auto database = sqlite::Database::open(file(), {}).value();
    for (const std::string& table : tables_of(database)) {
      columns[table] = columns_of(database, table);
      before[table] = rows_of(database, table, columns[table]);
    }
  }
  if (GetParam() < sqlite::kSchemaVersion) {
    EXPECT_THAT(recald("verify").said, HasSubstr("the daemon upgrades the file when it starts"));
  }
  EXPECT_THAT(recald("doctor").said,
              HasSubstr(fmt::format("schema version {}, 1 meter,", GetParam())));
  ASSERT_NO_FATAL_FAILURE(run_daemon());

  const auto verified = recald("verify");
  EXPECT_EQ(verified.status, 0);
  EXPECT_THAT(verified.said, HasSubstr("the store is sound"));
  // The day of the correction is not compared.
  EXPECT_THAT(verified.said, HasSubstr(fmt::format("; {} days agree with their counters, 1 months",
                                                   GetParam() >= 2 ? 39 : 40)));
  EXPECT_EQ(recald("export").said, expected_readings(GetParam() >= 2));
  EXPECT_THAT(recald("export --months").said, HasSubstr("\n2023-12,main,,kWh/day,0,0,,,"));

  auto database = sqlite::Database::open(file(), {}).value();
  EXPECT_EQ(sqlite::schema_version(database), sqlite::kSchemaVersion);
  // January was to be closed again, and by today's rules.
  EXPECT_EQ(before.erase("reopened"), 1);
  before.erase("closing");
  before.erase("outbox");  // its site tells nobody
  for (const auto& [table, rows] : before) {
    const Rows after = rows_of(database, table, columns[table]);
    for (const std::string& row : rows) {
      EXPECT_GE(after.count(row), rows.count(row)) << table << ": " << row;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Schema, Upgrade, ::testing::Range(1, sqlite::kSchemaVersion + 1),
                         [](const auto& from) {
                           return "from_schema_" + std::to_string(from.param);
                         });

/// The releases that a changelog names, "0.1.0".
std::vector<std::string> releases_in(const std::string& changelog) {
  static const std::regex heading{R"((^|\n)## \[?v?(\d+\.\d+\.\d+)\b)"};
  std::vector<std::string> releases;
  for (std::sregex_iterator one{changelog.begin(), changelog.end(), heading}, end; one != end;
       ++one) {
    releases.push_back((*one)[2]);
  }
  return releases;
}

bool has_site_files(const std::string& release) {
  return fs::exists(kHere / "site-files" / release / "every-key.toml");
}

TEST(SiteFiles, EachReleaseHasLeftSome) {
  EXPECT_THAT(releases_in("# Changes\n\n## Unreleased (0.3.0)\n\n## 0.2.0 (2027-01-31)\n\n"
                          "## [0.1.0] - 2026-12-24\n"),
              ::testing::ElementsAre("0.2.0", "0.1.0"));
  EXPECT_FALSE(has_site_files("9.9.9"));
  for (const std::string& release :
       releases_in(read_text(fs::path{RECALD_SOURCE_DIR} / "CHANGELOG.md"))) {
    EXPECT_TRUE(has_site_files(release))
        << "CHANGELOG.md names " << release << "; copy its daemon/examples/*.toml to "
        << "tests/upgrade/site-files/" << release << " (README.md there)";
  }
}

TEST(SiteFiles, OfEveryReleaseAreRead) {
  ::setenv("RECALD_DATA", "/nowhere", 1);
  int files = 0;
  for (const auto& one : fs::recursive_directory_iterator(kHere / "site-files")) {
    if (one.path().extension() != ".toml") continue;
    SCOPED_TRACE(one.path().string());
    ++files;
    const auto said =
        run_in_shell(fmt::format("{} doctor --json {}", RECALD_PROGRAM, one.path().string()));
    const auto json = nlohmann::json::parse(said.said);
    int site_facts = 0;
    for (const auto& fact : json["facts"]) {
      if (fact["name"] != "site file") continue;
      ++site_facts;
      EXPECT_FALSE(fact.contains("problem")) << fact["problem"];
    }
    EXPECT_EQ(site_facts, 1);
  }
  EXPECT_GE(files, 4);
}

}  // namespace
}  // namespace recald::upgrade_test
