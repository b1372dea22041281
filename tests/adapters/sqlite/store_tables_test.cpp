/// Edits, samples, portions of a backup, transactions within transactions, readers beside a writer.
#include <gmock/gmock.h>

#include <thread>

#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/sqlite/tables/tables.hpp"
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
  const auto edit = store_.add_edit({.time = kStart,
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
  EXPECT_THAT(*store_.edited_days(main_), ElementsAre(kStart));
  auto row = store_.database().prepare("SELECT t, author, reason, file, sha256 FROM edit").value();
  ASSERT_TRUE(row.step().value());
  EXPECT_EQ(row.integer(0), kStart.time_since_epoch().count());
  EXPECT_EQ(row.text(1), "ada");
  EXPECT_EQ(row.text(2), "the logger's own file");
  EXPECT_EQ(row.text(3), "may.csv");
  EXPECT_EQ(row.text(4), "abc");
  EXPECT_EQ(store_.add_edit({.reason = ""}).error().code, ErrorCode::invalid_value);
}

TEST_F(StoreTables, AnEditedDayIsOneWhateverCameAfterwards) {
  const auto edit = store_.add_edit({.time = kStart, .reason = "by hand"}).value();
  StoreBatch edited = batch(96 + 95, 2);  // the last quarter of the second day and one more
  for (auto& interval : edited.intervals) interval.reading.validity = metering::Validity::scaled;
  edited.edit = edit;
  ASSERT_TRUE(store_.commit(edited).has_value());
  ASSERT_TRUE(store_.commit(batch(0, 4 * 96)).has_value());  // measured after all
  using std::chrono::days;
  EXPECT_THAT(*store_.edited_days(main_), ElementsAre(kStart + days{1}, kStart + days{2}));
  EXPECT_THAT(*store_.edited_days(main_ + 1), SizeIs(0));
}

TEST_F(StoreTables, AnEditThatPutNothingInIsForgotten) {
  const auto empty = store_.add_edit({.time = kStart, .reason = "nothing new"}).value();
  const auto other = store_.add_edit({.time = kStart, .reason = "stays"}).value();
  ASSERT_TRUE(store_.remove_edit(empty).has_value());
  auto row = store_.database().prepare("SELECT number FROM edit").value();
  ASSERT_TRUE(row.step().value());
  EXPECT_EQ(row.integer(0), other);
  EXPECT_FALSE(row.step().value());
}

TEST_F(StoreTables, OldSamplesGoAPortionAtATime) {
  const std::uint32_t cooling = store_.meter_number("cooling", kQuarter).value();
  StoreBatch samples = batch(0, 10);
  for (int i = 0; i < 10; ++i) {
    samples.samples.push_back({cooling, "energy", kStart + i * kQuarter, 1.0 * i});
  }
  ASSERT_TRUE(store_.commit(samples).has_value());
  const Instant keep_from = kStart + 6 * kQuarter;
  EXPECT_EQ(store_.delete_samples(keep_from, 4).value(), 4);
  EXPECT_EQ(store_.delete_samples(keep_from, 4).value(), 4);
  EXPECT_EQ(store_.delete_samples(keep_from, 5).value(), 4);
  EXPECT_EQ(store_.delete_samples(keep_from, 5).value(), 0);
  for (const std::uint32_t meter : {main_, cooling}) {
    std::vector<Instant> times;
    ASSERT_TRUE(store_
                    .for_each_sample(meter, "energy",
                                     [&](const auto& sample) { times.push_back(sample.time); })
                    .has_value());
    ASSERT_THAT(times, SizeIs(4));
    EXPECT_EQ(times.front(), keep_from);
  }
  EXPECT_EQ(intervals(store_, main_), 10);
}

TEST_F(StoreTables, WhatIsDoneAsOneMayHaveParts) {
  const auto fail = [] { return Result<void>{failure(ErrorCode::cancelled, "no")}; };
  const auto whole = store_.as_one([&]() -> Result<void> {
    EXPECT_TRUE(store_.commit(batch(0, 1)).has_value());
    const auto part = store_.as_one([&] {
      EXPECT_TRUE(store_.commit(batch(1, 1)).has_value());
      return fail();
    });
    EXPECT_FALSE(part.has_value());
    EXPECT_TRUE(store_.commit(batch(2, 1)).has_value());
    return {};
  });
  EXPECT_TRUE(whole.has_value());
  EXPECT_EQ(intervals(store_, main_), 2);  // without the part that failed
  const auto undone = store_.as_one([&] {
    EXPECT_TRUE(store_.commit(batch(5, 3)).has_value());
    return fail();
  });
  ASSERT_FALSE(undone.has_value());
  EXPECT_EQ(undone.error().code, ErrorCode::cancelled);
  EXPECT_EQ(intervals(store_, main_), 2);
  EXPECT_EQ(store_.commit(batch(5, 3)).value().taken, 3);  // as if it had never been tried
  EXPECT_EQ(store_.commit(batch(5, 3)).value().duplicates, 3);
}

TEST_F(StoreTables, ABackupInPortionsHasWhatCameMeanwhile) {
  ASSERT_TRUE(store_.commit(batch(0, 3000)).has_value());
  const auto backup = store_.begin_backup(folder_ / "copy.db").value();
  int steps = 1;
  while (!backup->step(4).value()) {
    ASSERT_TRUE(store_.commit(batch(3000 + steps, 1)).has_value());
    ++steps;
  }
  EXPECT_GT(steps, 5);
  ASSERT_TRUE(backup->keep().has_value());
  auto copy = SqliteStore::open(folder_ / "copy.db").value();
  EXPECT_EQ(intervals(copy, main_), 3000 + steps - 1);
  EXPECT_EQ(copy.check().value().damage, "");
  {
    const auto given_up = store_.begin_backup(folder_ / "none.db").value();
    (void)given_up->step(1);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.db"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.db.part"));
}

