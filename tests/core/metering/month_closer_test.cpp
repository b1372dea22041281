#include "core/metering/months/month_closer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "month_builder.hpp"

namespace recald::metering::month_closer_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::seconds;
using testing::calendar;
using testing::kBlank;
using testing::kHour;
using testing::month;
using testing::utc;

double load_kW(Instant t) {
  const auto hour = t.time_since_epoch() / hours{1};
  return 20.0 + static_cast<double>(hour % 24) + 0.25 * static_cast<double>(hour % 7);
}

/// Hourly meters in Chicago and everything that they closed.
struct Pipeline {
  explicit Pipeline(std::size_t meters = 1, CloserOptions options = {})
      : closer{calendar("America/Chicago"), hourly(meters), std::move(options),
               [this](ClosedMonth&& month) { closed.push_back(std::move(month)); }} {}

  static std::vector<Meter> hourly(std::size_t count) {
    Meter meter;
    meter.interval = kHour;
    return std::vector<Meter>(count, meter);
  }

  void feed(Instant from, Instant to, std::uint32_t meter = 0) {
    for (Instant t = from; t < to; t += kHour) closer.add({meter, t, load_kW(t)});
  }

  [[nodiscard]] std::vector<std::string> months(std::uint32_t meter = 0) const {
    std::vector<std::string> names;
    for (const ClosedMonth& month : closed) {
      if (month.meter == meter) names.push_back(to_string(month.figure.month));
    }
    return names;
  }

  std::vector<ClosedMonth> closed;
  MonthCloser closer;
};

using Names = std::vector<std::string>;

TEST(MonthCloser, AMonthClosesWhenTheMetersOwnTimeIs72HoursBeyond) {
  Pipeline pipeline;
  // March ends in Chicago at 05:00 UTC on 1 April; the last reading before ends 72 h later.
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 4, 4, 4));
  EXPECT_TRUE(pipeline.closed.empty());
  pipeline.feed(utc(2016, 4, 4, 4), utc(2016, 4, 4, 5));
  ASSERT_EQ(pipeline.months(), Names{"2016-03"});
  EXPECT_TRUE(pipeline.closed[0].figure.usable);
  EXPECT_EQ(pipeline.closed[0].figure.coverage, 1.0);
  EXPECT_EQ(pipeline.closed[0].figure.slots, 743);
}

TEST(MonthCloser, FinishClosesWhatIsOpen) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 4, 1, 8));
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.months(), (Names{"2016-03", "2016-04"}));
  EXPECT_FALSE(pipeline.closed[1].figure.usable);  // three hours of April
}

TEST(MonthCloser, OrderOfMetersInTheFileDoesNotMatter) {
  Pipeline one_by_one{2};
  one_by_one.feed(utc(2016, 1, 1), utc(2016, 6, 1), 0);
  one_by_one.feed(utc(2016, 1, 1), utc(2016, 6, 1), 1);
  one_by_one.closer.finish();
  Pipeline interleaved{2};
  for (Instant t = utc(2016, 1, 1); t < utc(2016, 6, 1); t += kHour) {
    for (std::uint32_t meter : {0u, 1u}) interleaved.closer.add({meter, t, load_kW(t)});
  }
  interleaved.closer.finish();
  for (std::uint32_t meter : {0u, 1u}) {
    EXPECT_EQ(one_by_one.months(meter), interleaved.months(meter));
    EXPECT_EQ(one_by_one.months(meter).size(), 6u);  // December began before 1 January in UTC
  }
}

TEST(MonthCloser, MonthsWithoutAReadingComeOutUnusable) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 1, 1, 6), utc(2016, 2, 1, 6));
  pipeline.feed(utc(2016, 4, 1, 5), utc(2016, 4, 10));
  pipeline.closer.finish();
  ASSERT_EQ(pipeline.months(), (Names{"2016-01", "2016-02", "2016-03", "2016-04"}));
  EXPECT_EQ(pipeline.closed[1].figure.unusable_because, "no readings in this month");
  EXPECT_TRUE(std::isnan(pipeline.closed[2].figure.daily_average_kWh));
}

