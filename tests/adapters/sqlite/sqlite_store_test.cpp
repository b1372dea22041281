/// The store on real SQLite files: what is committed is there again, what fails leaves no trace.
#include "adapters/sqlite/sqlite_store.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <zlib.h>

#include <cmath>
#include <string>
#include <utility>

#include "adapters/sqlite/tables/register_json.hpp"
#include "adapters/sqlite/tables/schema.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::sqlite::sqlite_store_test {
namespace {

using metering::Instant;
using metering::Reading;
using metering::TimeSpan;
using metering::Validity;
using recald::testing::TemporaryFolder;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr seconds kQuarter{900};
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Reading reading(std::uint32_t meter, int quarter, double mean_kW,
                Validity validity = Validity::ok) {
  return {meter, kStart + quarter * kQuarter, mean_kW, validity};
}

class StoreFile : public ::testing::Test {
 protected:
  void SetUp() override { reopen(); }

  void reopen() {
    store_.reset();
    auto opened = SqliteStore::open(file());
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    store_ = std::make_unique<SqliteStore>(std::move(*opened));
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "site.db"; }

  std::uint32_t meter(const std::string& id, seconds interval = kQuarter) {
    const auto number = store_->meter_number(id, interval);
    EXPECT_TRUE(number.has_value()) << number.error().message;
    return number.value_or(99);
  }
  CommitCounts commit(const StoreBatch& batch) {
    const auto counts = store_->commit(batch);
    EXPECT_TRUE(counts.has_value()) << counts.error().message;
    return counts.value_or(CommitCounts{});
  }
  std::vector<StoredInterval> intervals(std::uint32_t number) {
    std::vector<StoredInterval> found;
    const auto read = store_->for_each_interval(
        number, {Instant::min(), Instant::max()},
        [&](const StoredInterval& interval) { found.push_back(interval); });
    EXPECT_TRUE(read.has_value()) << read.error().message;
    return found;
  }