// Nobody waits for a check when the process ends.
TEST_F(StoreTables, ACheckOfABackupCanBeStopped) {
  ASSERT_TRUE(store_.commit(batch(0, 3000)).has_value());
  const auto backup = store_.begin_backup(folder_ / "copy.db").value();
  ASSERT_TRUE(backup->step(10'000).value());
  std::stop_source stop;
  EXPECT_EQ(backup->check(stop.get_token()).value(), "");
  stop.request_stop();
  const auto stopped = backup->check(stop.get_token());
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

TEST_F(StoreTables, ReadMeansAGoodInterval) {
  const auto day = std::chrono::days{1};
  StoreBatch some = batch(0, 4);
  some.intervals.push_back({{.meter = main_,
                             .start = kStart + day,
                             .mean_kW = 1.0,
                             .validity = metering::Validity::filled}});
  ASSERT_TRUE(store_.commit(some).has_value());
  EXPECT_TRUE(store_.was_read_in({kStart, kStart + kQuarter}).value());
  EXPECT_TRUE(store_.was_read_in({kStart - day, kStart + kQuarter}).value());
  EXPECT_FALSE(store_.was_read_in({kStart - day, kStart}).value());
  EXPECT_FALSE(store_.was_read_in({kStart + day, kStart + 2 * day}).value());
}

TEST_F(StoreTables, AStoreSaysWhatIsWrongWithIt) {
  ASSERT_TRUE(store_.commit(batch(0, 100)).has_value());
  StoreCheck check = store_.check().value();
  EXPECT_EQ(check.damage, "");
  EXPECT_THAT(check.problems, SizeIs(0));
  EXPECT_EQ(check.intervals, 100u);
  ASSERT_TRUE(store_.database()
                  .execute("UPDATE interval SET revision = 2, sum = NULL WHERE t_start % 1800 = 0")
                  .has_value());
  check = store_.check().value();
  ASSERT_THAT(check.problems, SizeIs(21));  // of a kind, 20 and how many more
  EXPECT_EQ(check.problems[0],
            "meter 'main': the revisions of the interval at 2024-03-01 00:00:00 UTC have a gap");
  EXPECT_EQ(check.problems[20], "… and 30 more like the last one");
  EXPECT_EQ(check.intervals, 100u);
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
  {
    auto older = Database::open(folder_ / "older.db", {});
    ASSERT_TRUE(bring_up_to_date(*older, 1).has_value());
  }
  const auto reader =
      SqliteStore::open(folder_ / "older.db", {.access = Database::Access::read_only});
  ASSERT_FALSE(reader.has_value());
  EXPECT_EQ(reader.error().code, ErrorCode::unsupported);
  EXPECT_THAT(reader.error().message, HasSubstr("schema version 1, but this recald reads 7"));
}

TEST_F(StoreTables, EventsAreGivenOutFromACursorOn) {
  EXPECT_FALSE(store_.cursor("mail").value().has_value());
  for (const char* kind : {"first", "second", "third"}) {
    ASSERT_TRUE(
        store_.commit({.events = {{kStart, Severity::info, kind, "main", "."}}}).has_value());
  }
  const auto all = store_.events_after(0, 10).value();
  ASSERT_EQ(all.size(), 3);
  ASSERT_TRUE(store_.put_cursor("mail", all[0].number).has_value());
  ASSERT_TRUE(store_.put_cursor("mail", all[1].number).has_value());
  ASSERT_TRUE(store_.put_cursor("webhook", all[0].number).has_value());
  EXPECT_EQ(store_.cursor("mail").value(), all[1].number);
  const auto left = store_.events_after(all[1].number, 10).value();
  ASSERT_EQ(left.size(), 1);
  EXPECT_EQ(left[0].kind, "third");
  EXPECT_EQ(left[0].number, store_.events(1)->front().number);
  EXPECT_EQ(store_.events_after(0, 2)->size(), 2);
  EXPECT_EQ(wrong_sums(store_.database()).value(), "");
}

// Otherwise a destination would take a new event for one that it was told.
TEST_F(StoreTables, TheNumberOfADeletedEventIsNotGivenAgain) {
  ASSERT_TRUE(store_.commit({.events = {{kStart, Severity::info, "old", "", "."}}}).has_value());
  const std::int64_t told = store_.events(1)->front().number;
  ASSERT_TRUE(store_.put_cursor("mail", told).has_value());
  ASSERT_EQ(store_.delete_events(kStart + std::chrono::days{1}, 10).value(), 1);
  ASSERT_TRUE(store_.commit({.events = {{kStart, Severity::info, "new", "", "."}}}).has_value());
  EXPECT_THAT(*store_.events_after(told, 10), SizeIs(1));
}

}  // namespace
}  // namespace recald::sqlite::store_tables_test