TEST(MonthCloser, ThePeriodComesOutWhole) {
  CloserOptions options;
  options.period = MonthRange{month(2015, 11), month(2016, 4)};
  Pipeline pipeline{2, options};
  pipeline.feed(utc(2016, 1, 1, 6), utc(2016, 2, 1, 6));  // the second meter never speaks
  pipeline.closer.finish();
  const Names whole{"2015-11", "2015-12", "2016-01", "2016-02", "2016-03", "2016-04"};
  EXPECT_EQ(pipeline.months(0), whole);
  EXPECT_EQ(pipeline.months(1), whole);
  const auto usable = std::count_if(pipeline.closed.begin(), pipeline.closed.end(),
                                    [](const ClosedMonth& m) { return m.figure.usable; });
  EXPECT_EQ(usable, 1);
}

TEST(MonthCloser, ASilentMetersMonthsCloseByTheClock) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 1, 1, 6), utc(2016, 1, 20));
  pipeline.closer.close_due(utc(2016, 2, 4, 5));
  EXPECT_TRUE(pipeline.closed.empty());
  pipeline.closer.close_due(utc(2016, 2, 4, 6));
  EXPECT_EQ(pipeline.months(), Names{"2016-01"});
  pipeline.closer.close_due(utc(2016, 3, 5));
  EXPECT_EQ(pipeline.months(), (Names{"2016-01", "2016-02"}));
}

TEST(MonthCloser, ALateReadingReopensItsMonthWithANewRevision) {
  Pipeline pipeline;
  const Instant late = utc(2016, 3, 10, 12);
  for (Instant t = utc(2016, 3, 1, 6); t < utc(2016, 4, 10); t += kHour) {
    if (t != late) pipeline.closer.add({0, t, load_kW(t)});
  }
  ASSERT_EQ(pipeline.months(), Names{"2016-03"});
  EXPECT_EQ(pipeline.closed[0].figure.slots_by_validity[2], 1);
  pipeline.closer.add({0, late, load_kW(late)});
  pipeline.closer.close_due(utc(2016, 4, 10));
  ASSERT_EQ(pipeline.months(), (Names{"2016-03", "2016-03"}));
  const ClosedMonth& again = pipeline.closed[1];
  EXPECT_EQ(again.figure.revision, 1);
  EXPECT_EQ(again.figure.coverage, 1.0);
  const auto slot = again.slots.grid->slot_at(late);
  EXPECT_EQ(again.slots.late[static_cast<std::size_t>(*slot)], 1);
  EXPECT_EQ(again.slots.validity[static_cast<std::size_t>(*slot)],
            Validity::ok);  // late is no flaw
  EXPECT_EQ(pipeline.closer.counts(0).late, 1);
  pipeline.closer.add({0, late, load_kW(late)});  // delivered again: nothing changes
  pipeline.closer.close_due(utc(2016, 4, 10));
  EXPECT_EQ(pipeline.closed.size(), 2u);
}

// A source's estimate gives way to what was measured, whichever comes first; two measured values
// contradict each other.
TEST(MonthCloser, MeasuredValuesReplaceEstimates) {
  const Instant at = utc(2016, 3, 10, 2);
  const Reading estimate{
      .start = at, .mean_kW = 33.0, .validity = Validity::scaled, .reasons = Reason::estimated};
  const Reading measured{.start = at, .mean_kW = 44.0};
  for (const bool is_first : {true, false}) {
    Pipeline pipeline;
    pipeline.feed(utc(2016, 3, 1, 6), at);
    pipeline.closer.add(is_first ? estimate : measured);
    pipeline.closer.add(is_first ? measured : estimate);
    pipeline.feed(at + kHour, utc(2016, 4, 1, 5));
    pipeline.closer.finish();
    const MonthSlots& slots = pipeline.closed.at(0).slots;
    const auto slot = static_cast<std::size_t>(slots.grid->slot_at(at).value());
    EXPECT_EQ(slots.used_kW[slot], 44.0);
    EXPECT_EQ(slots.validity[slot], Validity::ok);
    EXPECT_EQ(slots.reasons[slot], Reason::none);
    EXPECT_EQ(pipeline.closer.counts(0).conflicts, 0);
    EXPECT_EQ(pipeline.closed.at(0).figure.coverage, 1.0);
  }
}

