/// Daily backups, old samples, the reserve, and what is done about a damaged store at the start.
#include "daemon/gateway/upkeep/upkeep.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/upkeep/backups.hpp"
#include "daemon/gateway/upkeep/job_folder.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/faulty_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using recald::testing::FaultyDisk;
using recald::testing::TemporaryFolder;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Does its work at once.
class PromptWorker final : public Worker {
 public:
  void run(std::function<void()> work, Loop::Call done) override {
    work();
    done();
  }
};

/// Midnight in Chicago.
const Instant kMidnight = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1} + hours{6};
constexpr std::uintmax_t kReserve = 256 * 1024;

class UpkeepTest : public ::testing::Test {
 protected:
  UpkeepTest() {
    config_ = default_store(folder_ / "site.toml");
    rules_.reserve_bytes = kReserve;
    rules_.backup_pages = 8;
    rules_.rows = 100;
  }
  /// One good reading a day, without which nothing is old.
  static void commit_readings(Store& store, Instant first, int count) {
    StoreBatch batch;
    for (int day = 0; day < count; ++day) {
      batch.intervals.push_back({{0, first + day * days{1}, 1.0}});
    }
    ASSERT_TRUE(store.commit(batch).has_value());
  }
  void commit_samples(Store& store, Instant first, int count) {
    StoreBatch batch;
    for (int i = 0; i < count; ++i) {
      batch.samples.push_back({0, "energy", first + i * minutes{15}, 1.0 * i});
    }
    ASSERT_TRUE(store.commit(batch).has_value());
  }
  /// Where events go to.
  static std::function<void(StoreEvent)> into(Store& store) {
    return [&store](StoreEvent event) {
      EXPECT_TRUE(store.commit({.events = {std::move(event)}}).has_value());
    };
  }
  /// Until there is no more to do. @return how many portions it took.
  int maintain(Upkeep& upkeep, Instant now, bool is_clock_right = true) {
    int portions = 1;
    while ((rest_ = upkeep.maintain(now, is_clock_right)) == rules_.pause) ++portions;
    return portions;
  }
  static int samples(Store& store) {
    int count = 0;
    (void)store.for_each_sample(0, "energy", [&](const auto&) { ++count; });
    return count;
  }
  sqlite::SqliteStore open() {
    auto store = sqlite::SqliteStore::open(config_.file).value();
    (void)store.meter_number("main", minutes{15});
    return store;
  }

  TemporaryFolder folder_;
  StoreConfig config_;
  UpkeepRules rules_;
  PromptWorker checker_;
  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  milliseconds rest_{0};
};

TEST_F(UpkeepTest, ABackupADayAtItsTimeAndSevenAreKept) {
  auto store = open();
  commit_samples(store, kMidnight, 2000);
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  EXPECT_EQ(maintain(upkeep, kMidnight + hours{3}), 1);
  EXPECT_EQ(rest_, minutes{15});  // until 3:15
  EXPECT_THAT(backups_of(config_), IsEmpty());
  EXPECT_GT(maintain(upkeep, kMidnight + hours{3} + minutes{15}), 3);
  EXPECT_EQ(rest_, hours{1});
  ASSERT_THAT(backups_of(config_), ElementsAre(folder_ / "backups" / "site-2024-03-01.db"));
  auto copy = sqlite::SqliteStore::open(backups_of(config_)[0]).value();
  EXPECT_EQ(samples(copy), 2000);
  EXPECT_EQ(maintain(upkeep, kMidnight + hours{20}), 1);  // once a day
  recald::testing::write_text(folder_ / "backups" / "site-notes.db", "mine");
  for (int day = 1; day <= 9; ++day) maintain(upkeep, kMidnight + days{day} + hours{9});
  const auto kept = backups_of(config_);
  ASSERT_THAT(kept, SizeIs(kBackupsKept));
  EXPECT_EQ(kept.front().filename(), "site-2024-03-10.db");
  EXPECT_EQ(kept.back().filename(), "site-2024-03-04.db");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "backups" / "site-notes.db"));
}

