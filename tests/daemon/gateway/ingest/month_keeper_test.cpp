/// Months closed out of the store: as a replay closes them, when they are due, and again.
#include "daemon/gateway/ingest/month_keeper.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "adapters/sqlite/sqlite_store.hpp"
#include "core/random/rng.hpp"
#include "tests/support/failing_store.hpp"

namespace recald::daemon::month_keeper_test {
namespace {

using metering::Instant;
using metering::Month;
using metering::MonthlyFigure;
using metering::Reading;
using metering::Validity;
using recald::testing::FailingStore;
using std::chrono::hours;
using std::chrono::seconds;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr seconds kQuarter{900};

metering::LocalCalendar calendar() {
  return metering::LocalCalendar::open("America/Chicago").value();
}
Month month(int number) {
  return std::chrono::year{2024} / std::chrono::month{static_cast<unsigned>(number)};
}

class MonthKeeperTest : public ::testing::Test {
 protected:
  MonthKeeperTest() : store_{sqlite::SqliteStore::open(":memory:").value()} {
    main_ = {store_.meter_number("main", kQuarter).value(), {.id = "main"}};
    heat_ = {store_.meter_number("heat", kQuarter).value(), {.id = "heat"}};
  }

  /// A load with a daily course, noise and holes.
  std::vector<Reading> readings(std::uint32_t number, Instant from, Instant to) {
    Rng rng{number + 1};
    std::vector<Reading> made;
    for (Instant t = from; t < to; t += kQuarter) {
      const double hour = static_cast<double>(t.time_since_epoch().count() % 86'400) / 3600.0;
      Reading reading{number, t, 60.0 + 30.0 * std::sin(hour / 24.0 * 6.28) + 3.0 * rng.normal()};
      const double chance = rng.uniform();
      if (chance < 0.01) continue;
      if (chance < 0.02) reading.validity = Validity::scaled;
      made.push_back(reading);
    }
    return made;
  }
  void put(const std::vector<Reading>& readings) {
    StoreBatch batch;
    for (const Reading& reading : readings) batch.intervals.push_back({reading});
    ASSERT_TRUE(store_.commit(batch).has_value());
  }
  MonthKeeper keeper() { return MonthKeeper{store_, calendar(), {}, "2025b"}; }
  [[nodiscard]] Instant end_of(int number) { return calendar().month_span(month(number)).end; }

  sqlite::SqliteStore store_;
  StoredMeter main_;
  StoredMeter heat_;
};

void expect_same(const MonthlyFigure& a, const MonthlyFigure& b) {
  EXPECT_EQ(a.month, b.month);
  EXPECT_EQ(a.daily_average_kWh, b.daily_average_kWh);
  EXPECT_EQ(a.daily_average_variance_kWh2, b.daily_average_variance_kWh2);
  EXPECT_EQ(a.peak->kW, b.peak->kW);
  EXPECT_EQ(a.peak->start, b.peak->start);
  EXPECT_EQ(a.coverage, b.coverage);
  EXPECT_EQ(a.slots_by_validity, b.slots_by_validity);
  EXPECT_EQ(a.usable, b.usable);
}

TEST_F(MonthKeeperTest, FiguresAreThoseOfAReplay) {
  const auto all = readings(main_.number, end_of(1) - hours{24 * 10}, end_of(5));
  put(all);
  std::vector<MonthlyFigure> replayed;
  metering::MonthCloser closer{calendar(), {main_.meter}, {}, [&](metering::ClosedMonth&& closed) {
                                 replayed.push_back(closed.figure);
                               }};
  for (Reading reading : all) {
    reading.meter = 0;
    closer.add(reading);
  }
  closer.finish();
  const auto closed = keeper().close_due(std::span{&main_, 1}, end_of(5) + hours{72});
  ASSERT_TRUE(closed.has_value()) << closed.error().message;
  ASSERT_EQ(closed->size(), replayed.size());
  ASSERT_THAT(*closed, SizeIs(5));
  for (std::size_t i = 0; i < closed->size(); ++i) {
    SCOPED_TRACE(i);
    expect_same((*closed)[i].figure, replayed[i]);
    EXPECT_EQ((*closed)[i].figure.revision, 0);
  }
  EXPECT_EQ(closed->at(2).figure.slots, 31 * 96 - 4);  // March: clocks go forward
}

TEST_F(MonthKeeperTest, AMonthClosesAWatermarkAfterItsEndAndOnce) {
  put(readings(main_.number, end_of(1), end_of(3)));
  EXPECT_THAT(*keeper().close_due(std::span{&main_, 1}, end_of(2) + hours{72} - seconds{1}),
              IsEmpty());
  EXPECT_THAT(*keeper().close_due(std::span{&main_, 1}, end_of(2) + hours{72}), SizeIs(1));
  EXPECT_THAT(*keeper().close_due(std::span{&main_, 1}, end_of(2) + hours{80}), IsEmpty());
  EXPECT_THAT(*store_.months(main_.number), SizeIs(1));
}

TEST_F(MonthKeeperTest, ASilentMetersMonthsComeOutEmpty) {
  put(readings(main_.number, end_of(1), end_of(2)));
  const auto closed = keeper().close_due(std::span{&main_, 1}, end_of(4) + hours{72});
  ASSERT_THAT(*closed, SizeIs(3));
  EXPECT_TRUE(closed->at(0).figure.usable);
  EXPECT_FALSE(closed->at(1).figure.usable);
  EXPECT_EQ(closed->at(2).figure.coverage, 0.0);
}

TEST_F(MonthKeeperTest, AMeterWithoutReadingsHasNoMonths) {
  EXPECT_THAT(*keeper().close_due(std::span{&heat_, 1}, end_of(4)), IsEmpty());
}

// late_after_close: the month is closed again with a higher revision, the old one stays.
TEST_F(MonthKeeperTest, AReopenedMonthIsClosedAgain) {
  auto all = readings(main_.number, end_of(1), end_of(2));
  const std::vector<Reading> late{all.begin() + 500, all.begin() + 600};
  all.erase(all.begin() + 500, all.begin() + 600);
  put(all);
  const Instant now = end_of(2) + hours{72};
  const auto first = keeper().close_due(std::span{&main_, 1}, now);
  put(late);
  ASSERT_TRUE(store_.commit({.reopened = {{main_.number, month(2)}}}).has_value());
  const auto second = keeper().close_due(std::span{&main_, 1}, now + hours{1});
  ASSERT_THAT(*second, SizeIs(1));
  EXPECT_EQ(second->at(0).figure.revision, 1);
  EXPECT_GT(second->at(0).figure.coverage, first->at(0).figure.coverage);
  EXPECT_THAT(*keeper().close_due(std::span{&main_, 1}, now + hours{2}), IsEmpty());
  EXPECT_THAT(*store_.reopened(), IsEmpty());
}

TEST_F(MonthKeeperTest, AnotherRuleClosesMonthsAnewOnceAndSaysSo) {
  put(readings(main_.number, end_of(1), end_of(3)));
  const Instant now = end_of(3) + hours{72};
  ASSERT_THAT(*keeper().close_due(std::span{&main_, 1}, now), SizeIs(2));
  EXPECT_THAT(*store_.events(10), IsEmpty());

  metering::CloserOptions stricter;
  stricter.closing.coverage_min = 0.999;
  MonthKeeper other{store_, calendar(), stricter, "2025b"};
  const auto anew = other.close_due(std::span{&main_, 1}, now + hours{1}, {}, 1);
  ASSERT_THAT(*anew, SizeIs(1)) << "some at a time";
  EXPECT_EQ(anew->front().figure.revision, 1);
  EXPECT_THAT(*other.close_due(std::span{&main_, 1}, now + hours{1}), SizeIs(1));
  EXPECT_THAT(*other.close_due(std::span{&main_, 1}, now + hours{2}), IsEmpty());
  const auto months = store_.months(main_.number);
  ASSERT_TRUE(months.has_value());
  for (const StoredMonth& month : *months) {
    EXPECT_EQ(month.figure.revision, 1);
  }
  const auto events = *store_.events(10);
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].kind, "rules_changed");
  EXPECT_EQ(events[0].subject, "main");
}

TEST_F(MonthKeeperTest, AStoreThatRefusesIsAskedAgainLater) {
  put(readings(main_.number, end_of(1), end_of(2)));
  FailingStore failing{store_};
  MonthKeeper keeper{failing, calendar(), {}, "2025b"};
  failing.refuses = true;
  EXPECT_FALSE(keeper.close_due(std::span{&main_, 1}, end_of(2) + hours{72}).has_value());
  failing.refuses = false;
  EXPECT_THAT(*keeper.close_due(std::span{&main_, 1}, end_of(2) + hours{72}), SizeIs(1));
}

// tzdata_changed: a month that is open has no boundaries yet and closes by the rules that hold
// then; what was closed before stays. The new rules are Regina's: no summer time.
TEST_F(MonthKeeperTest, TzdataChanged) {
  auto all = readings(main_.number, end_of(2), end_of(5));
  const Instant april_until_now = end_of(3);
  for (Reading& reading : all) {
    const bool is_first_hour =
        april_until_now <= reading.start && reading.start < april_until_now + hours{1};
    if (is_first_hour) reading.mean_kW = 500.0;
  }
  put(all);
  ASSERT_THAT(keeper().close_due(std::span{&main_, 1}, end_of(3) + hours{72}).value(), SizeIs(1));
  const auto changed = metering::LocalCalendar::open("America/Regina").value();
  MonthKeeper updated{store_, changed, {}, "2026a"};
  const auto closed =
      updated.close_due(std::span{&main_, 1}, changed.month_span(month(4)).end + hours{72}).value();
  ASSERT_THAT(closed, SizeIs(1));
  EXPECT_EQ(closed[0].figure.month, month(4));
  EXPECT_EQ(closed[0].figure.revision, 0);
  EXPECT_LT(closed[0].figure.peak->kW, 200.0);  // that hour is March's now
  const auto months = store_.months(main_.number).value();
  ASSERT_THAT(months, SizeIs(2));
  EXPECT_EQ(months[0].figure.revision, 0);
}

}  // namespace
}  // namespace recald::daemon::month_keeper_test