TEST(MonthCloser, WhatIsNoLongerKeptIsCountedNotLost) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 1, 1, 6), utc(2016, 5, 20));
  const std::size_t closed = pipeline.closed.size();
  pipeline.closer.add({0, utc(2016, 1, 5), 1.0});
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.closer.counts(0).too_late, 1);
  EXPECT_EQ(pipeline.closed.size(), closed + 1);  // May, nothing reopened
}

TEST(MonthCloser, TheFirstOfTwoValuesStaysAndIsDoubted) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 3, 20));
  pipeline.closer.add({0, utc(2016, 3, 5), load_kW(utc(2016, 3, 5))});
  pipeline.closer.add({0, utc(2016, 3, 6), 99.0});
  pipeline.feed(utc(2016, 3, 20), utc(2016, 4, 1, 5));
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.closer.counts(0).duplicates, 1);
  EXPECT_EQ(pipeline.closer.counts(0).conflicts, 1);
  const MonthSlots& slots = pipeline.closed[0].slots;
  const auto slot = static_cast<std::size_t>(*slots.grid->slot_at(utc(2016, 3, 6)));
  EXPECT_EQ(slots.validity[slot], Validity::suspect);
  EXPECT_EQ(slots.reasons[slot], Reason::mismatch);
  EXPECT_EQ(slots.measured_kW[slot], load_kW(utc(2016, 3, 6)));
  EXPECT_EQ(pipeline.closed[0].figure.slots_by_validity[4], 1);
}

TEST(MonthCloser, AValueReplacesABlankButNotTheOtherWayRound) {
  Pipeline pipeline;
  pipeline.closer.add({0, utc(2016, 3, 5), kBlank});
  pipeline.closer.add({0, utc(2016, 3, 5), 30.0});
  pipeline.closer.add({0, utc(2016, 3, 5), kBlank});
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.closed[0].figure.slots_by_validity[0], 1);
  EXPECT_EQ(pipeline.closer.counts(0).conflicts, 0);
}

TEST(MonthCloser, OneWrongYearDoesNotCloseTheRecord) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 3, 20));
  pipeline.closer.add({0, utc(2026, 3, 20), 30.0});
  pipeline.feed(utc(2016, 3, 20), utc(2016, 4, 1, 5));
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.months(), Names{"2016-03"});
  EXPECT_EQ(pipeline.closed[0].figure.coverage, 1.0);
  EXPECT_EQ(pipeline.closer.counts(0).stray, 1);
}

// The stray is dropped by the ordinary reading after it; a second stray finds no partner.
TEST(MonthCloser, TwoStraysWithAReadingBetweenDoNotConfirmEachOther) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 3, 20));
  pipeline.closer.add({0, utc(2026, 3, 20), 30.0});
  pipeline.feed(utc(2016, 3, 20), utc(2016, 3, 20, 1));
  pipeline.closer.add({0, utc(2026, 3, 25), 30.0});
  pipeline.feed(utc(2016, 3, 20, 1), utc(2016, 4, 1, 5));
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.months(), Names{"2016-03"});
  EXPECT_EQ(pipeline.closer.counts(0).stray, 2);
}

TEST(MonthCloser, ALateBlankReopensNothing) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 3, 20));
  pipeline.feed(utc(2016, 3, 21), utc(2016, 4, 10));
  ASSERT_EQ(pipeline.closed.size(), 1u);
  pipeline.closer.add({0, utc(2016, 3, 20, 5), kBlank});
  pipeline.closer.close_due(utc(2016, 4, 10));
  EXPECT_EQ(pipeline.closed.size(), 1u);
}

