/// Edits, samples, portions of a backup, transactions within transactions, readers beside a writer.
#include <gmock/gmock.h>

#include <thread>

#include "adapters/sqlite/backup.hpp"
#include "adapters/sqlite/edit_table.hpp"
#include "adapters/sqlite/sample_table.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::sqlite::store_tables_test {
namespace {

using metering::Instant;
using recald::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr std::chrono::seconds kQuarter{900};

class StoreTables : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "site.db"; }
  [[nodiscard]] static int intervals(SqliteStore& store, std::uint32_t meter) {
    int count = 0;
    const auto read = store.for_each_interval(meter, {Instant::min(), Instant::max()},
                                              [&](const StoredInterval&) { ++count; });
    EXPECT_TRUE(read.has_value()) << read.error().message;
    return count;
  }
  StoreBatch batch(int first, int count) {
    StoreBatch made;
    for (int i = first; i < first + count; ++i) {
      made.intervals.push_back({{main_, kStart + i * kQuarter, 10.0 + i}});
      made.samples.push_back({main_, "energy", kStart + i * kQuarter, 100.0 + i});
    }
    return made;
  }

  TemporaryFolder folder_;
  SqliteStore store_ = SqliteStore::open(file()).value();
  std::uint32_t main_ = store_.meter_number("main", kQuarter).value();
};

TEST_F(StoreTables, AnEditNamesItsIntervals) {
  const auto edit = insert_edit(store_.database(), {.time = kStart,
                                                    .author = "ada",
                                                    .reason = "the logger's own file",
                                                    .file = "may.csv",
                                                    .sha256 = "abc"});
  ASSERT_TRUE(edit.has_value());
  StoreBatch edited = batch(0, 2);
  edited.edit = *edit;
  ASSERT_TRUE(store_.commit(edited).has_value());
  ASSERT_TRUE(store_.commit(batch(2, 1)).has_value());
  auto rows = store_.database().prepare("SELECT edit FROM interval ORDER BY t_start").value();
  std::vector<bool> by_hand;
  while (rows.step().value()) by_hand.push_back(!rows.is_null(0) && rows.integer(0) == *edit);
  EXPECT_THAT(by_hand, ElementsAre(true, true, false));
  const auto edits = stored_edits(store_.database()).value();
  ASSERT_THAT(edits, SizeIs(1));
  EXPECT_EQ(edits[0].number, *edit);
  EXPECT_EQ(edits[0].time, kStart);
  EXPECT_EQ(edits[0].author, "ada");
  EXPECT_EQ(edits[0].reason, "the logger's own file");
  EXPECT_EQ(edits[0].file, "may.csv");
  EXPECT_EQ(edits[0].sha256, "abc");
  EXPECT_EQ(insert_edit(store_.database(), {.reason = ""}).error().code, ErrorCode::invalid_value);
}

TEST_F(StoreTables, OldSamplesGoAPortionAtATime) {
  const std::uint32_t cooling = store_.meter_number("cooling", kQuarter).value();
  StoreBatch samples = batch(0, 10);
  for (int i = 0; i < 10; ++i) {
    samples.samples.push_back({cooling, "energy", kStart + i * kQuarter, 1.0 * i});
  }
  ASSERT_TRUE(store_.commit(samples).has_value());
  const Instant keep_from = kStart + 6 * kQuarter;
  EXPECT_EQ(delete_old_samples(store_.database(), keep_from, 4).value(), 4);
  EXPECT_EQ(delete_old_samples(store_.database(), keep_from, 4).value(), 4);
  EXPECT_EQ(delete_old_samples(store_.database(), keep_from, 5).value(), 4);
  EXPECT_EQ(delete_old_samples(store_.database(), keep_from, 5).value(), 0);
  for (const std::uint32_t meter : {main_, cooling}) {
    std::vector<Instant> times;
    ASSERT_TRUE(for_each_sample(store_.database(), meter, "energy", [&](const auto& sample) {
                  times.push_back(sample.time);
                }).has_value());
    ASSERT_THAT(times, SizeIs(4));
    EXPECT_EQ(times.front(), keep_from);
  }
  EXPECT_EQ(intervals(store_, main_), 10);
}