  TemporaryFolder folder_;
  std::unique_ptr<SqliteStore> store_;
};

TEST_F(StoreFile, KeepsIntervalsOverARestart) {
  const std::uint32_t main = meter("main");
  const std::uint32_t chilled = meter("chilled");
  EXPECT_NE(main, chilled);
  Reading late = reading(main, 2, 31.5, Validity::suspect);
  late.late = true;
  late.reasons = metering::Reason::range | metering::Reason::spike;
  const CommitCounts counts = commit({.intervals = {{reading(main, 0, 0.1)},
                                                    {reading(main, 1, kNone, Validity::missing)},
                                                    {late},
                                                    {reading(chilled, 0, 7.0, Validity::scaled)}}});
  EXPECT_EQ(counts.taken, 4);
  reopen();
  EXPECT_EQ(meter("main"), main);
  const auto found = intervals(main);
  ASSERT_THAT(found, SizeIs(3));
  EXPECT_EQ(found[0].reading.start, kStart);
  EXPECT_EQ(found[0].reading.mean_kW, 0.1);
  EXPECT_EQ(found[0].reading.meter, main);
  EXPECT_EQ(found[0].revision, 0);
  EXPECT_TRUE(std::isnan(found[1].reading.mean_kW));
  EXPECT_EQ(found[1].reading.validity, Validity::missing);
  EXPECT_EQ(found[2].reading.validity, Validity::suspect);
  EXPECT_EQ(found[2].reading.reasons, late.reasons);
  EXPECT_TRUE(found[2].reading.late);
  EXPECT_THAT(intervals(chilled), SizeIs(1));
}

TEST_F(StoreFile, EverythingMayArriveTwice) {
  const std::uint32_t main = meter("main");
  const StoreBatch batch{.intervals = {{reading(main, 0, 10.0)}, {reading(main, 1, 11.0)}}};
  (void)commit(batch);
  const CommitCounts again = commit(batch);
  EXPECT_EQ(again.taken, 0);
  EXPECT_EQ(again.duplicates, 2);
  EXPECT_THAT(intervals(main), SizeIs(2));
}

// Whatever the order, and whatever this process has seen of them.
TEST_F(StoreFile, WhatArrivesLateIsTakenOnce) {
  const std::uint32_t main = meter("main");
  const auto counts = [&](int quarter) {
    const CommitCounts found = commit({.intervals = {{reading(main, quarter, 10.0 + quarter)}}});
    return std::pair{found.taken, found.duplicates};
  };
  EXPECT_EQ(counts(5), std::pair(1, 0));
  EXPECT_EQ(counts(3), std::pair(1, 0));
  EXPECT_EQ(counts(3), std::pair(0, 1));
  EXPECT_EQ(counts(5), std::pair(0, 1));
  reopen();
  EXPECT_EQ(counts(5), std::pair(0, 1));
  EXPECT_EQ(counts(4), std::pair(1, 0));
  EXPECT_EQ(counts(6), std::pair(1, 0));
  EXPECT_EQ(counts(6), std::pair(0, 1));
  EXPECT_THAT(intervals(main), SizeIs(4));
}

// Files of every version carry these sums: the CRC-32 of the values' bytes, of any length.
TEST_F(StoreFile, AChecksumIsOfAllBytesInOrder) {
  for (const std::size_t length : {0u, 1u, 60u, 230u, 256u, 257u, 300u, 5000u}) {
    const std::string text(length, 'x');
    std::string bytes;
    const auto add = [&](char tag, const auto& value) {
      bytes += tag;
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    const auto add_text = [&](const std::string& one) {
      add('t', static_cast<std::uint32_t>(one.size()));
      bytes += one;
    };
    add_text("interval");
    add('i', std::int64_t{-7});
    add_text(text);
    add('r', 0.25);
    bytes += 'n';
    const auto expected =
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
    auto query =
        store_->database().prepare("SELECT row_sum('interval', -7, ?, 0.25, NULL)").value();
    query.bind(0, std::string_view{text});
    ASSERT_TRUE(query.step().value());
    EXPECT_EQ(query.integer(0), static_cast<std::int64_t>(expected)) << length;
  }
}

TEST_F(StoreFile, BetterReadingsAreNewRevisionsAndTheOldRowStays) {
  const std::uint32_t main = meter("main");
  (void)commit({.intervals = {{reading(main, 0, 10.0, Validity::scaled)}}});
  EXPECT_EQ(commit({.intervals = {{reading(main, 0, 12.0)}}}).taken, 1);
  EXPECT_EQ(commit({.intervals = {{reading(main, 0, 9.0, Validity::scaled)}}}).weaker, 1);
  EXPECT_EQ(commit({.intervals = {{reading(main, 0, 9.0, Validity::scaled), true}}}).taken, 1);
  const auto found = intervals(main);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].revision, 2);
  EXPECT_EQ(found[0].reading.mean_kW, 9.0);
  auto rows = store_->database().prepare("SELECT mean_kW FROM interval ORDER BY revision");
  ASSERT_TRUE(rows.has_value());
  std::vector<double> kept;
  while (rows->step().value()) kept.push_back(rows->real(0));
  EXPECT_THAT(kept, ElementsAre(10.0, 12.0, 9.0));
}

TEST_F(StoreFile, AConflictIsHandedBackAndTheFirstStays) {
  const std::uint32_t main = meter("main");
  (void)commit({.intervals = {{reading(main, 0, 10.0)}}});
  const CommitCounts counts = commit({.intervals = {{reading(main, 0, 12.0)}}});
  ASSERT_THAT(counts.conflicts, SizeIs(1));
  EXPECT_EQ(counts.conflicts[0].mean_kW, 12.0);
  EXPECT_EQ(intervals(main)[0].reading.mean_kW, 10.0);
}

// Intervals, states, samples and events of one commit stand or fall together.
TEST_F(StoreFile, ABatchThatFailsLeavesNoTrace) {
  const std::uint32_t main = meter("main");
  const std::uint32_t nobody = main + 1;
  const RegisterState state{.field = "energy", .settings = {.rated_kW = 400.0}};
  for (const StoreBatch& batch :
       {StoreBatch{.intervals = {{reading(main, 0, 10.0)}, {reading(nobody, 0, 10.0)}},
       .registers = {{main, state}}},
        StoreBatch{.intervals = {{reading(main, 0, 10.0)}},
        .registers = {{main, state}, {nobody, state}}},
        StoreBatch{.intervals = {{reading(main, 0, 10.0)}},
        .samples = {{nobody, "energy", kStart, 1.0}}}}) {
    const auto counts = store_->commit(batch);
    ASSERT_FALSE(counts.has_value());
    EXPECT_EQ(counts.error().code, ErrorCode::invalid_value);
    EXPECT_THAT(intervals(main), IsEmpty());
    EXPECT_THAT(*store_->registers(main), IsEmpty());
  }
  EXPECT_EQ(commit({.intervals = {{reading(main, 0, 10.0)}}}).taken, 1);
}

