/// recald restore: a backup into the place of a store, whatever comes between.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <nlohmann/json.hpp>

#include "adapters/ports/destination_cursors.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"
#include "daemon/site/config/site_config.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/daemon/gateway/run/edges.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::restore_command_test {
namespace {

namespace fs = std::filesystem;

using metering::Instant;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::run;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr std::chrono::seconds kQuarter{900};
constexpr int kInBackup = 300;
constexpr int kInStore = 500;

constexpr const char* kSite = R"([site]
id = "tower"
timezone = "America/Chicago"

[http]
listen = "127.0.0.1:0"

[[meter]]
id = "main"
utility = "electricity"
source = "http"
)";

/// The first quarters of a meter: what a store of more has and one of fewer has not is in order.
void add_quarters(sqlite::SqliteStore& store, int from, int to, const char* meter = "main") {
  const auto number = store.meter_number(meter, kQuarter).value();
  StoreBatch batch;
  for (int i = from; i < to; ++i) batch.intervals.push_back({{number, kStart + i * kQuarter, 4.0}});
  ASSERT_TRUE(store.commit(batch).has_value());
}

int quarters_of(Store& store) {
  int count = 0;
  (void)store.for_each_interval(0, {Instant::min(), Instant::max()},
                                [&](const StoredInterval&) { ++count; });
  return count;
}

/// Names and contents.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& one : fs::recursive_directory_iterator(folder)) {
    const bool is_lock = one.path().extension() == ".lock";
    if (one.is_regular_file() && !is_lock) files[one.path().string()] = read_text(one.path());
  }
  return files;
}

/// A store of which the newest quarters are in its log, as a kill leaves it, and two backups.
class RestoreCommand : public ::testing::Test {
 protected:
  RestoreCommand() {
    fs::create_directory(made_ / "site");
    fs::create_directory(made_ / "site" / "backups");
    write_text(made_ / "site" / "site.toml", kSite);
    {
      auto store = sqlite::SqliteStore::open(made_ / "live.db").value();
      add_quarters(store, 0, kInBackup);
      back_up(store, "site-2024-03-03.db");
      EXPECT_TRUE(store.database().execute("PRAGMA wal_checkpoint(TRUNCATE)").has_value());
      add_quarters(store, kInBackup, kInStore);
      EXPECT_EQ(store.add_job({.asked_by = "api", .asked = kStart}).value(), 1);
      for (const char* part : {"", "-wal"}) {
        fs::copy(made_ / ("live.db" + std::string{part}),
                 made_ / "site" / ("site.db" + std::string{part}));
      }
    }
    auto older = sqlite::SqliteStore::open(made_ / "older.db").value();
    add_quarters(older, 0, 10);
    back_up(older, "site-2024-03-01.db");
    begin_anew();
  }
  ~RestoreCommand() override { recald::testing::before_file_change = {}; }