TEST_F(StoreTables, ATransactionWithinAnotherIsAPartOfIt) {
  const auto fail = [] { return Result<int>{failure(ErrorCode::cancelled, "no")}; };
  const auto whole = store_.database().transaction([&]() -> Result<int> {
    EXPECT_TRUE(store_.commit(batch(0, 1)).has_value());
    const auto part = store_.database().transaction([&] {
      EXPECT_TRUE(store_.commit(batch(1, 1)).has_value());
      return fail();
    });
    EXPECT_FALSE(part.has_value());
    EXPECT_TRUE(store_.commit(batch(2, 1)).has_value());
    return 1;
  });
  EXPECT_TRUE(whole.has_value());
  EXPECT_EQ(intervals(store_, main_), 2);  // without the part that failed
  const auto undone = store_.database().transaction([&] {
    EXPECT_TRUE(store_.commit(batch(5, 3)).has_value());
    return fail();
  });
  EXPECT_FALSE(undone.has_value());
  EXPECT_EQ(intervals(store_, main_), 2);
}

TEST_F(StoreTables, ABackupInPortionsHasWhatCameMeanwhile) {
  ASSERT_TRUE(store_.commit(batch(0, 3000)).has_value());
  auto backup = Backup::begin(store_.database(), folder_ / "copy.db").value();
  int steps = 1;
  while (!backup.step(4).value()) {
    ASSERT_TRUE(store_.commit(batch(3000 + steps, 1)).has_value());
    ++steps;
  }
  EXPECT_GT(steps, 5);
  auto copy = SqliteStore::open(folder_ / "copy.db").value();
  EXPECT_EQ(intervals(copy, main_), 3000 + steps - 1);
  EXPECT_EQ(copy.database().quick_check().value(), "");
  {
    auto given_up = Backup::begin(store_.database(), folder_ / "none.db").value();
    (void)given_up.step(1);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.db"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.db.part"));
}

// A worker reads while the daemon writes and moves its log into the file: neither waits, and the
// reader sees whole commits only.
TEST_F(StoreTables, AReaderInAnotherThreadSeesWholeCommits) {
  ASSERT_TRUE(store_.database().execute("PRAGMA wal_autocheckpoint=10").has_value());
  ASSERT_TRUE(store_.commit(batch(0, 4)).has_value());
  std::atomic<bool> done{false};
  std::atomic<int> looks{0};
  std::string wrong;
  std::thread worker{[&] {
    auto reader = SqliteStore::open(file(), {.access = Database::Access::read_only});
    if (!reader) wrong = reader.error().message;
    while (reader && wrong.empty() && !done) {
      const int count = intervals(*reader, main_);
      if (count % 4 != 0) wrong = "half of a commit";
      if (reader->registers(main_).has_value() && reader->months(main_).has_value()) ++looks;
    }
    looks = looks == 0 ? -1 : looks.load();
    looks.notify_all();
  }};
  int commits = 1;
  for (; commits < 100 || (looks == 0 && commits < 100'000); ++commits) {
    ASSERT_TRUE(store_.commit(batch(4 * commits, 4)).has_value());
  }
  done = true;
  worker.join();
  EXPECT_EQ(wrong, "");
  EXPECT_GT(looks, 0);
  EXPECT_EQ(intervals(store_, main_), 4 * commits);
}

TEST_F(StoreTables, AReaderNeverMovesTheLog) {
  ASSERT_TRUE(store_.commit(batch(0, 400)).has_value());
  const auto size = [&] { return std::filesystem::file_size(file()); };
  const auto log = [&] { return std::filesystem::file_size(file().string() + "-wal"); };
  const auto size_before = size();
  const auto log_before = log();
  {
    auto reader = SqliteStore::open(file(), {.access = Database::Access::read_only}).value();
    EXPECT_EQ(intervals(reader, main_), 400);
    EXPECT_FALSE(reader.database().execute("INSERT INTO meter VALUES (9, 'x', 900)").has_value());
    EXPECT_TRUE(reader.find_meter("main").value().has_value());
  }
  EXPECT_EQ(size(), size_before);
  EXPECT_EQ(log(), log_before);
}

TEST_F(StoreTables, AReaderDoesNotUpgrade) {
  ASSERT_TRUE(store_.database().execute("PRAGMA user_version = 1").has_value());
  const auto reader = SqliteStore::open(file(), {.access = Database::Access::read_only});
  ASSERT_FALSE(reader.has_value());
  EXPECT_EQ(reader.error().code, ErrorCode::unsupported);
  EXPECT_THAT(reader.error().message, HasSubstr("schema version 1, this recald reads 4"));
}

}  // namespace
}  // namespace recald::sqlite::store_tables_test
