/// The store to run on where the disk is full, read-only or damaged.
#include "daemon/gateway/run/running_store.hpp"

#include <gmock/gmock.h>

#include <cerrno>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/file_faults.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::running_store_test {
namespace {

using recald::testing::FileChange;
using std::chrono::seconds;
using ::testing::HasSubstr;

const metering::Instant kNow = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};

class RunningStoreTest : public ::testing::Test {
 protected:
  RunningStoreTest() {
    config_.file = folder_ / "site.db";
    config_.backup_folder = folder_ / "backups";
  }
  ~RunningStoreTest() override { recald::testing::before_file_change = {}; }

  Result<RunningStore> open_to_run() { return open_running_store(opener_, config_, kNow, {}); }

  recald::testing::TemporaryFolder folder_;
  StoreConfig config_;
  StoreOpener opener_;
};

TEST_F(RunningStoreTest, OnAReadOnlyDiskItIsInMemoryUntilTheDiskIsNot) {
  recald::testing::before_file_change = [](const FileChange&) { return EROFS; };
  const auto running = open_to_run();
  ASSERT_TRUE(running.has_value()) << running.error().message;
  EXPECT_THAT(running->missing, HasSubstr("Read-only file system"));
  EXPECT_TRUE(running->store->meter_number("main", seconds{900}).has_value());
  EXPECT_FALSE(opener_.open(config_, kNow).has_value());
  EXPECT_EQ(opener_.wait(), seconds{10});
  recald::testing::before_file_change = {};
  EXPECT_TRUE(opener_.open(config_, kNow).has_value());
  EXPECT_FALSE(system::FileLock::acquire(folder_ / "site.db.lock").has_value());
}

TEST_F(RunningStoreTest, AnotherRecaldOnItIsNothingToWaitFor) {
  const auto lock = system::FileLock::acquire(folder_ / "site.db.lock");
  const auto running = open_to_run();
  ASSERT_FALSE(running.has_value());
  EXPECT_THAT(running.error().message, HasSubstr("is held by another recald"));
}

TEST_F(RunningStoreTest, WhateverIsThrownIsAFailure) {
  recald::testing::before_file_change = [](const FileChange&) -> int {
    throw std::runtime_error("unforeseen");
  };
  const auto opened = opener_.open(config_, kNow);
  recald::testing::before_file_change = {};
  ASSERT_FALSE(opened.has_value());
  EXPECT_THAT(opened.error().message, HasSubstr("site.db' cannot be opened: unforeseen"));
}

// Each try reads the whole of a store, and writes most of one.
TEST_F(RunningStoreTest, ARecoveryWithoutRoomLeavesNoHalfStoreAndIsTriedEverMoreRarely) {
  constexpr int kIntervals = 400;
  {
    auto store = sqlite::SqliteStore::open(config_.file).value();
    const std::uint32_t meter = store.meter_number("main", seconds{900}).value();
    StoreBatch batch;
    for (int i = 0; i < kIntervals; ++i) {
      batch.samples.push_back({meter, "energy", kNow + i * seconds{900}, 1.0 * i});
      batch.intervals.push_back({{meter, kNow + i * seconds{900}, 4.0}});
    }
    ASSERT_TRUE(store.commit(batch).has_value());
  }
  recald::testing::damage_leaf(config_.file, "sample", 0);
  // Full after some pages of the new store.
  int room = 0;
  recald::testing::before_file_change = [&](const FileChange& change) {
    const bool grows = change.call.starts_with("pwrite") &&
                       change.path.find("site.db.recovering") != std::string::npos;
    return grows && --room < 0 ? ENOSPC : 0;
  };
  for (const int wait_s : {20, 40, 80, 160, 320, 600, 600}) {
    room = 20;
    const auto opened = opener_.open(config_, kNow);
    ASSERT_FALSE(opened.has_value());
    EXPECT_EQ(opened.error().code, ErrorCode::io_failed);
    EXPECT_EQ(opener_.wait(), seconds{wait_s});
    for (const char* part : {"", "-wal", "-shm"}) {
      EXPECT_FALSE(std::filesystem::exists(folder_ / ("site.db.recovering" + std::string{part})));
    }
  }
  recald::testing::before_file_change = {};
  const auto opened = opener_.open(config_, kNow);
  ASSERT_TRUE(opened.has_value()) << opened.error().message;
  int intervals = 0;
  ASSERT_TRUE(opened->store
                  ->for_each_interval(0, {metering::Instant::min(), metering::Instant::max()},
                                      [&](const StoredInterval&) { ++intervals; })
                  .has_value());
  EXPECT_EQ(intervals, kIntervals);
}

}  // namespace
}  // namespace recald::daemon::running_store_test