  void back_up(sqlite::SqliteStore& store, const char* name) const {
    const auto copy = store.begin_backup(made_ / "site" / "backups" / name).value();
    ASSERT_TRUE(copy->step(10'000).value());
    ASSERT_TRUE(copy->keep().has_value());
  }
  void begin_anew() const {
    fs::remove_all(folder_ / "site");
    fs::copy(made_ / "site", folder_ / "site", fs::copy_options::recursive);
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / "site" / name; }
  [[nodiscard]] std::string site() const { return path("site.toml"); }
  testing::Outcome restore(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words{"restore", site()};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  /// What the daemon finds when it starts, and what it says of it.
  [[nodiscard]] int quarters_when_opened() const {
    const auto opened = open_store(load_site(site()).value().store, kStart + std::chrono::days{9});
    if (!opened) throw std::runtime_error(opened.error().message);
    EXPECT_EQ(opened->recovery, "");
    EXPECT_THAT(opened->store->check().value().problems, IsEmpty());
    return quarters_of(*opened->store);
  }
  /// Each store that is kept beside, by how much it has.
  [[nodiscard]] std::vector<int> replaced() const {
    std::vector<int> kept;
    for (const auto& one : fs::directory_iterator(folder_ / "site")) {
      const std::string name = one.path().filename().string();
      if (!name.starts_with("site.db.replaced-") || name.ends_with("-wal")) continue;
      const TemporaryFolder here;  // opening would move its log into it
      fs::copy(one.path(), here / "site.db");
      if (fs::exists(one.path().string() + "-wal")) {
        fs::copy(one.path().string() + "-wal", here / "site.db-wal");
      }
      auto store = sqlite::SqliteStore::open(here / "site.db").value();
      kept.push_back(quarters_of(store));
    }
    return kept;
  }
  /// No copy, decided or not, and nothing of the old store but under its new name.
  void expect_nothing_half_done() const {
    for (const auto& one : fs::directory_iterator(folder_ / "site")) {
      EXPECT_THAT(one.path().filename().string(),
                  AllOf(::testing::Not(HasSubstr(".restor")), ::testing::Not(HasSubstr("-shm"))));
    }
  }

  TemporaryFolder made_;
  TemporaryFolder folder_;
};

TEST_F(RestoreCommand, TheNewestBackupTakesTheStoresPlaceAndTheStoreIsKept) {
  const auto done = restore();
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("site-2024-03-03.db: intact, 1 meter, newest reading "
                                        "2024-03-04T02:45:00Z"),
                              HasSubstr("the store has 50.0 h more: its newest reading is of "
                                        "2024-03-06T04:45:00Z"),
                              HasSubstr("kept as 'site.db.replaced-20")));
  expect_nothing_half_done();
  EXPECT_EQ(quarters_when_opened(), kInBackup);
  EXPECT_EQ(replaced(), std::vector{kInStore});
  auto store = sqlite::SqliteStore::open(path("site.db")).value();
  const StoreEvent event = store.events(1).value().at(0);
  EXPECT_EQ(event.kind, "store_restored");
  EXPECT_THAT(event.text, AllOf(HasSubstr("the backup 'site-2024-03-03.db'"),
                                HasSubstr("is kept as 'site.db.replaced-20")));
  // The folder of job 1 stays that of the replaced store's.
  EXPECT_EQ(store.add_job({.asked_by = "api", .asked = kStart}).value(), 2);
}

// What was told since the backup had numbers that are given again.
TEST_F(RestoreCommand, ARestoredStoreIsOfAnotherNumbering) {
  {
    auto backup = sqlite::SqliteStore::open(path("backups/site-2024-03-03.db")).value();
    ASSERT_TRUE(backup.put_cursor(events_cursor("fleet"), 5).has_value());
    ASSERT_TRUE(backup.put_cursor(identity_cursor("fleet"), 81).has_value());
    ASSERT_TRUE(backup.put_cursor(history_cursor("fleet"), 7).has_value());
  }
  const auto done = restore();
  ASSERT_EQ(done.exit_code, 0) << done.err;
  auto store = sqlite::SqliteStore::open(path("site.db")).value();
  EXPECT_EQ(store.cursor(events_cursor("fleet")).value(), 5);
  EXPECT_EQ(store.cursor(identity_cursor("fleet")).value(), std::nullopt);
  EXPECT_EQ(store.cursor(history_cursor("fleet")).value(), std::nullopt);  // it is told again
}

TEST_F(RestoreCommand, WhatWasReplacedCanBePutBackWithItsLog) {
  ASSERT_EQ(restore().exit_code, 0);
  std::string kept;
  for (const auto& [name, bytes] : files_of(folder_ / "site")) {
    if (name.find(".replaced-") != std::string::npos && !name.ends_with("-wal")) kept = name;
  }
  const auto back = restore({"--backup", kept});
  ASSERT_EQ(back.exit_code, 0) << back.err;
  EXPECT_EQ(quarters_when_opened(), kInStore);
}

TEST_F(RestoreCommand, ABackupByNameAndAsOneObject) {
  const auto done = restore({"--backup", "site-2024-03-01.db", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out);
  EXPECT_EQ(json["in_backup"]["newest_reading"], "2024-03-01T02:15:00Z");
  EXPECT_EQ(json["in_store"]["newest_reading"], "2024-03-06T04:45:00Z");
  EXPECT_EQ(json["in_backup"]["meters"], nlohmann::json::array({"main"}));
  EXPECT_TRUE(fs::exists(json["replaced"].get<std::string>()));
  EXPECT_EQ(quarters_when_opened(), 10);
}

TEST_F(RestoreCommand, ADryRunAndAListChangeNothing) {
  const auto before = files_of(folder_ / "site");
  const auto tried = restore({"--dry-run"});
  EXPECT_EQ(tried.exit_code, 0) << tried.err;
  EXPECT_THAT(tried.out, AllOf(HasSubstr("50.0 h more"), HasSubstr("nothing was changed")));
  // The log's index is made anew by whoever reads a store that has a log.
  fs::remove(path("site.db-shm"));
  const auto listed = restore({"--list"});
  EXPECT_THAT(listed.out, HasSubstr("site-2024-03-03.db  "));
  EXPECT_THAT(listed.out, HasSubstr("newest reading 2024-03-01T02:15:00Z"));
  EXPECT_EQ(nlohmann::json::parse(restore({"--list", "--json"}).out)["backups"].size(), 2);
  EXPECT_EQ(files_of(folder_ / "site"), before);
}

TEST_F(RestoreCommand, NotWhileADaemonRunsOnTheStore) {
  const auto before = files_of(folder_ / "site");
  const auto lock = system::FileLock::acquire(path("site.db.lock"));
  const auto refused = restore();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("stop the daemon, restore, and start it again"));
  EXPECT_EQ(files_of(folder_ / "site"), before);
}

TEST_F(RestoreCommand, ABackupThatIsNoGoodIsRefusedAndNothingIsChanged) {
  const fs::path bad = folder_ / "bad.db";
  const auto make = [&](const std::string& sql) {
    fs::copy_file(path("backups/site-2024-03-03.db"), bad, fs::copy_options::overwrite_existing);
    return sqlite::Database::open(bad, {})->execute(sql);
  };
  const auto before = files_of(folder_ / "site");
  const auto expect_refused = [&](const std::string& words) {
    const auto refused = restore({"--backup", bad.string()});
    EXPECT_EQ(refused.exit_code, 1) << words;
    EXPECT_THAT(refused.err, HasSubstr(words));
    EXPECT_EQ(files_of(folder_ / "site"), before) << words;
  };
  expect_refused("does not exist");
  ASSERT_TRUE(make("CREATE TABLE more (thing TEXT); PRAGMA user_version = 99").has_value());
  expect_refused("use the newer recald that wrote it");
  ASSERT_TRUE(make("UPDATE interval SET mean_kW = 5 WHERE t_start % 7200 = 0").has_value());
  expect_refused("it is damaged: rows with a wrong checksum");
  ASSERT_TRUE(make("UPDATE meter SET id = 'hall', sum = row_sum('meter', number, 'hall', "
                   "interval_s)")
                  .has_value());
  expect_refused("it is of another site: it has meter 'hall'");
  fs::remove(bad);
  ASSERT_TRUE(sqlite::Database::open(bad, {})->execute("CREATE TABLE theirs (x)").has_value());
  expect_refused("a database of another program");
  write_text(bad, "");
  expect_refused("the backup");
  recald::testing::damage_leaf(path("backups/site-2024-03-03.db"), "interval", 1);
  EXPECT_THAT(restore().err, HasSubstr("it is damaged"));
  EXPECT_THAT(restore({"--backup", path("site.db")}).err, HasSubstr("it is the store itself"));
}

TEST_F(RestoreCommand, WithoutABackupItSaysWhereItLooked) {
  fs::remove_all(path("backups"));
  EXPECT_THAT(restore().err, AllOf(HasSubstr("there is no backup in"), HasSubstr("--backup")));
  EXPECT_THAT(restore({"--list"}).out, HasSubstr("there is no backup in"));
}

TEST_F(RestoreCommand, AnOlderBackupIsBroughtUpToDate) {
  const fs::path old = folder_ / "old.db";
  {
    auto older = sqlite::Database::open(old, {}).value();
    ASSERT_TRUE(sqlite::bring_up_to_date(older, 1).has_value());
    ASSERT_TRUE(older
                    .execute("INSERT INTO meter VALUES (0, 'main', 900); INSERT INTO interval "
                             "VALUES (0, 1709251200, 0, 4.0, 0, 0, 0)")
                    .has_value());
  }
  ASSERT_EQ(restore({"--backup", old.string()}).exit_code, 0);
  EXPECT_EQ(run({"verify", site()}).exit_code, 0);
  EXPECT_EQ(quarters_when_opened(), 1);
}

TEST_F(RestoreCommand, ADamagedStoreIsKeptAsItIsAndAMissingOneIsNoHindrance) {
  fs::remove(path("site.db-wal"));
  write_text(path("site.db"), "not what it was");
  auto done = restore();
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("what the store has cannot be said"));
  EXPECT_EQ(quarters_when_opened(), kInBackup);
  EXPECT_THAT(files_of(folder_ / "site"),
              Contains(::testing::Pair(HasSubstr(".replaced-"), "not what it was")));
  fs::remove(path("site.db"));
  done = restore();
  EXPECT_THAT(done.out, AllOf(HasSubstr("there is no store to replace"),
                              ::testing::Not(HasSubstr("kept as"))));
  EXPECT_EQ(quarters_when_opened(), kInBackup);
}