TEST_F(StoreFile, ReadsOnlyTheSpanAskedFor) {
  const std::uint32_t main = meter("main");
  EXPECT_FALSE(store_->interval_extent(main)->has_value());
  StoreBatch batch;
  for (int quarter = 0; quarter < 10; ++quarter) {
    batch.intervals.push_back({reading(main, quarter, quarter)});
  }
  (void)commit(batch);
  std::vector<double> found;
  (void)store_->for_each_interval(
      main, {kStart + 3 * kQuarter, kStart + 6 * kQuarter},
      [&](const StoredInterval& interval) { found.push_back(interval.reading.mean_kW); });
  EXPECT_THAT(found, ElementsAre(3.0, 4.0, 5.0));
  const auto extent = store_->interval_extent(main);
  ASSERT_TRUE(extent.has_value() && extent->has_value());
  EXPECT_EQ((*extent)->begin, kStart);
  EXPECT_EQ((*extent)->end, kStart + 9 * kQuarter);
}

TEST_F(StoreFile, AMeterDoesNotChangeItsInterval) {
  (void)meter("main");
  const auto number = store_->meter_number("main", seconds{3600});
  ASSERT_FALSE(number.has_value());
  EXPECT_EQ(number.error().code, ErrorCode::unsupported);
  EXPECT_THAT(number.error().message, HasSubstr("intervals of 900 s but now has 3600 s"));
}

// A counter in the middle of a suspected reset, at any minute of it, goes on after a restart as if
// nothing had happened.
TEST_F(StoreFile, ARegisterGoesOnWhereItStopped) {
  const std::uint32_t main = meter("main");
  const metering::CounterSettings settings{400.0, 0.1, 1e6};
  const metering::BookingRules rules{.interval = kQuarter, .sample_gap_max = seconds{120}};
  const auto value = [](int minute) { return minute < 20 ? 1000.0 + minute : minute / 3.0; };
  const auto run = [&](bool restarts) {
    RegisterState state{.field = "energy", .settings = settings, .identity = "4711"};
    std::vector<Reading> readings;
    for (int minute = 0; minute <= 60; ++minute) {
      metering::CounterStep step = metering::advance(
          std::move(state.counter), {kStart + minutes{minute}, value(minute)}, settings);
      for (const auto& booked : book_intervals(state.book, main, step, rules)) {
        readings.push_back(booked.reading);
      }
      state.counter = std::move(step.state);
      if (!restarts) continue;
      (void)commit({.registers = {{main, state}}});
      reopen();
      const auto states = store_->registers(main);
      EXPECT_TRUE(states.has_value() && states->size() == 1) << minute;
      state = states->at(0);
    }
    EXPECT_EQ(state.identity, "4711");
    EXPECT_EQ(state.settings.modulus_kWh, 1e6);
    return readings;
  };
  const auto uninterrupted = run(false);
  const auto interrupted = run(true);
  ASSERT_EQ(interrupted.size(), uninterrupted.size());
  for (std::size_t i = 0; i < interrupted.size(); ++i) {
    EXPECT_EQ(interrupted[i].start, uninterrupted[i].start);
    EXPECT_EQ(interrupted[i].validity, uninterrupted[i].validity);
    EXPECT_EQ(interrupted[i].reasons, uninterrupted[i].reasons);
    if (!std::isnan(uninterrupted[i].mean_kW)) {
      EXPECT_EQ(interrupted[i].mean_kW, uninterrupted[i].mean_kW);
    }
  }
}

