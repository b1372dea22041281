/// The outbox: what is stored is given out in order to each destination, once and for ever.
#include <gmock/gmock.h>

#include "adapters/ports/destination_cursors.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/sqlite/tables/tables.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::sqlite::outbox_table_test {
namespace {

using metering::Instant;
using recald::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr std::chrono::seconds kQuarter{900};

class OutboxTable : public ::testing::Test {
 protected:
  void store(int quarter, double mean_kW, metering::Validity validity = metering::Validity::ok) {
    StoreBatch batch;
    batch.intervals.push_back({{.meter = main_,
                                .start = kStart + quarter * kQuarter,
                                .mean_kW = mean_kW,
                                .validity = validity}});
    ASSERT_TRUE(store_->commit(batch).has_value());
  }
  /// The mean powers of the entries, and the daily averages of months.
  [[nodiscard]] std::vector<double> after(std::int64_t number) {
    std::vector<double> values;
    const auto entries = store_->outbox_after(number, 100);
    EXPECT_TRUE(entries.has_value());
    for (const OutboxEntry& entry : *entries) {
      EXPECT_EQ(entry.meter, "main");
      if (const auto* const interval = std::get_if<StoredInterval>(&entry.stored)) {
        values.push_back(interval->reading.mean_kW);
      } else if (const auto* const month = std::get_if<StoredMonth>(&entry.stored)) {
        values.push_back(month->figure.daily_average_kWh);
      }
    }
    return values;
  }
  [[nodiscard]] std::int64_t rows() {
    auto query = store_->database().prepare("SELECT count(*) FROM outbox").value();
    return query.step().value() ? query.integer(0) : -1;
  }
  void reopen() {
    store_.reset();
    store_.emplace(SqliteStore::open(folder_ / "site.db").value());
  }

  TemporaryFolder folder_;
  std::optional<SqliteStore> store_{SqliteStore::open(folder_ / "site.db").value()};
  std::uint32_t main_ = store_->meter_number("main", kQuarter).value();
};

TEST_F(OutboxTable, WithoutADestinationNothingIsKept) {
  store(0, 1.0);
  EXPECT_EQ(rows(), 0);
}

TEST_F(OutboxTable, ADestinationIsToldWhatIsStoredFromThenOn) {
  store(0, 1.0);
  ASSERT_TRUE(store_->keep_outbox_for({"broker"}).has_value());
  store(1, 2.0, metering::Validity::suspect);
  store(1, 3.0);  // better, so it replaces the other
  store(1, 3.0);  // the same again changes nothing
  ASSERT_TRUE(store_
                  ->put_month(main_,
                              {.month = std::chrono::year{2024} / 2, .daily_average_kWh = 240.0},
                              "2024a", kStart)
                  .has_value());
  const OutboxPosition position = store_->outbox_position("broker").value();
  EXPECT_THAT(after(position.sent), ElementsAre(2.0, 3.0, 240.0));
  EXPECT_EQ(position.last - position.sent, 3);
  EXPECT_EQ(wrong_sums(store_->database()).value(), "");
}

TEST_F(OutboxTable, WhatEveryoneHasHadIsForgottenAndItsNumberNotGivenAgain) {
  ASSERT_TRUE(store_->keep_outbox_for({"broker", "database"}).has_value());
  store(0, 1.0);
  store(1, 2.0);
  const auto entries = store_->outbox_after(0, 10).value();
  ASSERT_THAT(entries, SizeIs(2));
  ASSERT_TRUE(store_->put_outbox_position("broker", entries[1].number).has_value());
  EXPECT_EQ(rows(), 2);  // the database has had none of them
  EXPECT_THAT(after(store_->outbox_position("database")->sent), ElementsAre(1.0, 2.0));
  ASSERT_TRUE(store_->put_outbox_position("database", entries[1].number).has_value());
  EXPECT_EQ(rows(), 0);
  reopen();
  store(2, 3.0);
  EXPECT_THAT(after(store_->outbox_position("broker")->sent), ElementsAre(3.0));
}

TEST_F(OutboxTable, ADestinationThatIsTakenOutHoldsNothingBack) {
  ASSERT_TRUE(store_->keep_outbox_for({"broker", "database"}).has_value());
  store(0, 1.0);
  ASSERT_TRUE(store_->put_outbox_position("broker", store_->outbox_position("broker")->last));
  ASSERT_TRUE(store_->keep_outbox_for({"broker"}).has_value());
  EXPECT_EQ(rows(), 0);
  store(1, 2.0);
  EXPECT_THAT(after(store_->outbox_position("broker")->sent), ElementsAre(2.0));
  ASSERT_TRUE(store_->keep_outbox_for({}).has_value());
  store(2, 3.0);
  EXPECT_EQ(rows(), 0);
}

// Numbers begin again where nobody is told any more, so they are of another numbering then.
TEST_F(OutboxTable, ADestinationThatIsTakenOutLosesAllItsCursors) {
  const std::vector<std::string> cursors{events_cursor("fleet"), results_cursor("fleet"),
                                         identity_cursor("fleet")};
  ASSERT_TRUE(store_->keep_outbox_for({"fleet", "fleet 2"}).has_value());
  for (const std::string& cursor : cursors) ASSERT_TRUE(store_->put_cursor(cursor, 7));
  ASSERT_TRUE(store_->put_cursor(identity_cursor("fleet 2"), 8));
  ASSERT_TRUE(store_->keep_outbox_for({"fleet", "fleet 2"}).has_value());
  for (const std::string& cursor : cursors) EXPECT_EQ(store_->cursor(cursor).value(), 7) << cursor;
  ASSERT_TRUE(store_->keep_outbox_for({"fleet 2"}).has_value());
  for (const std::string& cursor : cursors) {
    EXPECT_EQ(store_->cursor(cursor).value(), std::nullopt) << cursor;
  }
  EXPECT_EQ(store_->cursor(identity_cursor("fleet 2")).value(), 8);
}

// A position of the outbox is no number of an event, although both are in one table.
TEST_F(OutboxTable, NumbersOfEventsDoNotDependOnIt) {
  ASSERT_TRUE(store_->keep_outbox_for({"broker"}).has_value());
  for (int quarter = 0; quarter < 20; ++quarter) store(quarter, 1.0);
  ASSERT_TRUE(store_->put_outbox_position("broker", 20).has_value());
  ASSERT_TRUE(store_->put_cursor(identity_cursor("broker"), 1'000'000).has_value());
  ASSERT_TRUE(store_->put_cursor(results_cursor("broker"), 20).has_value());
  ASSERT_TRUE(
      store_->commit({.events = {{kStart, Severity::info, "some", "main", "."}}}).has_value());
  EXPECT_EQ(store_->events(1)->front().number, 1);
}

}  // namespace
}  // namespace recald::sqlite::outbox_table_test