// Its damaged store, still in place or put aside, is what is replaced.
TEST_F(RestoreCommand, ARecoveryThatWasInterruptedIsNotGoneOnWith) {
  const char* const aside = "site.db.damaged-20240308T000000Z";
  for (const bool is_put_aside : {false, true}) {
    SCOPED_TRACE(is_put_aside);
    begin_anew();
    write_text(path("site.db.recovery"), fmt::format("{}\nbad page\n", aside));
    write_text(path("site.db.recovering"), "half a store");
    if (is_put_aside) {
      for (const char* part : {"-wal", ""}) {
        fs::rename(path("site.db" + std::string{part}), path(aside + std::string{part}));
      }
    }
    ASSERT_EQ(restore().exit_code, 0);
    EXPECT_EQ(quarters_when_opened(), kInBackup);
    EXPECT_EQ(fs::exists(path(aside)), is_put_aside);
    EXPECT_EQ(replaced(), is_put_aside ? std::vector<int>{} : std::vector{kInStore});
    EXPECT_FALSE(fs::exists(path("site.db.recovering")));
  }
}

/// As after `sudo recald restore`: the daemon is another user's.
TEST_F(RestoreCommand, WhoOwnsTheFolderOwnsWhatIsPutThere) {
  constexpr uid_t kOther = 4321;
  fs::remove(path("site.db"));
  fs::remove(path("site.db-wal"));
  [[maybe_unused]] const int refused = ::chown(path("").c_str(), kOther, kOther);
  ASSERT_EQ(restore().exit_code, 0);
  struct stat folder {};
  ASSERT_EQ(::stat(path("").c_str(), &folder), 0);
  for (const char* name : {"site.db", "site.db.lock"}) {
    struct stat file {};
    ASSERT_EQ(::stat(path(name).c_str(), &file), 0);
    EXPECT_EQ(file.st_uid, folder.st_uid) << name;
    EXPECT_EQ(file.st_mode & 0777U, 0640U) << name;
  }
}