TEST_F(UpkeepTest, ABackupThatFailsIsOneEventAndTriedAgain) {
  auto store = open();
  recald::testing::write_text(folder_ / "backups", "in the way");
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  for (int hour = 4; hour < 8; ++hour) maintain(upkeep, kMidnight + hours{hour});
  const auto events = store.events(10).value();
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].kind, "backup_failed");
  std::filesystem::remove(folder_ / "backups");
  maintain(upkeep, kMidnight + hours{9});
  EXPECT_THAT(backups_of(config_), SizeIs(1));
}

TEST_F(UpkeepTest, WithoutABackupTimeThereIsNone) {
  config_.backup_at.reset();
  auto store = open();
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  maintain(upkeep, kMidnight + hours{12});
  EXPECT_EQ(rest_, hours{1});
  EXPECT_THAT(backups_of(config_), IsEmpty());
}

TEST_F(UpkeepTest, OldSamplesAreDeletedInPortions) {
  config_.backup_at.reset();
  config_.raw_kept = days{2};
  auto store = open();
  commit_readings(store, kMidnight - days{10}, 3);
  commit_samples(store, kMidnight, 3 * 96);
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  EXPECT_GE(maintain(upkeep, kMidnight + days{4}), 2);
  EXPECT_EQ(samples(store), 96);
}