TEST(RegisterJson, KeepsEveryPartOfAState) {
  RegisterState state{.field = "energy", .settings = {.rated_kW = 0.1 + 0.2}};
  state.counter = {.phase = metering::CounterPhase::high,
                   .baseline = {kStart, 1.0 / 3.0},
                   .previous = {{{kStart - minutes{5}, 2.0}, kStart + std::chrono::hours{3}}},
                   .pending = {{{kStart, 9.0}, {kStart + minutes{1}, 10.0}, 2}},
                   .restarts = {kStart, kStart + minutes{2}}};
  state.book.next = kStart + kQuarter;
  state.book.pieces = {{{kStart, kStart + kQuarter},
                        kNone,
                        Validity::missing,
                        metering::Reason::reset | metering::Reason::timeout}};
  const auto back = register_from_json(to_json(state));
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(to_json(*back), to_json(state));
  EXPECT_EQ(back->settings.rated_kW, 0.1 + 0.2);
  EXPECT_TRUE(std::isinf(back->settings.modulus_kWh));
  EXPECT_EQ(back->counter.pending->last.value_kWh, 10.0);
  EXPECT_EQ(back->counter.previous->expires, kStart + std::chrono::hours{3});
  EXPECT_EQ(back->counter.restarts.size(), 2u);
  EXPECT_TRUE(std::isnan(back->book.pieces[0].energy_kWh));
  EXPECT_EQ(back->book.pieces[0].reasons, state.book.pieces[0].reasons);
}

TEST(RegisterJson, KeepsAPowerThatIsBeingAveraged) {
  RegisterState state{.field = "power", .settings = {.rated_kW = 1.0}};
  state.power = {.next = kStart,
                 .until = kStart + minutes{3},
                 .power_kW = 0.1 + 0.2,
                 .energy_kWh = 1.0 / 3.0,
                 .covered = minutes{2},
                 .hole_longest = minutes{1},
                 .reasons = metering::Reason::crc};
  const auto back = register_from_json(to_json(state));
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(back->power.next, kStart);
  EXPECT_EQ(back->power.until, kStart + minutes{3});
  EXPECT_EQ(back->power.power_kW, 0.1 + 0.2);
  EXPECT_EQ(back->power.energy_kWh, 1.0 / 3.0);
  EXPECT_EQ(back->power.covered, minutes{2});
  EXPECT_EQ(back->power.hole_longest, minutes{1});
  EXPECT_EQ(back->power.reasons, metering::Reason::crc);
  state.power.power_kW.reset();
  EXPECT_FALSE(register_from_json(to_json(state))->power.power_kW.has_value());
}

TEST(RegisterJson, DamageIsTold) {
  const std::string good = to_json({.field = "energy", .settings = {.rated_kW = 1.0}});
  for (std::size_t size = 0; size < good.size(); ++size) {
    const auto cut = register_from_json(good.substr(0, size));
    ASSERT_FALSE(cut.has_value()) << size;
    EXPECT_EQ(cut.error().code, ErrorCode::malformed);
  }
  EXPECT_FALSE(register_from_json("{}").has_value());
}

metering::MonthlyFigure figure(int number, double daily_average_kWh) {
  metering::MonthlyFigure made{.month = std::chrono::year{2024} /
                                        std::chrono::month{static_cast<unsigned>(number)}};
  made.daily_average_kWh = daily_average_kWh;
  made.daily_average_variance_kWh2 = 2.5;
  made.peak = metering::PeakDemand{99.5, kStart, true};
  made.peak_window = kQuarter;
  made.coverage = 0.93;
  made.filled_share = 0.07;
  made.slots_by_validity = {10, 1, 2, 3, 4};
  made.slots = 20;
  made.usable = true;
  made.reasons = metering::Reason::stuck;
  return made;
}

