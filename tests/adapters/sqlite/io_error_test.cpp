/// io_error_nth: the n-th step on the disk fails, with each error that it can fail with, n raised
/// until a run passes without any. Whatever failed, all that was acknowledged is there, and the
/// same store goes on when the error is gone.
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <optional>
#include <ostream>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/faulty_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::sqlite::io_error_test {
namespace {

using metering::Instant;
using recald::testing::FaultyDisk;
using recald::testing::TemporaryFolder;
using Operation = FaultyDisk::Operation;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr std::chrono::seconds kQuarter{900};
constexpr int kBatches = 6;

StoreBatch batch_of(std::uint32_t meter, int number) {
  StoreBatch batch;
  for (int i = 0; i < 4; ++i) {
    batch.intervals.push_back({{meter, kStart + (4 * number + i) * kQuarter, 10.0 + number + i}});
  }
  batch.registers.push_back({meter, {.field = "energy", .settings = {.rated_kW = 100.0}}});
  batch.registers.back().state.book.next = kStart + (4 * number + 4) * kQuarter;
  batch.samples.push_back({meter, "energy", kStart + 4 * number * kQuarter, 1000.0 + number});
  batch.events.push_back({kStart, Severity::info, "test", "main", "batch"});
  return batch;
}

struct Failure {
  Operation operation;
  int code;
  const char* name;
  friend void PrintTo(const Failure& failure, std::ostream* out) { *out << failure.name; }
};
constexpr Failure kFailures[] = {
    {Operation::open, SQLITE_CANTOPEN, "open"},
    {Operation::read, SQLITE_IOERR_READ, "read"},
    {Operation::write, SQLITE_IOERR_WRITE, "write"},
    {Operation::write, SQLITE_FULL, "full_disk"},
    {Operation::truncate, SQLITE_IOERR_TRUNCATE, "truncate"},
    {Operation::sync, SQLITE_IOERR_FSYNC, "sync"},
    {Operation::remove, SQLITE_IOERR_DELETE, "remove"},
    {Operation::share, SQLITE_IOERR_SHMMAP, "shared_memory"},
};

/// Fails one step of a kind, or that and all after it.
class IoError : public ::testing::TestWithParam<std::tuple<Failure, bool>> {
 protected:
  void fail_from(int nth) {
    const auto& [failure, lasting] = GetParam();
    seen_ = 0;
    failed_ = false;
    disk_.before = [this, nth, failure, lasting](const FaultyDisk::Step& step) {
      if (step.operation != failure.operation || ++seen_ < nth) return 0;
      if (!lasting && seen_ > nth) return 0;
      failed_ = true;
      return failure.code;
    };
  }
  void mend() { disk_.before = {}; }

  /// Opens, or mends the disk and opens.
  SqliteStore open() {
    auto opened = SqliteStore::open(folder_ / "site.db", {.vfs = disk_.name()});
    if (opened) return std::move(*opened);
    EXPECT_TRUE(failed_) << opened.error().message;
    mend();
    opened = SqliteStore::open(folder_ / "site.db", {.vfs = disk_.name()});
    EXPECT_TRUE(opened.has_value()) << opened.error().message;
    return std::move(opened.value());
  }

  /// As the daemon does: what is refused is tried again once the disk is mended.
  void commit(SqliteStore& store, const StoreBatch& batch) {
    auto counts = store.commit(batch);
    if (!counts) {
      EXPECT_TRUE(failed_) << counts.error().message;
      EXPECT_EQ(counts.error().code, ErrorCode::io_failed) << counts.error().message;
      mend();
      counts = store.commit(batch);
    }
    ASSERT_TRUE(counts.has_value()) << counts.error().message;
    EXPECT_EQ(counts->taken + counts->duplicates, 4);
    EXPECT_THAT(counts->conflicts, ::testing::IsEmpty());
  }

  std::uint32_t meter_number(SqliteStore& store) {
    auto number = store.meter_number("main", kQuarter);
    if (!number) {
      EXPECT_TRUE(failed_) << number.error().message;
      mend();
      number = store.meter_number("main", kQuarter);
    }
    return number.value();
  }

  static std::vector<double> values(SqliteStore& store) {
    std::vector<double> found;
    const auto read = store.for_each_interval(
        0, {Instant::min(), Instant::max()},
        [&](const StoredInterval& interval) { found.push_back(interval.reading.mean_kW); });
    EXPECT_TRUE(read.has_value()) << read.error().message;
    return found;
  }

  TemporaryFolder folder_;
  FaultyDisk disk_{"io-error"};
  int seen_ = 0;
  bool failed_ = false;
};

TEST_P(IoError, CostsNothingAndIsSurvived) {
  std::vector<double> expected;
  for (int number = 0; number < kBatches; ++number) {
    for (int i = 0; i < 4; ++i) expected.push_back(10.0 + number + i);
  }
  bool any_failed = false;
  for (int nth = 1;; ++nth) {
    SCOPED_TRACE(nth);
    for (const auto& entry : std::filesystem::directory_iterator{folder_.path()}) {
      std::filesystem::remove(entry);
    }
    fail_from(nth);
    {
      SqliteStore store = open();
      (void)store.database().execute("PRAGMA wal_autocheckpoint=8");
      const std::uint32_t meter = meter_number(store);
      for (int number = 0; number < kBatches; ++number) {
        commit(store, batch_of(meter, number));
      }
    }
    const bool failed = failed_;
    any_failed |= failed;
    mend();
    SqliteStore store = open();
    ASSERT_EQ(store.database().quick_check().value(), "");
    ASSERT_EQ(values(store), expected);
    ASSERT_EQ(store.registers(0)->size(), 1u);
    ASSERT_EQ(store.events(100)->size(), static_cast<std::size_t>(kBatches));
    if (!failed) break;
  }
  EXPECT_TRUE(any_failed);
}

INSTANTIATE_TEST_SUITE_P(AllOf, IoError,
                         ::testing::Combine(::testing::ValuesIn(kFailures), ::testing::Bool()),
                         [](const auto& given) {
                           return std::string{std::get<0>(given.param).name} +
                                  (std::get<1>(given.param) ? "_lasting" : "_once");
                         });

}  // namespace
}  // namespace recald::sqlite::io_error_test