TEST_F(UpkeepTest, OldEventsAreDeleted) {
  config_.backup_at.reset();
  config_.events_kept = days{10};
  auto store = open();
  commit_readings(store, kMidnight, 30);
  for (int day = 0; day < 30; ++day) {
    StoreBatch batch;
    for (int i = 0; i < 40; ++i) {
      batch.events.push_back({kMidnight + days{day}, Severity::info, "test", "main", "x"});
    }
    ASSERT_TRUE(store.commit(batch).has_value());
  }
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  EXPECT_GE(maintain(upkeep, kMidnight + days{29}), 5);
  EXPECT_THAT(store.events(10'000).value(), SizeIs(11 * 40));
}

TEST_F(UpkeepTest, OldResultsGoWithTheirFilesButNotTheOneInUse) {
  config_.backup_at.reset();
  config_.results_kept = 3;
  auto store = open();
  for (int i = 1; i <= 10; ++i) {
    const auto number = store.add_job({.state = JobState::done,
                                       .asked_by = "api",
                                       .asked = kMidnight,
                                       .ended = kMidnight,
                                       .accepted = i <= 2});
    std::filesystem::create_directories(job_folder(config_, JobKind::calibration, *number));
  }
  ASSERT_TRUE(store.add_job({.asked_by = "api", .asked = kMidnight}).has_value());
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  maintain(upkeep, kMidnight);
  std::vector<std::int64_t> kept;
  const auto jobs = store.jobs(JobKind::calibration, 100).value();
  for (const StoredJob& job : jobs) kept.push_back(job.number);
  EXPECT_THAT(kept, ElementsAre(11, 10, 9, 8, 2));
  for (std::int64_t number = 1; number <= 10; ++number) {
    EXPECT_EQ(std::filesystem::exists(job_folder(config_, JobKind::calibration, number)),
              number >= 8 || number == 2)
        << number;
  }
}

// A poor store is backed up each day; the good copies from before may have what it lost.
TEST_F(UpkeepTest, BackupsFromBeforeADamageStayUntilItIsCleared) {
  auto store = open();
  recald::testing::write_text(folder_ / "site.db.damaged-20240304T120000Z", "");
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  for (int day = 0; day < 20; ++day) maintain(upkeep, kMidnight + days{day} + hours{4});
  EXPECT_THAT(backups_of(config_), SizeIs(7 + 4));
  EXPECT_EQ(backups_of(config_).back().filename(), "site-2024-03-01.db");
  std::filesystem::remove(folder_ / "site.db.damaged-20240304T120000Z");
  maintain(upkeep, kMidnight + days{20} + hours{4});
  EXPECT_THAT(backups_of(config_), SizeIs(7));
}

/// While it lives, this process works in another folder.
class WorkingFolder {
 public:
  explicit WorkingFolder(const std::filesystem::path& folder)
      : before_(std::filesystem::current_path()) {
    std::filesystem::current_path(folder);
  }
  ~WorkingFolder() { std::filesystem::current_path(before_); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  std::filesystem::path before_;
};

// `recald run site.toml`, in the site's folder.
TEST_F(UpkeepTest, BackupsStayWithASiteInTheWorkingFolderToo) {
  const WorkingFolder here{folder_.path()};
  config_ = default_store("site.toml");
  auto store = open();
  recald::testing::write_text("site.db.damaged-20240304T120000Z", "");
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  for (int day = 0; day < 10; ++day) maintain(upkeep, kMidnight + days{day} + hours{4});
  EXPECT_THAT(backups_of(config_), SizeIs(10));
}

// Between two damages too: what the second has lost may be there alone.
TEST_F(UpkeepTest, BackupsFromBeforeTheLastDamageStay) {
  auto store = open();
  recald::testing::write_text(folder_ / "site.db.damaged-20240301T120000Z", "");
  recald::testing::write_text(folder_ / "site.db.damaged-20240305T120000Z-2", "");
  recald::testing::write_text(folder_ / "site.db.damaged-20240312T120000Z-wal", "left behind");
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  for (int day = 0; day < 20; ++day) maintain(upkeep, kMidnight + days{day} + hours{4});
  EXPECT_THAT(backups_of(config_), SizeIs(7 + 5));
}

// A gateway without a battery is switched on in 1970, and its store is damaged: the backups that
// are there are from before, whatever the clock says.
TEST_F(UpkeepTest, ARecoveryBeforeTheClockIsSetKeepsItsBackups) {
  {
    auto store = open();
    commit_samples(store, kMidnight, 2000);
    commit_readings(store, kMidnight - days{30}, 37);
    Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
    for (int day = 0; day < 7; ++day) maintain(upkeep, kMidnight + days{day} + hours{4});
  }
  recald::testing::damage_leaf(config_.file, "sample", 5);
  auto opened = open_store(config_, Instant{std::chrono::seconds{40}}).value();
  ASSERT_NE(opened.recovery, "");
  Upkeep upkeep{*opened.store, checker_, config_, calendar_, into(*opened.store), rules_};
  for (int day = 8; day < 28; ++day) {
    commit_readings(*opened.store, kMidnight + days{day}, 1);
    maintain(upkeep, kMidnight + days{day} + hours{4});
  }
  EXPECT_THAT(backups_of(config_), SizeIs(7 + 7));
  EXPECT_EQ(backups_of(config_).back().filename(), "site-2024-03-01.db");
  EXPECT_EQ(opened.store->events(1).value().at(0).kind, "store_recovered");
}

// A day begins in Auckland while it is still yesterday in Greenwich.
TEST_F(UpkeepTest, ABackupOfTheMorningInTheEastIsFromBefore) {
  const auto auckland = metering::LocalCalendar::open("Pacific/Auckland").value();
  const Instant morning = auckland.first_instant(std::chrono::year{2024} / 3 / 10, 4 * 60);
  {
    auto store = open();
    commit_samples(store, kMidnight, 2000);
    Upkeep upkeep{store, checker_, config_, auckland, into(store), rules_};
    maintain(upkeep, morning);
  }
  recald::testing::damage_leaf(config_.file, "sample", 5);
  auto opened = open_store(config_, morning + hours{1}).value();
  ASSERT_NE(opened.recovery, "");
  Upkeep upkeep{*opened.store, checker_, config_, auckland, into(*opened.store), rules_};
  for (int day = 1; day < 20; ++day) maintain(upkeep, morning + days{day});
  EXPECT_EQ(backups_of(config_).back().filename(), "site-2024-03-10.db");
}

TEST_F(UpkeepTest, ADamagedCopyDisplacesNoBackup) {
  for (const bool in_a_value : {false, true}) {
    SCOPED_TRACE(in_a_value);
    std::filesystem::remove_all(folder_ / "backups");
    std::filesystem::remove(config_.file);
    {
      auto store = open();
      commit_samples(store, kMidnight, 2000);
      Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
      for (int day = 0; day < 7; ++day) maintain(upkeep, kMidnight + days{day} + hours{4});
    }
    const auto good = backups_of(config_);
    ASSERT_THAT(good, SizeIs(7));
    if (!in_a_value) recald::testing::damage_leaf(config_.file, "sample", 5);
    auto store = open();
    if (in_a_value) {
      ASSERT_TRUE(store.database().execute("UPDATE sample SET value = 1 WHERE t % 3600 = 0"));
    }
    Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
    for (int hour = 0; hour < 3 * 24; ++hour) {
      maintain(upkeep, kMidnight + days{7} + hours{4 + hour});
    }
    EXPECT_THAT(backups_of(config_), ::testing::ElementsAreArray(good));
    const auto events = store.events(1).value();
    ASSERT_THAT(events, SizeIs(1));
    EXPECT_EQ(events[0].kind, "store_damaged");
    EXPECT_EQ(events[0].severity, Severity::error);
    for (const auto& entry : std::filesystem::directory_iterator{folder_ / "backups"}) {
      EXPECT_EQ(entry.path().extension(), ".db");
    }
  }
}

/// Keeps its work until it is told to do it.
class SlowWorker final : public Worker {
 public:
  void run(std::function<void()> work, Loop::Call done) override {
    ASSERT_FALSE(work_);
    work_ = std::move(work);
    done_ = std::move(done);
  }
  [[nodiscard]] bool is_busy() const { return work_ != nullptr; }
  void finish() {
    std::exchange(work_, nullptr)();
    std::exchange(done_, nullptr)();
  }

 private:
  std::function<void()> work_;
  Loop::Call done_;
};

TEST_F(UpkeepTest, NothingWaitsForTheCheckOfABackup) {
  SlowWorker slow;
  auto store = open();
  commit_samples(store, kMidnight, 2000);
  {
    Upkeep upkeep{store, slow, config_, calendar_, into(store), rules_};
    maintain(upkeep, kMidnight + hours{4});
    EXPECT_EQ(rest_, hours{1});
    EXPECT_TRUE(slow.is_busy());
    EXPECT_THAT(backups_of(config_), IsEmpty());
    maintain(upkeep, kMidnight + hours{30});  // one at a time
    slow.finish();
    EXPECT_THAT(backups_of(config_), SizeIs(1));
    maintain(upkeep, kMidnight + hours{31});
    EXPECT_TRUE(slow.is_busy());
  }
  slow.finish();  // the upkeep is gone
  EXPECT_THAT(backups_of(config_), SizeIs(1));
}

// A clock set years ahead for some hours: meters are read under its stamps, and what it makes old
// at once stays.
TEST_F(UpkeepTest, AClockYearsAheadDeletesNothing) {
  config_.backup_at.reset();
  config_.events_kept = days{10};
  auto store = open();
  commit_readings(store, kMidnight, 30);
  commit_samples(store, kMidnight, 300);
  ASSERT_TRUE(
      store.commit({.events = {{kMidnight + days{25}, Severity::info, "test", "main", "x"}}})
          .has_value());
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  const Instant ahead = kMidnight + days{30 + 3 * 365};
  for (int hour = 0; hour < 12; ++hour) {
    commit_readings(store, ahead + hours{hour}, 1);
    maintain(upkeep, ahead + hours{hour + 1});
  }
  EXPECT_EQ(samples(store), 300);
  EXPECT_THAT(store.events(10).value(), SizeIs(1));
  commit_readings(store, ahead, 9);  // it was right: the gateway had been off for three years
  maintain(upkeep, ahead + days{9});
  EXPECT_EQ(samples(store), 0);
  EXPECT_THAT(store.events(10).value(), IsEmpty());
}

TEST_F(UpkeepTest, AClockThatIsNotSetMakesNoBackup) {
  auto store = open();
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  maintain(upkeep, Instant{hours{12}}, false);
  EXPECT_FALSE(std::filesystem::exists(config_.backup_folder));
  maintain(upkeep, kMidnight + hours{12});
  EXPECT_TRUE(std::filesystem::exists(config_.backup_folder));
}

TEST_F(UpkeepTest, AFullDiskTakesTheReserveAndTheCommitIsThere) {
  const auto reserve = folder_ / "site.db.reserve";
  FaultyDisk disk{"full"};
  auto store = sqlite::SqliteStore::open(config_.file, {.vfs = disk.name()}).value();
  (void)store.meter_number("main", minutes{15});
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  maintain(upkeep, kMidnight);
  EXPECT_EQ(std::filesystem::file_size(reserve), kReserve);
  int refused = 0;
  disk.before = [&](const FaultyDisk::Step& step) {
    const bool is_full =
        step.operation == FaultyDisk::Operation::write && std::filesystem::exists(reserve);
    refused += static_cast<int>(is_full);
    return is_full ? SQLITE_FULL : SQLITE_OK;
  };
  commit_samples(store, kMidnight, 10);
  EXPECT_EQ(samples(store), 10);
  EXPECT_EQ(refused, 1);
  EXPECT_FALSE(std::filesystem::exists(reserve));
  disk.before = [](const FaultyDisk::Step& step) {
    return step.operation == FaultyDisk::Operation::write ? SQLITE_FULL : SQLITE_OK;
  };
  EXPECT_FALSE(store.commit({.samples = {{0, "energy", kMidnight + days{1}, 1.0}}}).has_value());
  disk.before = {};
  maintain(upkeep, kMidnight + hours{1});
  EXPECT_TRUE(std::filesystem::exists(reserve));
}

TEST_F(UpkeepTest, AReserveThatWouldFillTheDiskIsNotTaken) {
  rules_.reserve_bytes = std::filesystem::space(folder_.path()).available;
  auto store = open();
  Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
  maintain(upkeep, kMidnight);
  maintain(upkeep, kMidnight + hours{1});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "site.db.reserve"));
  EXPECT_EQ(store.events(1).value().at(0).kind, "no_reserve");
}

TEST_F(UpkeepTest, ADamagedStoreIsRecoveredWithTheBackupsHelp) {
  {
    auto store = open();
    commit_samples(store, kMidnight, 2000);
    Upkeep upkeep{store, checker_, config_, calendar_, into(store), rules_};
    maintain(upkeep, kMidnight + hours{4});
  }
  recald::testing::damage_leaf(config_.file, "sample", 5);
  auto opened = open_store(config_, kMidnight + hours{5}).value();
  ASSERT_NE(opened.recovery, "");
  EXPECT_EQ(samples(*opened.store), 2000);
  const auto event = opened.store->events(1).value().at(0);
  EXPECT_EQ(event.kind, "store_recovered");
  EXPECT_EQ(event.severity, Severity::error);
  EXPECT_THAT(event.text, ::testing::HasSubstr("the backup was 'site-2024-03-01.db'"));
  EXPECT_EQ(event.text, opened.recovery);
  EXPECT_EQ(open_store(config_, kMidnight + hours{6}).value().recovery, "");
}

}  // namespace
}  // namespace recald::daemon