// The process ends before its first change of a file, its second, and so on. The daemon, or another
// call, then finds the old store or the backup, whole, and in the end nothing is lost.
TEST_F(RestoreCommand, EndedAtAnyStepTheOldStoreIsThereOrTheNew) {
  bool was_new = false;
  bool is_over = false;
  int nth = 1;
  for (; !is_over; ++nth) {
    SCOPED_TRACE(fmt::format("before change {}", nth));
    begin_anew();
    is_over = testing::ends_before(nth, [&] { (void)restore(); });
    const fs::path as_left = folder_ / "as_left";
    fs::remove_all(as_left);
    fs::copy(folder_ / "site", as_left, fs::copy_options::recursive);
    const int found = quarters_when_opened();
    EXPECT_EQ(found, was_new || found == kInBackup ? kInBackup : kInStore);
    was_new = was_new || found == kInBackup;
    EXPECT_EQ(replaced(), was_new ? std::vector{kInStore} : std::vector<int>{});
    expect_nothing_half_done();

    fs::remove_all(folder_ / "site");
    fs::copy(as_left, folder_ / "site", fs::copy_options::recursive);
    const auto again = restore();
    EXPECT_EQ(again.exit_code, 0) << again.err;
    expect_nothing_half_done();
    EXPECT_EQ(quarters_when_opened(), kInBackup);
    EXPECT_THAT(replaced(), Contains(kInStore));
  }
  EXPECT_TRUE(was_new);
  EXPECT_GT(nth, 20);
}