TEST_F(StoreFile, MonthsHaveRevisions) {
  const std::uint32_t main = meter("main");
  EXPECT_EQ(*store_->put_month(main, figure(4, 200.0), "2025b", kStart), 0);
  EXPECT_EQ(*store_->put_month(main, figure(3, 100.0), "2025b", kStart), 0);
  EXPECT_EQ(*store_->put_month(main, figure(3, 101.0), "2025b", kStart), 1);
  metering::MonthlyFigure bad = figure(5, kNone);
  bad.usable = false;
  bad.unusable_because = "nothing was measured";
  bad.peak.reset();
  EXPECT_EQ(*store_->put_month(main, bad, "2025b", kStart), 0);
  reopen();
  const auto months = store_->months(main);
  ASSERT_TRUE(months.has_value());
  ASSERT_THAT(*months, SizeIs(3));
  const metering::MonthlyFigure& march = months->at(0).figure;
  const metering::MonthlyFigure expected = figure(3, 101.0);
  EXPECT_EQ(march.month, expected.month);
  EXPECT_EQ(march.revision, 1);
  EXPECT_EQ(march.daily_average_kWh, 101.0);
  EXPECT_EQ(march.daily_average_variance_kWh2, 2.5);
  EXPECT_EQ(march.peak->kW, 99.5);
  EXPECT_EQ(march.peak->start, kStart);
  EXPECT_TRUE(march.peak->could_be_exceeded);
  EXPECT_EQ(march.peak_window, kQuarter);
  EXPECT_EQ(march.coverage, 0.93);
  EXPECT_EQ(march.filled_share, 0.07);
  EXPECT_EQ(march.slots_by_validity, expected.slots_by_validity);
  EXPECT_EQ(march.slots, 20);
  EXPECT_TRUE(march.usable);
  EXPECT_EQ(march.reasons, metering::Reason::stuck);
  EXPECT_EQ(months->at(0).closed_at, kStart);
  EXPECT_EQ(months->at(0).time_zone_release, "2025b");
  const metering::MonthlyFigure& may = months->at(2).figure;
  EXPECT_FALSE(may.usable);
  EXPECT_EQ(may.unusable_because, "nothing was measured");
  EXPECT_FALSE(may.peak.has_value());
  EXPECT_TRUE(std::isnan(may.daily_average_kWh));
}

TEST_F(StoreFile, AReopenedMonthWaitsUntilItIsPutAgain) {
  const std::uint32_t main = meter("main");
  const MeterMonth march{main, std::chrono::year{2024} / 3};
  const MeterMonth april{main, std::chrono::year{2024} / 4};
  EXPECT_THAT(*store_->reopened(), IsEmpty());
  (void)commit({.reopened = {april, march}});
  (void)commit({.reopened = {march}});
  reopen();
  EXPECT_THAT(*store_->reopened(), ElementsAre(march, april));
  EXPECT_EQ(*store_->put_month(main, figure(3, 100.0), "2025b", kStart), 0);
  EXPECT_THAT(*store_->reopened(), ElementsAre(april));
}

TEST_F(StoreFile, EventsComeNewestFirst) {
  (void)meter("main");
  (void)commit({.events = {{kStart, Severity::warning, "counter_reset", "main", "It fell to 0."},
                           {kStart + seconds{1}, Severity::info, "started", "", "Up."}}});
  const auto events = store_->events(10);
  ASSERT_TRUE(events.has_value());
  ASSERT_THAT(*events, SizeIs(2));
  EXPECT_EQ(events->at(0).kind, "started");
  EXPECT_EQ(events->at(1).subject, "main");
  EXPECT_EQ(events->at(1).severity, Severity::warning);
  EXPECT_THAT(*store_->events(1), SizeIs(1));
}

// A program sends a megabyte as a reason, five hundred times.
TEST_F(StoreFile, AnEventIsStoredAtALimitedLength) {
  const std::string megabyte(1'000'000, 'x');
  StoreBatch batch;
  batch.events.push_back({kStart, Severity::info, "corrected", "main", megabyte});
  batch.events.push_back({kStart, Severity::info, megabyte, megabyte, "short"});
  (void)commit(batch);
  const auto events = store_->events(10).value();
  ASSERT_THAT(events, SizeIs(2));
  EXPECT_EQ(events[1].text.size(), kEventTextMax);
  EXPECT_THAT(events[1].text, ::testing::EndsWith("(1000000 bytes in all)"));
  EXPECT_EQ(events[0].kind.size(), kEventWordMax);
  EXPECT_EQ(events[0].subject.size(), kEventWordMax);
  auto longest = store_->database().prepare("SELECT max(length(text)) FROM event").value();
  ASSERT_TRUE(longest.step().value());
  EXPECT_LE(longest.integer(0), std::int64_t{kEventTextMax});
}