TEST(MonthCloser, AWrongYearInTheFirstRowIsFoundOutToo) {
  Pipeline pipeline;
  pipeline.closer.add({0, utc(2026, 3, 1, 6), 30.0});
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 4, 1, 5));
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.months(), Names{"2016-03"});
  EXPECT_EQ(pipeline.closer.counts(0).stray, 1);
}

TEST(MonthCloser, ALongSilenceIsBelievedOnTheSecondReading) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 1, 1, 6), utc(2016, 2, 1, 6));
  pipeline.feed(utc(2016, 7, 1, 5), utc(2016, 8, 1, 5));
  pipeline.closer.finish();
  ASSERT_EQ(pipeline.months().size(), 7u);
  EXPECT_EQ(pipeline.closed[6].figure.coverage, 1.0);
  EXPECT_EQ(pipeline.closer.counts(0).stray, 0);
}

TEST(MonthCloser, ARecordMayBeginUnsorted) {
  Pipeline pipeline;
  pipeline.closer.add({0, utc(2016, 4, 1, 5), 30.0});
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 4, 1, 5));
  pipeline.closer.finish();
  EXPECT_EQ(pipeline.months(), (Names{"2016-03", "2016-04"}));
  EXPECT_EQ(pipeline.closer.counts(0).too_late, 0);
}

TEST(MonthCloser, OffGridReadingsAreRefused) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 3, 2));
  pipeline.closer.add({0, utc(2016, 3, 2, 0, 7), 30.0});
  EXPECT_EQ(pipeline.closer.counts(0).off_grid, 1);
}

TEST(MonthCloser, TheSourcesOwnVerdictIsRespected) {
  Pipeline pipeline;
  pipeline.feed(utc(2016, 3, 1, 6), utc(2016, 3, 10));
  pipeline.closer.add({0, utc(2016, 3, 10), 31.0, Validity::suspect, Reason::crc});
  pipeline.closer.add({0, utc(2016, 3, 10, 1), 32.0, Validity::filled});
  pipeline.closer.add({0, utc(2016, 3, 10, 2), 33.0, Validity::scaled});
  pipeline.feed(utc(2016, 3, 10, 3), utc(2016, 4, 1, 5));
  pipeline.closer.finish();
  const MonthlyFigure& figure = pipeline.closed[0].figure;
  EXPECT_EQ(figure.slots_by_validity[static_cast<std::size_t>(Validity::suspect)], 1);
  EXPECT_EQ(figure.slots_by_validity[static_cast<std::size_t>(Validity::filled)], 1);
  EXPECT_EQ(figure.slots_by_validity[static_cast<std::size_t>(Validity::scaled)], 1);
  EXPECT_TRUE(has(figure.reasons, Reason::crc));
}

// The local year 2016 begins in Auckland at 11:00 UTC on 31 December.
TEST(MonthCloser, TheYearTurnsLocally) {
  std::vector<ClosedMonth> closed;
  MonthCloser closer{calendar("Pacific/Auckland"), Pipeline::hourly(1), {}, [&](ClosedMonth&& m) {
                       closed.push_back(std::move(m));
                     }};
  for (Instant t = utc(2015, 12, 31, 11); t < utc(2016, 1, 31, 11); t += kHour) {
    closer.add({0, t, load_kW(t)});
  }
  closer.finish();
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_EQ(to_string(closed[0].figure.month), "2016-01");
  EXPECT_EQ(closed[0].figure.coverage, 1.0);
}

TEST(MonthCloser, SameReadingsSameFigures) {
  Pipeline a;
  Pipeline b;
  for (Pipeline* pipeline : {&a, &b}) {
    pipeline->feed(utc(2016, 1, 1, 6), utc(2016, 3, 15));
    pipeline->closer.finish();
  }
  ASSERT_EQ(a.closed.size(), b.closed.size());
  for (std::size_t i = 0; i < a.closed.size(); ++i) {
    EXPECT_EQ(a.closed[i].figure.daily_average_kWh, b.closed[i].figure.daily_average_kWh);
    EXPECT_EQ(a.closed[i].slots.used_kW, b.closed[i].slots.used_kW);
  }
}

}  // namespace
}  // namespace recald::metering::month_closer_test