// A step of the next opener's work may be the end as well.
TEST_F(RestoreCommand, EndedWhileItIsFinishedItIsFinishedLater) {
  ASSERT_FALSE(testing::ends_before(1, [&] {
    recald::testing::before_file_change = [](const recald::testing::FileChange& change) {
      if (change.path.find(".restored-") != std::string::npos) ::_exit(testing::kKilled);
      return 0;
    };
    (void)restore();
  }));
  fs::remove_all(folder_ / "decided");
  fs::copy(folder_ / "site", folder_ / "decided", fs::copy_options::recursive);
  EXPECT_THAT(restore({"--dry-run"}).err, HasSubstr("a restoration was interrupted"));
  bool is_over = false;
  int nth = 1;
  for (; !is_over; ++nth) {
    SCOPED_TRACE(fmt::format("before change {}", nth));
    fs::remove_all(folder_ / "site");
    fs::copy(folder_ / "decided", folder_ / "site", fs::copy_options::recursive);
    is_over = testing::ends_before(nth, [&] { (void)restore(); });
    EXPECT_EQ(quarters_when_opened(), kInBackup);
    EXPECT_EQ(replaced(), std::vector{kInStore});
  }
  EXPECT_GT(nth, 3);
}

TEST_F(RestoreCommand, AFailureAtAnyStepIsSaidAndLosesNothing) {
  for (const bool lasts : {false, true}) {
    for (int nth = 1;; ++nth) {
      SCOPED_TRACE(fmt::format("change {} fails{}", nth, lasts ? ", and all after it" : ""));
      begin_anew();
      testing::Outcome outcome;
      bool has_failed = false;
      {
        const recald::testing::FailingChanges failing{nth, ENOSPC, lasts};
        outcome = restore();
        has_failed = failing.has_failed();
      }
      const int found = quarters_when_opened();
      if (outcome.exit_code == 0) {
        EXPECT_EQ(found, kInBackup);
      } else {
        EXPECT_THAT(outcome.err, HasSubstr("recald: "));
      }
      EXPECT_THAT(found, ::testing::AnyOf(kInBackup, kInStore));
      EXPECT_EQ(replaced(), found == kInBackup ? std::vector{kInStore} : std::vector<int>{});
      if (!has_failed) break;
    }
  }
}

}  // namespace
}  // namespace recald::daemon::restore_command_test
