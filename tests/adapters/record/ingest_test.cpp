#include "adapters/record/ingest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>
#include <sstream>
#include <thread>

#include "adapters/record/jobs.hpp"
#include "adapters/stores/open.hpp"
#include "tests/adapters/record/record_fixture.hpp"
#include "tests/support/seed.hpp"

namespace recald::record {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

Progress entries(std::int64_t number) { return {.entries = number}; }

/// All of a store that was filled from the record, in words that can be compared.
std::string contents(postgres::Connection& connection, std::int64_t until_seq) {
  auto store = stores::open_in_memory();
  if (!store) throw std::runtime_error(store.error().message);
  const auto copied = copy_into(**store, connection, "tower", until_seq);
  if (!copied) throw std::runtime_error(copied.error().message);
  std::ostringstream out;
  out.precision(17);
  for (const char* id : {"steam", "power"}) {
    const auto meter = (*store)->find_meter(id);
    if (!meter || !*meter) continue;
    out << id << " " << **meter << '\n';
    (void)(*store)->for_each_interval(
        **meter, {metering::Instant{}, metering::kLatestInstant}, [&](const StoredInterval& one) {
          const auto& reading = one.reading;
          out << metering::to_string(reading.start) << ' ' << reading.mean_kW << ' '
              << metering::to_string(reading.validity) << ' '
              << metering::to_string(reading.reasons) << ' ' << reading.late << '\n';
        });
    const auto months = (*store)->months(**meter);
    for (const StoredMonth& month : *months) {
      const auto& figure = month.figure;
      out << metering::to_string(figure.month) << ' ' << figure.revision << ' '
          << figure.daily_average_kWh << ' ' << figure.daily_average_variance_kWh2 << ' '
          << (figure.peak ? figure.peak->kW : -1.0) << ' ' << figure.peak_window.count() << ' '
          << figure.coverage << ' ' << figure.filled_share << ' ' << figure.slots_by_validity[2]
          << ' ' << figure.slots << ' ' << figure.usable << figure.unusable_because << ' '
          << metering::to_string(figure.reasons) << ' ' << metering::to_string(month.closed_at)
          << ' ' << month.time_zone_release << '\n';
    }
  }
  return out.str();
}

TEST_F(Record, WhatComesTwiceOrLateCountsOnce) {
  const auto first = send(intervals(0, 10));
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(*first, (Watermark{.outbox = 11, .until = entries(10)}));
  EXPECT_EQ(*send(intervals(0, 10)), *first);
  EXPECT_EQ(send(intervals(5, 10))->until, entries(15));  // half of it is new
  EXPECT_EQ(send(intervals(0, 10))->until, entries(15));  // late
  EXPECT_EQ(ask("SELECT count(*), min(seq), max(seq), count(DISTINCT t_start) FROM interval"),
            "15|1|15|15\n");
  EXPECT_THAT(*watermarks(*connection_),
              ElementsAre(Pair("tower", Watermark{.outbox = 11, .until = entries(15)})));
}

TEST_F(Record, TwoConnectionsWithTheSameBatchesTakeEachOnce) {
  constexpr int kBatches = 30;
  std::vector<std::jthread> workers;
  for (int i = 0; i < 3; ++i) {
    workers.emplace_back([&, own = open()] {
      for (int batch = 0; batch < kBatches; ++batch) {
        const auto taken = take(*own, "tower", intervals(batch * 7, 7), kNow);
        ASSERT_TRUE(taken) << taken.error().message;
        EXPECT_GE(taken->until.entries, (batch + 1) * 7);
      }
    });
  }
  workers.clear();
  EXPECT_EQ(ask("SELECT count(*), max(seq), count(DISTINCT t_start) FROM interval"),
            "210|210|210\n");
  EXPECT_EQ(ask("SELECT count(*) FROM meter"), "1\n");
}

// A broken or hostile gateway: the record's own numbers go on by one an entry all the same.
TEST_F(Record, NumbersThatJumpDoNotReachTheRecordsOwn) {
  ASSERT_TRUE(send(intervals(0, 2)));
  for (int i = 0; i < 10; ++i) {
    const std::int64_t outbox = 100 + i;
    ASSERT_TRUE(send(end_of_history(outbox)));
    RecordBatch far{.outbox = outbox, .after = {}, .is_first = true};
    far.entries = {interval_entry((std::int64_t{1} << 60) - 1, "steam", kMarch, 12.0 + i)};
    far.events = {{.time = kMarch, .kind = "odd", .number = (std::int64_t{1} << 60) - 1}};
    const auto taken = send(far);
    ASSERT_TRUE(taken) << taken.error().message;
    EXPECT_EQ(taken->until.entries, (std::int64_t{1} << 60) - 1);
  }
  EXPECT_EQ(ask("SELECT seq, event_seq FROM site WHERE id = 'tower'"), "12|10\n");
  EXPECT_EQ(ask("SELECT max(number) FROM event"), "10\n");
  // A correction is the newest, whatever came before.
  RecordBatch correction{.outbox = 11, .after = entries(2)};
  correction.entries = {interval_entry(3, "steam", kMarch, 200.0)};
  ASSERT_TRUE(send(correction));
  EXPECT_EQ(ask("SELECT mean_kw FROM interval ORDER BY seq DESC LIMIT 1"), "200\n");
}

TEST_F(Record, ASiteHasALimitOfMeters) {
  int number = 0;
  const auto send_meters = [&](int count) {
    RecordBatch batch{.outbox = 11, .after = entries(number)};
    for (int i = 0; i < count; ++i) {
      ++number;
      batch.entries.push_back(interval_entry(number, "m" + std::to_string(number), kMarch, 1.0));
    }
    const auto taken = send(batch);
    if (!taken) number -= count;
    return taken;
  };
  ASSERT_TRUE(send_meters(9'999));
  ASSERT_TRUE(send_meters(1));
  const auto refused = send_meters(1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_THAT(refused.error().message, HasSubstr("10001 meters in the record, which takes 10000"));
  EXPECT_EQ(ask("SELECT count(*) FROM meter"), "10000\n");
}

// A backup of the record was restored: gateways have forgotten what it had confirmed since.
TEST_F(Record, ARecordThatLostConfirmedEntriesReportsItAndAcceptsNothing) {
  ASSERT_TRUE(send(intervals(0, 5)));
  auto batch = intervals(8, 2);
  batch.question = 17;
  const auto answer = send(batch);
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, (Watermark{.outbox = 11, .until = entries(5), .answers = 17}));
  batch = intervals(5, 2);
  batch.after.events = 1;
  EXPECT_EQ(send(batch)->until, entries(5));
  batch.after.events = 0;
  batch.after.results = 1;
  EXPECT_EQ(send(batch)->until, entries(5));
  EXPECT_EQ(ask("SELECT max(seq), count(*) FROM interval"), "5|5\n");
  // Of an outbox that it does not know at all: unless that says itself that it begins.
  auto other = intervals(8, 2, 22);
  EXPECT_EQ(send(other)->until, Progress{});
  EXPECT_EQ(ask("SELECT count(*) FROM source"), "1\n");
  // … and that all before it was told.
  other.is_first = true;
  EXPECT_EQ(send(other)->until, Progress{});
  ASSERT_TRUE(send(end_of_history(22)));
  EXPECT_EQ(send(other)->until, entries(10));
  other.is_first = false;
  EXPECT_EQ(send(other)->until, entries(10));
  EXPECT_EQ(ask("SELECT max(seq), count(*) FROM interval"), "7|7\n");
}

TEST_F(Record, AnotherOutboxGoesOnAndItsRowsWin) {
  ASSERT_TRUE(send(intervals(0, 10)));
  const std::string before = contents(*connection_, 10);
  // A restored backup gives numbers from 6 on again, for other values.
  ASSERT_TRUE(send(end_of_history(22)));
  RecordBatch restored{.outbox = 22, .after = entries(5), .is_first = true};
  restored.entries = {interval_entry(6, "steam", kMarch + kQuarter, 77.0),
                      interval_entry(7, "power", kMarch, 1.0)};
  const auto taken = send(restored);
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(*taken, (Watermark{.outbox = 22, .until = entries(7)}));
  EXPECT_EQ(ask("SELECT mean_kw, seq FROM interval WHERE seq > 10 ORDER BY seq"), "77|11\n1|12\n");
  EXPECT_EQ(contents(*connection_, 10), before);
  EXPECT_THAT(contents(*connection_, 12), HasSubstr("2024-03-01T00:15:00Z 77 ok"));
  // What the old one had sent and the broker gives late does not disturb it.
  EXPECT_EQ(send(intervals(8, 4))->until, entries(12));
  EXPECT_EQ(ask("SELECT seq FROM interval WHERE seq > 12 ORDER BY seq"), "13\n14\n");
  EXPECT_THAT(*watermarks(*connection_),
              ElementsAre(Pair("tower", Watermark{.outbox = 22, .until = entries(7)})));
}

TEST_F(Record, NothingIsTakenFromAnUnknownSite) {
  const auto taken = send(intervals(0, 5), "ghost");
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, ErrorCode::not_found);
  EXPECT_THAT(taken.error().message, HasSubstr("no site ghost"));
  EXPECT_EQ(ask("SELECT count(*) FROM interval"), "0\n");
  EXPECT_EQ(ask("SELECT count(*) FROM source"), "0\n");
}

// A gateway tells its past again: after its restoration, say.
TEST_F(Record, AClockThatWasAheadIsForgottenOnceItIsRight) {
  const auto newest = [this] { return sites(*connection_)->at(0).newest; };
  RecordBatch batch{.outbox = 11};
  batch.entries = {interval_entry(1, "steam", kMarch, 1.0)};
  ASSERT_TRUE(send(batch));
  RecordBatch ahead{.outbox = 11, .after = entries(1)};
  const metering::Instant wrong = std::chrono::sys_days{std::chrono::year{2036} / 3 / 1};
  ahead.entries = {interval_entry(2, "steam", wrong, 1.0)};
  ASSERT_TRUE(send(ahead));
  EXPECT_EQ(newest(), wrong);
  RecordBatch right{.outbox = 11, .after = entries(2)};
  right.entries = {interval_entry(3, "steam", kMarch + kQuarter, 1.0)};
  ASSERT_TRUE(send(right));
  EXPECT_EQ(newest(), kMarch + kQuarter);
  // What comes late does not turn it back.
  RecordBatch late{.outbox = 11, .after = entries(3)};
  late.entries = {interval_entry(4, "steam", kMarch - kQuarter, 1.0)};
  ASSERT_TRUE(send(late));
  EXPECT_EQ(newest(), kMarch + kQuarter);
}

TEST_F(Record, ACorrectionThatIsTakenBackCountsInOneBatchToo) {
  ASSERT_TRUE(send(intervals(0, 1)));
  RecordBatch batch{.outbox = 11, .after = entries(1)};
  const auto start = kMarch + kQuarter;
  batch.entries = {interval_entry(2, "steam", start, 7.0), interval_entry(3, "steam", start, 0.1)};
  ASSERT_TRUE(send(batch));
  EXPECT_EQ(ask("SELECT seq, mean_kw FROM interval ORDER BY seq"), "1|0.1\n2|7\n3|0.1\n");
}

TEST_F(Record, ThePastIsStoredOnce) {
  RecordBatch past = intervals(0, 4, -11);
  past.is_first = true;
  ASSERT_TRUE(send(past));
  ASSERT_TRUE(send(end_of_history(11)));
  RecordBatch again = intervals(0, 5, -22);  // and what came since
  again.is_first = true;
  std::get<StoredInterval>(again.entries[1].stored).reading.mean_kW = 77.0;
  std::get<StoredInterval>(again.entries[2].stored).reading.validity = metering::Validity::suspect;
  ASSERT_TRUE(send(again));
  EXPECT_EQ(ask("SELECT row_number() OVER (ORDER BY seq), mean_kw, validity FROM interval"),
            "1|0.1|0\n2|0.2|0\n3|0.30000000000000004|0\n4|0.4|0\n5|77|0\n"
            "6|0.30000000000000004|4\n7|0.5|0\n");
  EXPECT_EQ(ask("SELECT count(*) FROM meter"), "1\n");  // the end names none
  EXPECT_EQ(ask("SELECT count(*) FROM source WHERE entries = 1::bigint << 46"), "1\n");
}

TEST_F(Record, NothingIsSaidOfWhatCouldNotBeCommitted) {
  ASSERT_TRUE(send(intervals(0, 5)));
  (void)ask(
      "CREATE FUNCTION refuse() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE EXCEPTION "
      "USING ERRCODE = '53100', MESSAGE = 'no space left on device'; END $$; "
      "CREATE CONSTRAINT TRIGGER refuse AFTER UPDATE ON source DEFERRABLE INITIALLY DEFERRED "
      "FOR EACH ROW EXECUTE FUNCTION refuse()");
  const auto taken = send(intervals(5, 5));
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, ErrorCode::io_failed);
  EXPECT_THAT(taken.error().message, HasSubstr("no space left on device"));
  EXPECT_EQ(watermarks(*connection_)->at(0).second.until, entries(5));
  EXPECT_EQ(ask("SELECT count(*) FROM interval"), "5\n");
  (void)ask("DROP TRIGGER refuse ON source");
  EXPECT_EQ(send(intervals(5, 5))->until, entries(10));
}

TEST_F(Record, ValuesAreKeptToTheLastBit) {
  RecordBatch batch{.outbox = 11};
  batch.entries = {interval_entry(1, "steam", kMarch, 0.1 + 0.2),
                   interval_entry(2, "steam", kMarch + kQuarter, std::nan("")),
                   {.number = 3, .meter = "steam", .interval = kQuarter, .stored = {}},
                   month_entry(4, "steam", month_of(2024, 3), 1.0 / 3.0)};
  auto& missing = std::get<StoredInterval>(batch.entries[1].stored).reading;
  missing.validity = metering::Validity::missing;
  missing.reasons = metering::Reason::timeout | metering::Reason::manual;
  missing.late = true;
  auto& empty = std::get<StoredMonth>(batch.entries[3].stored).figure;
  empty.peak.reset();
  empty.usable = false;
  empty.unusable_because = "too \"few\" slots";
  ASSERT_TRUE(send(batch));
  EXPECT_EQ(contents(*connection_, 4),
            "steam 0\n"
            "2024-03-01T00:00:00Z 0.30000000000000004 ok  0\n"
            "2024-03-01T00:15:00Z nan missing timeout|manual 1\n"
            "2024-03 0 0.33333333333333331 0.10000000000000001 -1 900 0.98999999999999999 0.01 20 "
            "2976 0too \"few\" slots  2024-05-01T06:00:04Z 2024a\n");
}

// Too long to be printed.
TEST_F(Record, TheSameRowsGiveTheSameStoreForEver) {
  RecordBatch batch = intervals(0, 6'000);  // more than are copied at once
  batch.entries.push_back(month_entry(6'001, "steam", month_of(2024, 3), 5.0));
  batch.entries.push_back(interval_entry(6'002, "steam", kMarch + kQuarter, 6.0, 1));
  batch.entries.push_back(month_entry(6'003, "steam", month_of(2024, 3), 7.0));
  ASSERT_TRUE(send(batch));
  const std::string early = contents(*connection_, 6'001);
  const std::string late = contents(*connection_, 6'003);
  EXPECT_NE(early.find("\n2024-03 0 5 "), std::string::npos);
  EXPECT_NE(late.find("\n2024-03 1 7 "), std::string::npos);
  EXPECT_NE(late.find("\n2024-03-01T00:15:00Z 6 "), std::string::npos);
  EXPECT_EQ(std::ranges::count(late, '\n'), 1 + 6'000 + 1);
  RecordBatch more{.outbox = 11, .after = entries(6'003)};
  more.entries = {interval_entry(6'004, "power", kMarch, 1.0),
                  interval_entry(6'005, "steam", kMarch + 2 * kQuarter, 8.0, 1),
                  month_entry(6'006, "steam", month_of(2024, 3), 9.0)};
  ASSERT_TRUE(send(more));
  EXPECT_TRUE(contents(*connection_, 6'001) == early);
  EXPECT_TRUE(contents(*connection_, 6'003) == late);
  EXPECT_NE(contents(*connection_, 6'006).find("\n2024-03 2 9 "), std::string::npos);
}

TEST_F(Record, AWrongClockHasRoomToo) {
  RecordBatch batch{.outbox = 11};
  const auto at = [](int year) {
    return metering::Instant{std::chrono::sys_days{std::chrono::year{year} / 1 / 1}};
  };
  std::int64_t number = 0;
  for (const int year : {1970, 1999, 2000, 2024, 2038, 2100, 2106}) {
    batch.entries.push_back(interval_entry(++number, "steam", at(year), year));
  }
  const auto taken = send(batch);
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(ask("SELECT mean_kw, tableoid::regclass FROM interval ORDER BY t_start"),
            "1970|interval_before\n1999|interval_before\n2000|interval_2000_01\n"
            "2024|interval_2024_01\n2038|interval_2038_01\n2100|interval_2100_01\n"
            "2106|interval_beyond\n");
}

TEST_F(Record, AMeterWithAnotherIntervalIsCopiedAsItWasThen) {
  ASSERT_TRUE(send(intervals(0, 4)));
  const std::string before = contents(*connection_, 4);
  RecordBatch batch{.outbox = 12};
  batch.entries = {interval_entry(1, "steam", kMarch, 9.0)};
  batch.entries[0].interval = std::chrono::seconds{300};
  ASSERT_TRUE(send(batch));
  EXPECT_EQ(contents(*connection_, 4), before);
  EXPECT_EQ(contents(*connection_, 5), "steam 0\n2024-03-01T00:00:00Z 9 ok  0\n");
}

TEST_F(Record, EventsAndResultsOfGatewaysAreKeptOnce) {
  RecordBatch batch{.outbox = 11};
  batch.entries = {month_entry(1, "steam", month_of(2024, 3), 1.0)};
  batch.events = {{.time = kNow,
                   .severity = Severity::warning,
                   .kind = "counter_reset",
                   .subject = "steam",
                   .text = std::string{"went\0back", 9},
                   .number = 1},
                  {.time = kNow, .kind = "started", .text = "recald runs", .number = 2}};
  batch.results = {{.number = 4,
                    .kind = JobKind::calibration,
                    .state = JobState::done,
                    .asked = kNow,
                    .ended = kNow + std::chrono::seconds{60},
                    .accepted = true,
                    .message = "good",
                    .result = {.document = "{\"gap\":0.1}"}}};
  ASSERT_TRUE(send(batch));
  const auto again = send(batch);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->until, (Progress{.entries = 1, .events = 2, .results = 4}));
  EXPECT_EQ(ask("SELECT number, severity, kind, subject, text FROM event ORDER BY number"),
            "1|1|counter_reset|steam|wentback\n2|0|started||recald runs\n");
  const auto results = newest_results(*connection_, JobKind::calibration);
  ASSERT_TRUE(results) << results.error().message;
  ASSERT_EQ(results->size(), 1u);
  EXPECT_EQ(results->at(0).site, "tower");
  EXPECT_EQ(results->at(0).from, "gateway");
  EXPECT_EQ(results->at(0).month, month_of(2024, 3));
  EXPECT_EQ(results->at(0).at, kNow + std::chrono::seconds{60});
  EXPECT_TRUE(results->at(0).accepted);
  EXPECT_EQ(results->at(0).summary, "");
  EXPECT_EQ(ask("SELECT summary FROM result"), "{\"gap\":0.1}\n");
  EXPECT_EQ(ask("SELECT count(*) FROM result"), "1\n");
  // A new outbox numbers its events again.
  ASSERT_TRUE(send(end_of_history(12)));
  RecordBatch restored{.outbox = 12, .after = {.events = 1}, .is_first = true};
  restored.events = {{.time = kNow, .kind = "restored", .number = 2}};
  ASSERT_TRUE(send(restored));
  EXPECT_EQ(ask("SELECT number, kind FROM event WHERE number > 2"), "3|restored\n");
}

TEST_F(Record, AMonthOfAllOutputsIsAJob) {
  RecordBatch batch{.outbox = 11};
  batch.entries = {month_entry(1, "steam", month_of(2024, 1), 1.0),
                   month_entry(2, "power", month_of(2024, 1), 1.0),  // before calibrate_from
                   month_entry(3, "steam", month_of(2024, 2), 1.0)};
  ASSERT_TRUE(send(batch));
  EXPECT_EQ(ask("SELECT count(*) FROM job"), "0\n");
  RecordBatch rest{.outbox = 11, .after = entries(3)};
  rest.entries = {month_entry(4, "gas", month_of(2024, 2), 1.0),  // not an output
                  month_entry(5, "power", month_of(2024, 2), 1.0),
                  month_entry(6, "gas", month_of(2024, 3), 1.0)};
  const auto listener = open();
  ASSERT_TRUE(listener->wait_for(kJobChannel, std::chrono::seconds{1}, {}));
  ASSERT_TRUE(send(rest));
  ASSERT_TRUE(send(rest));
  const auto woken = listener->wait_for(kJobChannel, std::chrono::seconds{600}, {});
  EXPECT_TRUE(woken && *woken);
  auto found = jobs(*connection_, "tower", 10);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 1u);
  const FleetJob first = found->at(0);
  EXPECT_EQ(first.kind, JobKind::calibration);
  EXPECT_EQ(first.month, month_of(2024, 2));
  EXPECT_EQ(first.until_seq, 5);
  EXPECT_EQ(first.now, kNow + std::chrono::seconds{5});
  EXPECT_EQ(first.asked_by, "month");
  EXPECT_EQ(first.site_version, 1);
  EXPECT_EQ(first.state, FleetJobState::waiting);

  // A corrected month is another job.
  RecordBatch corrected{.outbox = 11, .after = entries(6)};
  corrected.entries = {month_entry(7, "steam", month_of(2024, 2), 2.0)};
  ASSERT_TRUE(send(corrected));
  found = jobs(*connection_, "", 10);
  ASSERT_EQ(found->size(), 2u);
  EXPECT_EQ(found->at(0).month, month_of(2024, 2));
  EXPECT_EQ(found->at(0).until_seq, 7);
  EXPECT_NE(found->at(0).input_sha256, first.input_sha256);
}

TEST_F(Record, AMonthWithoutAnOutputThatCanBeUsedIsNoJob) {
  RecordBatch batch{.outbox = 11};
  batch.entries = {month_entry(1, "steam", month_of(2024, 3), 1.0),
                   month_entry(2, "power", month_of(2024, 3), 1.0)};
  for (OutboxEntry& entry : batch.entries)
    std::get<StoredMonth>(entry.stored).figure.usable = false;
  ASSERT_TRUE(send(batch));
  EXPECT_EQ(ask("SELECT count(*) FROM job"), "0\n");
  // Readings came late.
  RecordBatch late{.outbox = 11, .after = entries(2)};
  late.entries = {month_entry(3, "power", month_of(2024, 3), 2.0)};
  ASSERT_TRUE(send(late));
  EXPECT_EQ(ask("SELECT month, until_seq FROM job"), "2024-03|3\n");
}

TEST_F(Record, AMonthOfTheFutureIsNoJobAndNoJobsLabel) {
  RecordBatch batch{.outbox = 11};
  batch.entries = {month_entry(1, "steam", month_of(2024, 2), 1.0),
                   month_entry(2, "steam", month_of(2036, 8), 1.0),
                   month_entry(3, "power", month_of(2036, 8), 1.0)};
  ASSERT_TRUE(send(batch));
  EXPECT_EQ(ask("SELECT count(*) FROM job"), "0\n");
  // The clock is right again.
  RecordBatch rest{.outbox = 11, .after = entries(3)};
  rest.entries = {month_entry(4, "power", month_of(2024, 2), 1.0)};
  ASSERT_TRUE(send(rest));
  EXPECT_EQ(ask("SELECT month, until_seq FROM job"), "2024-02|4\n");
}

TEST_F(Record, AnOlderMonthThatIsCorrectedIsCalculatedWithTheNewest) {
  RecordBatch batch{.outbox = 11};
  std::int64_t number = 0;
  for (const unsigned month : {2u, 3u}) {
    for (const char* meter : {"steam", "power"}) {
      batch.entries.push_back(month_entry(++number, meter, month_of(2024, month), 1.0));
    }
  }
  ASSERT_TRUE(send(batch));
  RecordBatch corrected{.outbox = 11, .after = entries(4)};
  corrected.entries = {month_entry(5, "steam", month_of(2024, 2), 2.0)};
  ASSERT_TRUE(send(corrected));
  auto found = jobs(*connection_, "tower", 10);
  ASSERT_EQ(found->size(), 3u);
  EXPECT_EQ(found->at(0).month, month_of(2024, 3));
  EXPECT_EQ(found->at(0).until_seq, 5);
  // Told once more, under another numbering, it is nothing new.
  RecordBatch again{.outbox = 12};
  again.entries = {month_entry(1, "steam", month_of(2024, 2), 2.0),
                   month_entry(2, "power", month_of(2024, 2), 1.0)};
  ASSERT_TRUE(send(again));
  EXPECT_EQ(ask("SELECT count(*) FROM job"), "3\n");
}

// Which jobs there are must not depend on how the gateway cut its outbox into batches.
TEST_F(Record, JobsDoNotDependOnHowBatchesWereCut) {
  const testing::Seed seed;
  std::mt19937_64 random{seed.value()};
  std::vector<OutboxEntry> all;
  for (std::int64_t number = 1; number <= 60; ++number) {
    const char* const meter = random() % 3 == 0 ? "gas" : random() % 2 == 0 ? "steam" : "power";
    all.push_back(
        month_entry(number, meter, month_of(2024, 1 + unsigned(random() % 4)), double(number)));
  }
  std::string expected;
  for (const std::uint64_t longest : {60, 1, 5, 20}) {
    const std::string site = "cut-" + std::to_string(longest);
    ASSERT_TRUE(put_site(*connection_, described(site), "ann"));
    for (std::size_t begin = 0; begin < all.size();) {
      const std::size_t size =
          std::min(all.size() - begin, longest == 60 ? 60 : 1 + random() % longest);
      RecordBatch batch{.outbox = 11, .after = entries(std::int64_t(begin))};
      batch.entries.assign(all.begin() + begin, all.begin() + begin + size);
      ASSERT_TRUE(send(batch, site));
      begin += size;
    }
    const std::string jobs = ask(
        "SELECT j.kind, j.month, j.until_seq, j.now FROM job j JOIN site s ON s.number = j.site "
        "WHERE s.id = '" +
        site + "' ORDER BY j.until_seq");
    if (expected.empty()) expected = jobs;
    EXPECT_EQ(jobs, expected);
  }
  EXPECT_GT(std::ranges::count(expected, '\n'), 3) << expected;
}

}  // namespace
}  // namespace recald::record
