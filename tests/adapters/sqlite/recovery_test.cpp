/// Damaged stores: put aside, and all that can be read is in the new one.
#include "adapters/sqlite/recovery/recovery.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "adapters/ports/destination_cursors.hpp"
#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/sqlite/tables/tables.hpp"
#include "core/random/rng.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::sqlite::recovery_test {
namespace {

using metering::Instant;
using recald::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
const Instant kNow = kStart + std::chrono::days{40} + std::chrono::hours{5};
constexpr std::chrono::seconds kQuarter{900};
constexpr int kQuarters = 3000;

class RecoveryTest : public ::testing::Test {
 protected:
  RecoveryTest() {
    auto store = SqliteStore::open(file()).value();
    for (const char* id : {"main", "cooling"}) {
      const std::uint32_t meter = store.meter_number(id, kQuarter).value();
      StoreBatch batch;
      double register_kWh = 0.0;
      batch.edit = store.add_edit({.time = kStart, .reason = "began"}).value();
      for (int i = 0; i < kQuarters; ++i) {
        batch.intervals.push_back({{meter, kStart + i * kQuarter, 100.0 * meter + i}});
        batch.samples.push_back({meter, "energy", kStart + i * kQuarter, register_kWh});
        register_kWh += (100.0 * meter + i) / 4.0;
        if (i % 100 == 0) batch.events.push_back({kStart, Severity::info, "test", id, "x"});
      }
      batch.registers.push_back(
          {meter, {.field = "energy", .settings = {.rated_kW = 10'000.0}, .identity = id}});
      EXPECT_TRUE(store.commit(batch).has_value());
    }
    metering::MonthlyFigure march{.month = std::chrono::year{2024} / 3};
    EXPECT_TRUE(store.put_month(0, march, "2025b", kStart).has_value());
    EXPECT_TRUE(store.add_job({.asked_by = "api", .asked = kStart, .result = {.document = "{}"}})
                    .has_value());
  }

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "site.db"; }
  [[nodiscard]] static CheckedStore open(const std::filesystem::path& file,
                                         const std::vector<std::filesystem::path>& backups = {}) {
    auto opened = open_checked(file, backups, kNow);
    if (!opened) throw std::runtime_error(opened.error().message);
    return std::move(*opened);
  }
  void back_up_to(const std::filesystem::path& backup) const {
    CheckedStore opened = open(file());
    const auto copy = opened.store.begin_backup(backup).value();
    ASSERT_TRUE(copy->step(10'000).value());
    ASSERT_TRUE(copy->keep().has_value());
  }
  [[nodiscard]] static const RecoveredTable& table(const Recovery& recovery,
                                                   const std::string& name) {
    return *std::ranges::find(recovery.tables, name, &RecoveredTable::name);
  }
  /// Values of a meter's intervals, each as it was written, or of a known sum where neither it nor
  /// the samples around it were left. @return how many there are.
  static int right_intervals(SqliteStore& store, std::uint32_t meter) {
    int count = 0;
    (void)store.for_each_interval(
        meter, {Instant::min(), Instant::max()}, [&](const StoredInterval& interval) {
          ++count;
          if (interval.reading.validity == metering::Validity::scaled) return;
          const auto i = (interval.reading.start - kStart) / kQuarter;
          EXPECT_NEAR(interval.reading.mean_kW, 100.0 * meter + static_cast<double>(i), 1e-6);
        });
    return count;
  }

  TemporaryFolder folder_;
};

TEST_F(RecoveryTest, ASoundStoreIsOpenedAndNothingElse) {
  CheckedStore opened = open(file());
  EXPECT_FALSE(opened.recovery.has_value());
  EXPECT_EQ(right_intervals(opened.store, 0), kQuarters);
  EXPECT_FALSE(open(folder_ / "new.db").recovery.has_value());
}

TEST_F(RecoveryTest, APageOfReadingsCostsThatPage) {
  recald::testing::damage_leaf(file(), "interval", 20);
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  const Recovery& recovery = *opened.recovery;
  EXPECT_EQ(recovery.damaged.filename(), "site.db.damaged-20240410T050000Z");
  EXPECT_TRUE(std::filesystem::exists(recovery.damaged));
  const RecoveredTable& intervals = table(recovery, "interval");
  // A page of 4 KiB holds some 150 rows.
  EXPECT_GE(intervals.from_damaged, 2 * kQuarters - 250);
  EXPECT_LT(intervals.from_damaged, 2 * kQuarters);
  // The samples of the register know what was lost.
  EXPECT_EQ(recovery.from_samples, 2 * kQuarters - intervals.from_damaged);
  EXPECT_EQ(recovery.lost_intervals, 0);
  EXPECT_EQ(right_intervals(opened.store, 0) + right_intervals(opened.store, 1), 2 * kQuarters);
  EXPECT_EQ(table(recovery, "sample").from_damaged, 2 * kQuarters);
  EXPECT_EQ(opened.store.registers(1)->at(0).identity, "cooling");
  EXPECT_THAT(*opened.store.months(0), SizeIs(1));
  EXPECT_THAT(*opened.store.events(1000), SizeIs(60 + 1));
  EXPECT_EQ(opened.store.events(1)->at(0).kind, "store_recovered");
  EXPECT_EQ(opened.store.events(1)->at(0).text, recovery.sentence());
  EXPECT_TRUE(opened.store.job(1)->has_value());
  EXPECT_EQ(table(recovery, "edit").from_damaged, 2);
  EXPECT_EQ(opened.store.database().quick_check().value(), "");
  EXPECT_THAT(recovery.sentence(), HasSubstr("it is kept as 'site.db.damaged-20240410T050000Z'"));
  EXPECT_THAT(recovery.sentence(), HasSubstr("intervals were computed again from samples"));
  EXPECT_THAT(recovery.sentence(), HasSubstr("there was no intact backup"));
}

// The first intervals of a store, and all of one that is some hours old, stand on its first page.
TEST_F(RecoveryTest, TheFirstIntervalsComeBackFromSamplesToo) {
  recald::testing::damage_leaf(file(), "interval", 0);
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_GT(opened.recovery->from_samples, 0);
  EXPECT_EQ(opened.recovery->lost_intervals, 0);
  EXPECT_EQ(right_intervals(opened.store, 0) + right_intervals(opened.store, 1), 2 * kQuarters);
}

TEST_F(RecoveryTest, ABackupFillsTheHole) {
  const auto backup = folder_ / "backup.db";
  const auto bad_backup = folder_ / "bad.db";
  back_up_to(backup);
  std::filesystem::copy(backup, bad_backup);
  recald::testing::damage_leaf(bad_backup, "interval", 2);
  recald::testing::damage_leaf(file(), "interval", 20);
  CheckedStore opened = open(file(), {folder_ / "none.db", bad_backup, backup});
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(opened.recovery->backup, backup);
  EXPECT_EQ(right_intervals(opened.store, 0), kQuarters);
  EXPECT_EQ(right_intervals(opened.store, 1), kQuarters);
  const RecoveredTable& intervals = table(*opened.recovery, "interval");
  EXPECT_EQ(intervals.from_damaged + intervals.from_backup, 2 * kQuarters);
  EXPECT_GT(intervals.from_backup, 0);
}

// Numbers that the lost rows had are given again.
TEST_F(RecoveryTest, ARecoveredStoreIsOfAnotherNumbering) {
  {
    auto store = SqliteStore::open(file()).value();
    ASSERT_TRUE(store.put_cursor(events_cursor("fleet"), 5).has_value());
    ASSERT_TRUE(store.put_cursor(identity_cursor("fleet"), 81).has_value());
  }
  const auto backup = folder_ / "backup.db";
  back_up_to(backup);
  EXPECT_EQ(open(file()).store.cursor(identity_cursor("fleet")).value(), 81);
  recald::testing::damage_leaf(file(), "interval", 20);
  CheckedStore opened = open(file(), {backup});
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(opened.store.cursor(events_cursor("fleet")).value(), 5);
  EXPECT_EQ(opened.store.cursor(identity_cursor("fleet")).value(), std::nullopt);
}

TEST_F(RecoveryTest, WithoutItsMetersReadingsKeepTheirNumbers) {
  recald::testing::damage_leaf(file(), "meter", 0);
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(opened.store.find_meter("unknown-1").value(), 1u);
  EXPECT_EQ(right_intervals(opened.store, 1), kQuarters);
}

TEST_F(RecoveryTest, NothingReadableIsANewStoreAndABackupFillsIt) {
  const auto backup = folder_ / "backup.db";
  back_up_to(backup);
  recald::testing::damage_page(file(), 1);
  CheckedStore opened = open(file(), {backup});
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(right_intervals(opened.store, 0), kQuarters);
  EXPECT_EQ(opened.store.find_meter("cooling").value(), 1u);
}

// Any page: whatever it held, the store opens, and what is in it is right.
TEST_F(RecoveryTest, WhicheverPageIsDamaged) {
  const std::string whole = recald::testing::read_text(file());
  const auto pages = static_cast<std::int64_t>(whole.size()) / recald::testing::kPageBytes;
  ASSERT_GT(pages, 60);
  int recovered = 0;
  for (std::int64_t page = 1; page <= pages; page += page < 16 ? 1 : 3) {
    SCOPED_TRACE(page);
    const TemporaryFolder here;
    recald::testing::write_text(here / "site.db", whole);
    recald::testing::damage_page(here / "site.db", page);
    CheckedStore opened = open(here / "site.db");
    EXPECT_EQ(opened.store.database().quick_check().value(), "");
    recovered += static_cast<int>(opened.recovery.has_value());
    const int found = right_intervals(opened.store, 0) + right_intervals(opened.store, 1);
    if (!opened.recovery) {
      EXPECT_EQ(found, 2 * kQuarters);
    }
  }
  EXPECT_GE(recovered, 15);
}

// A file system that lost the end of a file.
TEST_F(RecoveryTest, AFileThatWasCutKeepsWhatIsLeft) {
  const auto size = std::filesystem::file_size(file());
  for (const double share : {0.96, 0.6, 0.3}) {
    SCOPED_TRACE(share);
    const TemporaryFolder here;
    std::filesystem::copy(file(), here / "site.db");
    std::filesystem::resize_file(here / "site.db",
                                 static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    CheckedStore opened = open(here / "site.db");
    ASSERT_TRUE(opened.recovery.has_value());
    EXPECT_EQ(opened.store.database().quick_check().value(), "");
    const int found = right_intervals(opened.store, 0) + right_intervals(opened.store, 1);
    EXPECT_GE(found, static_cast<int>((share - 0.05) * 2 * kQuarters));
  }
}

// Bits that flip anywhere, in values too: what is there afterwards is what was written.
TEST_F(RecoveryTest, FlippedBitsCostTheirPagesAtMost) {
  const std::string whole = recald::testing::read_text(file());
  const auto pages = static_cast<std::int64_t>(whole.size()) / recald::testing::kPageBytes;
  Rng rng{1};
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    const TemporaryFolder here;
    std::string flipped = whole;
    constexpr int kFlips = 4;
    for (int i = 0; i < kFlips; ++i) {
      const std::size_t at = rng.below(flipped.size());
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << rng.below(8)));
    }
    recald::testing::write_text(here / "site.db", flipped);
    CheckedStore opened = open(here / "site.db");
    const int found = right_intervals(opened.store, 0) + right_intervals(opened.store, 1);
    EXPECT_GE(found, 2 * kQuarters - kFlips * 2 * kQuarters / static_cast<int>(pages) * 4);
  }
}

TEST_F(RecoveryTest, AFlippedValueIsFoundByItsSum) {
  {
    auto store = SqliteStore::open(file()).value();
    ASSERT_TRUE(store.database()
                    .execute("UPDATE interval SET mean_kW = mean_kW + 1 WHERE meter = 0 AND "
                             "t_start % 86400 = 0")
                    .has_value());
    EXPECT_THAT(store.check()->problems, ElementsAre("rows with a wrong checksum: 32 of interval"));
  }
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(opened.recovery->refused, 32);
  EXPECT_EQ(opened.recovery->from_samples, 32);
  EXPECT_EQ(right_intervals(opened.store, 0), kQuarters);
}

// The newest commits are in the log when a daemon is killed.
TEST_F(RecoveryTest, WhatTheLogHasIsNotLost) {
  const TemporaryFolder here;
  {
    auto store = SqliteStore::open(file()).value();
    StoreBatch batch;
    for (int i = kQuarters; i < kQuarters + 50; ++i) {
      batch.intervals.push_back({{0, kStart + i * kQuarter, 1.0 * i}});
    }
    ASSERT_TRUE(store.commit(batch).has_value());
    std::filesystem::copy(file(), here / "site.db");
    std::filesystem::copy(file().string() + "-wal", here / "site.db-wal");
  }
  recald::testing::damage_page(here / "site.db", 1);
  CheckedStore opened = open(here / "site.db");
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(right_intervals(opened.store, 0), kQuarters + 50);
}

// Usually SQLite moves the log into the file before we read that. While somebody else has the file
// open it does not.
TEST_F(RecoveryTest, ALogThatStaysIsReadToo) {
  recald::testing::damage_leaf(file(), "sample", 3);
  auto other = SqliteStore::open(file()).value();
  StoreBatch batch;
  for (int i = kQuarters; i < kQuarters + 50; ++i) {
    batch.intervals.push_back({{0, kStart + i * kQuarter, 1.0 * i}});
  }
  ASSERT_TRUE(other.commit(batch).has_value());
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_TRUE(std::filesystem::exists(opened.recovery->damaged.string() + "-wal"));
  EXPECT_EQ(right_intervals(opened.store, 0), kQuarters + 50);
}

// An older file has rows without sums; all of them count.
TEST_F(RecoveryTest, RowsFromBeforeThereWereSumsAreTaken) {
  {
    auto database = Database::open(file(), {}).value();
    ASSERT_TRUE(database.execute("DROP TABLE cursor; DROP TABLE outbox").has_value());
    for (const TableShape& table : table_shapes()) {
      const std::string_view name = table.name;
      if (!table.has_sum() || name == "cursor" || name == "outbox") continue;
      ASSERT_TRUE(
          database.execute(fmt::format("ALTER TABLE {} DROP COLUMN sum", table.name)).has_value());
    }
    ASSERT_TRUE(database
                    .execute("ALTER TABLE event DROP COLUMN count; ALTER TABLE event DROP COLUMN "
                             "last; ALTER TABLE job DROP COLUMN tries; PRAGMA user_version = 4")
                    .has_value());
  }
  recald::testing::damage_leaf(file(), "interval", 20);
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(right_intervals(opened.store, 0) + right_intervals(opened.store, 1), 2 * kQuarters);
  EXPECT_EQ(opened.store.registers(1)->at(0).identity, "cooling");
  EXPECT_THAT(*opened.store.months(0), SizeIs(1));
  EXPECT_THAT(*opened.store.events(1000), SizeIs(60 + 1));
  EXPECT_TRUE(opened.store.job(1)->has_value());
}

// What a header says of the version is held against the tables.
TEST_F(RecoveryTest, AFlippedVersionIsNoOtherVersion) {
  for (const int named : {8, 5, 1, 0}) {
    SCOPED_TRACE(named);
    const TemporaryFolder here;
    const auto flipped = here / "site.db";
    std::filesystem::copy(file(), flipped);
    ASSERT_TRUE(Database::open(flipped, {})
                    ->execute(fmt::format("PRAGMA user_version = {}", named))
                    .has_value());
    const auto reader = SqliteStore::open(flipped, {.access = Database::Access::read_only});
    ASSERT_FALSE(reader.has_value());
    EXPECT_EQ(reader.error().code, ErrorCode::malformed);
    CheckedStore opened = open(flipped);
    ASSERT_TRUE(opened.recovery.has_value());
    EXPECT_EQ(
        opened.recovery->damage,
        fmt::format("its header says schema version {}, but its tables are those of version 7",
                    named));
    EXPECT_EQ(right_intervals(opened.store, 0) + right_intervals(opened.store, 1), 2 * kQuarters);
    EXPECT_EQ(opened.recovery->lost_intervals, 0);
  }
}

// A column whose name has changed passes quick_check, and every statement that names it fails.
TEST_F(RecoveryTest, AFlippedNameOfAColumnIsFound) {
  std::string bytes = recald::testing::read_text(file());
  const std::size_t at = bytes.find("mean_kW  REAL");
  ASSERT_NE(at, std::string::npos);
  bytes[at + 5] = 'j';  // k with its last bit flipped
  recald::testing::write_text(file(), bytes);
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_EQ(opened.recovery->damage, "its table interval differs from what recald creates");
  EXPECT_EQ(right_intervals(opened.store, 0) + right_intervals(opened.store, 1), 2 * kQuarters);
}

// Every third bit of a file's header, and some of its tables' texts: none may need a person.
TEST_F(RecoveryTest, WhicheverBitOfTheFirstPageFlips) {
  const TemporaryFolder small;
  {
    auto store = SqliteStore::open(small / "site.db").value();
    StoreBatch batch;
    for (int i = 0; i < 50; ++i) {
      batch.intervals.push_back(
          {{store.meter_number("main", kQuarter).value(), kStart + i * kQuarter, 1.0 * i}});
    }
    ASSERT_TRUE(store.commit(batch).has_value());
  }
  const std::string whole = recald::testing::read_text(small / "site.db");
  Rng rng{1};
  constexpr std::size_t kHeader = 8 * 100;
  for (std::size_t i = 0; i < kHeader + 300; i += 3) {
    const std::size_t bit =
        i < kHeader ? i : kHeader + rng.below(8 * recald::testing::kPageBytes - kHeader);
    SCOPED_TRACE(fmt::format("byte {}, bit {}", bit / 8, bit % 8));
    const TemporaryFolder here;
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    recald::testing::write_text(here / "site.db", flipped);
    auto opened = open_checked(here / "site.db", {}, kNow);
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    EXPECT_EQ(right_intervals(opened->store, 0), 50);
    EXPECT_TRUE(opened->store.commit({.intervals = {{{0, kStart - kQuarter, 1.0}}}}).has_value());
  }
}

// Tables that no version known here has made are a newer version's.
TEST_F(RecoveryTest, ANewerStoreIsRefusedAndAsItWas) {
  for (const char* upgrade :
       {"CREATE TABLE more (thing TEXT)", "ALTER TABLE interval ADD COLUMN more INTEGER"}) {
    SCOPED_TRACE(upgrade);
    const TemporaryFolder here;
    std::filesystem::copy(file(), here / "site.db");
    ASSERT_TRUE(Database::open(here / "site.db", {})
                    ->execute(fmt::format("{}; PRAGMA user_version = 8", upgrade))
                    .has_value());
    const std::string before = recald::testing::read_text(here / "site.db");
    const auto opened = open_checked(here / "site.db", {}, kNow);
    ASSERT_FALSE(opened.has_value());
    EXPECT_EQ(opened.error().code, ErrorCode::unsupported);
    EXPECT_THAT(
        opened.error().message,
        HasSubstr(
            "the store file has schema version 8, but this recald only knows 7; use the newer"));
    EXPECT_EQ(recald::testing::read_text(here / "site.db"), before);
    EXPECT_FALSE(std::filesystem::exists(here / "site.db.recovery"));
  }
}

TEST(SchemaVersions, EachOlderOneIsBroughtUpToDate) {
  for (int version = 0; version < kSchemaVersion; ++version) {
    SCOPED_TRACE(version);
    const TemporaryFolder here;
    {
      auto older = Database::open(here / "site.db", {});
      ASSERT_TRUE(bring_up_to_date(*older, version).has_value());
      EXPECT_EQ(schema_version(*older), version);
    }
    auto opened = open_checked(here / "site.db", {}, kNow);
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    EXPECT_FALSE(opened->recovery.has_value());
    EXPECT_EQ(schema_version(opened->store.database()), kSchemaVersion);
  }
}

// A file's tables are compared with these texts: changed, they would make all that is stored look
// damaged. A sum is written here once, when its version is, and never again.
TEST(SchemaVersions, TextsStayAsTheyWereWritten) {
  std::vector<std::int64_t> sums;
  for (int version = 1; version <= kSchemaVersion; ++version) {
    auto database = Database::open(":memory:", {}).value();
    ASSERT_TRUE(bring_up_to_date(database, version).has_value());
    auto query = database
                     .prepare(
                         "SELECT row_sum('', group_concat(sql)) FROM (SELECT sql FROM "
                         "sqlite_schema ORDER BY type, name)")
                     .value();
    ASSERT_TRUE(query.step().value());
    sums.push_back(query.integer(0));
  }
  EXPECT_THAT(sums, ElementsAre(1978806147, 845759539, 1936630115, 1590918335, 3679785145,
                                129490604, 3960903599));
}

// A second damage at the same second, as of a clock that always wakes up at the same time.
TEST_F(RecoveryTest, WhatWasPutAsideIsNeverWrittenOver) {
  recald::testing::damage_leaf(file(), "interval", 20);
  const std::filesystem::path first = open(file()).recovery->damaged;
  const std::string kept = recald::testing::read_text(first);
  recald::testing::damage_leaf(file(), "interval", 10);
  CheckedStore opened = open(file());
  ASSERT_TRUE(opened.recovery.has_value());
  EXPECT_NE(opened.recovery->damaged, first);
  EXPECT_TRUE(std::filesystem::exists(opened.recovery->damaged));
  EXPECT_EQ(recald::testing::read_text(first), kept);
}

// In 1970: the event would go with the first old ones once the clock is right.
TEST_F(RecoveryTest, IsDatedAfterWhatIsStored) {
  recald::testing::damage_leaf(file(), "interval", 20);
  auto opened = open_checked(file(), {}, Instant{std::chrono::seconds{40}}).value();
  const auto events = opened.store.events(1).value();
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].kind, "store_recovered");
  EXPECT_EQ(events[0].time, kStart + (kQuarters - 1) * kQuarter);
}

// Before the first row is salvaged, minutes may go by over the backups.
TEST_F(RecoveryTest, SaysThatItGoesOnWhileItLooksThroughBackups) {
  const auto backup = folder_ / "backup.db";
  back_up_to(backup);
  recald::testing::damage_leaf(file(), "interval", 20);
  const auto aside = folder_ / "site.db.damaged-20240409T000000Z";
  std::filesystem::rename(file(), aside);
  recald::testing::write_text(folder_ / "site.db.recovery",
                              aside.filename().string() + "\nbad page\n");
  int calls_before = 0;
  const auto opened = open_checked(file(), {backup}, kNow, [&] {
    const bool has_begun = std::filesystem::exists(folder_ / "site.db.recovering");
    calls_before += static_cast<int>(!has_begun);
  });
  ASSERT_TRUE(opened.has_value()) << opened.error().message;
  EXPECT_TRUE(opened->recovery->was_interrupted);
  EXPECT_GE(calls_before, 1);
}

// Somebody put another store in the place of the one that was being recovered.
TEST_F(RecoveryTest, AStoreThatTookItsPlaceIsToldOf) {
  const auto aside = folder_ / "site.db.damaged-20240409T000000Z";
  std::filesystem::rename(file(), aside);
  recald::testing::write_text(folder_ / "site.db.recovery",
                              aside.filename().string() + "\nbad page\n");
  { ASSERT_TRUE(SqliteStore::open(file())->put_cursor(identity_cursor("fleet"), 81)); }
  {
    CheckedStore opened = open(file());
    ASSERT_TRUE(opened.recovery.has_value());
    EXPECT_TRUE(opened.recovery->is_overtaken);
    EXPECT_EQ(opened.store.cursor(identity_cursor("fleet")).value(), std::nullopt);
    EXPECT_THAT(opened.recovery->sentence(),
                HasSubstr("does not contain the data of 'site.db.damaged-20240409T000000Z'"));
    EXPECT_EQ(opened.store.events(1)->at(0).text, opened.recovery->sentence());
  }
  EXPECT_TRUE(std::filesystem::exists(aside));
  EXPECT_FALSE(open(file()).recovery.has_value());
}

TEST_F(RecoveryTest, AnotherProgramsDatabaseIsLeftAlone) {
  {
    auto other = Database::open(folder_ / "other.db", {});
    ASSERT_TRUE(other->execute("CREATE TABLE t (a)").has_value());
  }
  const auto opened = open_checked(folder_ / "other.db", {}, kNow);
  ASSERT_FALSE(opened.has_value());
  EXPECT_THAT(opened.error().message, HasSubstr("database of another program"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "other.db"));
}

}  // namespace
}  // namespace recald::sqlite::recovery_test