// Of an earlier recald, which kept them whole: a quarter of a gigabyte is never in memory at once.
TEST_F(StoreFile, LongEventsOfBeforeAreReadShortAndAFewAtATime) {
  ASSERT_TRUE(store_->database()
                  .execute("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE "
                           "i < 500) INSERT INTO event SELECT i, i, 0, CASE i % 2 WHEN 0 THEN "
                           "'meter_silent' ELSE 'meter_answers' END, 'm' || (i % 7), "
                           "printf('%.*c', 500000, 'x'), 1, NULL, NULL FROM n")
                  .has_value());
  const auto newest = store_->events(10'000).value();
  EXPECT_EQ(newest.front().number, 500);
  EXPECT_LT(newest.size(), 500U);  // a megabyte of them
  EXPECT_GT(newest.size(), 200U);
  EXPECT_THAT(newest.front().text, ::testing::EndsWith("(500000 bytes in all)"));
  std::int64_t next = 501;
  ASSERT_TRUE(store_
                  ->for_each_event(Instant::max(),
                                   [&](const StoreEvent& event) {
                                     EXPECT_EQ(event.number, --next);
                                     return event.number > 3;
                                   })
                  .has_value());
  EXPECT_EQ(next, 3);
  std::int64_t after = 0;
  while (after < 500) {
    const auto some = store_->events_after(after, 100'000).value();
    ASSERT_FALSE(some.empty());
    EXPECT_EQ(some.front().number, after + 1);
    after = some.back().number;
  }
  // 500 is m3 and silent, 499 m2 and answers, 498 m1 and silent, …
  EXPECT_THAT(store_->silent_meters().value(),
              ::testing::UnorderedElementsAre("m3", "m1", "m6", "m4"));
}

TEST_F(StoreFile, AReaderSeesWhatIsCommittedAndCannotWrite) {
  const std::uint32_t main = meter("main");
  auto reader = Database::open(file(), {.access = Database::Access::read_only});
  ASSERT_TRUE(reader.has_value()) << reader.error().message;
  (void)commit({.intervals = {{reading(main, 0, 10.0)}}});
  auto count = reader->prepare("SELECT count(*) FROM interval");
  ASSERT_TRUE(count.has_value());
  ASSERT_TRUE(count->step().value());
  EXPECT_EQ(count->integer(0), 1);
  count->reset();
  const auto write = reader->execute("DELETE FROM interval");
  ASSERT_FALSE(write.has_value());
  EXPECT_EQ(write.error().code, ErrorCode::io_failed);
}

TEST_F(StoreFile, ABackupIsAStoreOfItsOwn) {
  const std::uint32_t main = meter("main");
  (void)commit({.intervals = {{reading(main, 0, 10.0)}}});
  const auto copy = folder_ / "backup.db";
  for (int day = 0; day < 2; ++day) {  // the second replaces the first
    (void)commit({.intervals = {{reading(main, 1 + day, 11.0)}}});
    const auto backup = store_->begin_backup(copy).value();
    const auto copied = backup->step(1000);
    ASSERT_TRUE(copied.has_value()) << copied.error().message;
    EXPECT_TRUE(*copied);
    EXPECT_EQ(backup->check({}).value(), "");
    EXPECT_TRUE(backup->keep().has_value());
  }
  auto opened = SqliteStore::open(copy);
  ASSERT_TRUE(opened.has_value()) << opened.error().message;
  EXPECT_EQ((*opened->interval_extent(main))->end, kStart + 2 * kQuarter);
  EXPECT_FALSE(std::filesystem::exists(copy.string() + ".part"));
  const auto nowhere = store_->begin_backup(folder_ / "no" / "folder.db");
  ASSERT_FALSE(nowhere.has_value());
  EXPECT_EQ(nowhere.error().code, ErrorCode::io_failed);
}

TEST_F(StoreFile, DurabilityIsAsPromised) {
  auto mode = store_->database().prepare("PRAGMA journal_mode");
  ASSERT_TRUE(mode->step().value());
  EXPECT_EQ(mode->text(0), "wal");
  auto synchronous = store_->database().prepare("PRAGMA synchronous");
  ASSERT_TRUE(synchronous->step().value());
  EXPECT_EQ(synchronous->integer(0), 2);
}

TEST(StoreOpening, WhatIsNoStoreIsLeftAlone) {
  const TemporaryFolder folder;
  recald::testing::write_text(folder / "text.db", std::string(4096, 'x'));
  const auto text = SqliteStore::open(folder / "text.db");
  ASSERT_FALSE(text.has_value());
  EXPECT_EQ(text.error().code, ErrorCode::malformed);
  EXPECT_THAT(text.error().message, HasSubstr("text.db"));
  {
    auto other = Database::open(folder / "other.db", {});
    ASSERT_TRUE(other->execute("CREATE TABLE somebodys (thing TEXT)").has_value());
  }
  const auto other = SqliteStore::open(folder / "other.db");
  ASSERT_FALSE(other.has_value());
  EXPECT_THAT(other.error().message, HasSubstr("database of another program"));
  const auto nowhere = SqliteStore::open(folder / "no" / "folder.db");
  ASSERT_FALSE(nowhere.has_value());
  EXPECT_EQ(nowhere.error().code, ErrorCode::io_failed);
}

/// While it lives, this process makes files with this umask.
class Umask {
 public:
  explicit Umask(mode_t mask) : before_(::umask(mask)) {}
  ~Umask() { ::umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

unsigned mode_of(const std::filesystem::path& file) {
  return static_cast<unsigned>(std::filesystem::status(file).permissions());
}

// When people are in and when they are out can be read from a meter: that is not for everybody.
TEST(StoreOpening, OthersMayNotReadTheStoreNorItsBackups) {
  for (const auto& [mask, mode] : {std::pair{0000u, 0640u}, {0022u, 0640u}, {0077u, 0600u}}) {
    SCOPED_TRACE(mask);
    const Umask umask{mask};
    const TemporaryFolder folder;
    auto store = SqliteStore::open(folder / "site.db");
    ASSERT_TRUE(store.has_value()) << store.error().message;
    ASSERT_TRUE(store->meter_number("main", kQuarter).has_value());
    EXPECT_EQ(mode_of(folder / "site.db"), mode);
    EXPECT_EQ(mode_of(folder / "site.db-wal"), mode);
    auto backup = store->begin_backup(folder / "backup.db");
    ASSERT_TRUE(backup.has_value()) << backup.error().message;
    ASSERT_TRUE((*backup)->step(1000).value());
    ASSERT_TRUE((*backup)->keep().has_value());
    EXPECT_EQ(mode_of(folder / "backup.db"), mode);
  }
}

TEST(StoreOpening, AStoreKeepsTheRightsThatItHas) {
  using std::filesystem::perms;
  const TemporaryFolder folder;
  { ASSERT_TRUE(SqliteStore::open(folder / "site.db").has_value()); }
  std::filesystem::permissions(folder / "site.db", perms{0664});
  { ASSERT_TRUE(SqliteStore::open(folder / "site.db").has_value()); }
  EXPECT_EQ(mode_of(folder / "site.db"), 0664u);
}

TEST(StoreOpening, AFileOfANewerRecaldIsNotTouched) {
  const TemporaryFolder folder;
  { ASSERT_TRUE(SqliteStore::open(folder / "site.db").has_value()); }
  {
    auto database = Database::open(folder / "site.db", {});
    ASSERT_TRUE(
        database->execute("CREATE TABLE more (thing TEXT); PRAGMA user_version=99").has_value());
  }
  const auto store = SqliteStore::open(folder / "site.db");
  ASSERT_FALSE(store.has_value());
  EXPECT_EQ(store.error().code, ErrorCode::unsupported);
  EXPECT_THAT(store.error().message, HasSubstr("schema version 99"));
}

TEST(StoreOpening, DamageIsFound) {
  const TemporaryFolder folder;
  {
    auto store = SqliteStore::open(folder / "site.db");
    ASSERT_TRUE(store.has_value());
    const auto number = store->meter_number("main", kQuarter);
    StoreBatch batch;
    for (int quarter = 0; quarter < 2000; ++quarter) {
      batch.intervals.push_back({reading(*number, quarter, quarter)});
    }
    ASSERT_TRUE(store->commit(batch).has_value());
    EXPECT_EQ(store->database().quick_check().value(), "");
  }
  recald::testing::damage_leaf(folder / "site.db", "interval", 3);
  auto database = Database::open(folder / "site.db", {});
  ASSERT_TRUE(database.has_value());
  const auto damage = database->quick_check();
  ASSERT_TRUE(damage.has_value());
  EXPECT_NE(*damage, "");
}

}  // namespace
}  // namespace recald::sqlite::sqlite_store_test
