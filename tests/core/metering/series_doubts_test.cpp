/// Hours added up where clocks change, and units that change on a day, in loads drawn by program.
#include "core/metering/months/series_doubts.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "core/random/rng.hpp"
#include "month_builder.hpp"

namespace recald::metering::series_doubts_test {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kBlank;
using testing::month;
using testing::month_reading;

std::vector<DataFinding> findings_of(const std::vector<MonthSlots>& months) {
  SeriesDoubts doubts;
  for (const MonthSlots& one : months) doubts.take(one);
  return doubts.describe("main");
}

/// A load with days, nights and noise. @param factor  By day of the month, from 0.
template <class Factor>
MonthSlots load(const std::string& zone, Month which, std::chrono::seconds interval, Rng& rng,
                Factor factor) {
  const double a_day = 86'400.0 / static_cast<double>(interval.count());
  return month_reading(zone, which, interval, [&](int slot) {
    const double hour = 24.0 * std::fmod(slot / a_day, 1.0);
    const double usual = 30.0 + 15.0 * std::sin((hour - 8.0) * 0.2618);
    return factor(static_cast<int>(slot / a_day)) * usual * rng.uniform(0.93, 1.07);
  });
}

struct Change {
  const char* zone;
  Month month;
  int first;  ///< Hour of the month, from its begin, that is repeated an hour later.
};

TEST(SeriesDoubts, TwoHoursInOneAreTold) {
  Rng rng{5};
  // 26 October 2025 02:00 of Berlin, 2 November 2025 01:00 of Chicago, 6 April 2025 02:00 of
  // Sydney.
  const std::vector<Change> changes{{"Europe/Berlin", month(2025, 10), 25 * 24 + 2},
                                    {"America/Chicago", month(2025, 11), 24 + 1},
                                    {"Australia/Sydney", month(2025, 4), 5 * 24 + 2}};
  for (const Change& change : changes) {
    for (const int minutes : {15, 30, 60}) {
      SCOPED_TRACE(std::string{change.zone} + " " + std::to_string(minutes));
      const int per_hour = 60 / minutes;
      MonthSlots whole = load(change.zone, change.month, std::chrono::minutes{minutes}, rng,
                              [](int) { return 1.0; });
      EXPECT_THAT(findings_of({whole}), IsEmpty());
      const int hour = change.first * per_hour;
      std::vector<int> starts;
      std::vector<int> ends_by_begin;
      for (int k = 0; k < per_hour; ++k) {
        starts.push_back(hour + k);
        ends_by_begin.push_back(hour + k);
      }
      std::vector<int> ends_by_clock;
      for (const int slot : starts) ends_by_clock.push_back(slot - 1);
      ends_by_begin.back() += per_hour;
      for (const auto& rows : {starts, ends_by_clock, ends_by_begin}) {
        MonthSlots once = whole;
        std::vector<double> both;
        // What stands in a row is the sum of the two intervals that it was written for.
        for (int k = 0; k < per_hour; ++k) {
          const auto first =
              static_cast<std::size_t>(rows == ends_by_clock ? hour + k - 1 : hour + k);
          const auto second = first + static_cast<std::size_t>(per_hour);
          both.push_back(whole.measured_kW[first] + whole.measured_kW[second]);
          once.measured_kW[first] = once.measured_kW[second] = kBlank;
        }
        MonthSlots missing = once;
        for (int k = 0; k < per_hour; ++k) {
          once.measured_kW[static_cast<std::size_t>(rows[static_cast<std::size_t>(k)])] =
              both[static_cast<std::size_t>(k)];
          // One that is merely missing is a gap, and no news here.
          missing.measured_kW[static_cast<std::size_t>(rows[static_cast<std::size_t>(k)])] =
              0.5 * both[static_cast<std::size_t>(k)];
        }
        EXPECT_THAT(findings_of({missing}), IsEmpty());
        EXPECT_THAT(findings_of({once}),
                    ElementsAre(Field(&DataFinding::sentence, HasSubstr("both hours added up"))));
      }
    }
  }
}

TEST(SeriesDoubts, AnotherUnitFromADayOnIsTold) {
  Rng rng{6};
  for (const double factor : {29.307, 1.0 / 29.307, 1000.0, 1e-3, 10.55, 1.0 / 10.55}) {
    for (const int since : {9, 15, 20}) {
      const auto found =
          findings_of({load("Europe/Berlin", month(2025, 5), std::chrono::minutes{30}, rng,
                            [&](int day) { return day >= since ? factor : 1.0; })});
      ASSERT_EQ(found.size(), 1U) << factor << " " << since;
      EXPECT_THAT(found[0].sentence, HasSubstr("From 2025-05-" + std::string(since < 9 ? "0" : "") +
                                               std::to_string(since + 1) + " on"))
          << factor;
    }
  }
}

// Buildings double, halve, close for weeks and open again.
TEST(SeriesDoubts, ABuildingIsNoUnit) {
  Rng rng{7};
  for (int draw = 0; draw < 300; ++draw) {
    const double factor = std::exp(rng.uniform(-2.0, 2.0));
    const int since = static_cast<int>(rng.below(30));
    EXPECT_THAT(findings_of({load("Europe/Berlin", month(2025, 5), std::chrono::minutes{60}, rng,
                                  [&](int day) { return day >= since ? factor : 1.0; })}),
                IsEmpty())
        << factor << " " << since;
  }
}

// Where a load comes to rest around that hour, its neighbours say little, but a peak says enough.
TEST(SeriesDoubts, APeakInTheHourThatStandsOnceIsTold) {
  Rng rng{9};
  for (const double factor : {2.0, 0.5}) {
    MonthSlots once = month_reading(
        "Europe/Berlin", month(2025, 10), std::chrono::hours{1},
        [&](int slot) { return slot % 24 < 2 ? 60.0 * rng.uniform(0.95, 1.05) : 0.0; });
    const std::size_t first = 25 * 24 + 2;
    once.measured_kW[first] = factor * 60.0;
    once.measured_kW[first + 1] = kBlank;
    once.validity[first + 1] = Validity::missing;
    const auto found = findings_of({once});
    if (factor > 1.0) {
      EXPECT_THAT(found,
                  ElementsAre(Field(&DataFinding::sentence, HasSubstr("both hours added up"))));
    } else {
      EXPECT_THAT(found, IsEmpty());
    }
  }
}

// A meter both ways draws and feeds in: the mean of its days may be of any size and sign.
TEST(SeriesDoubts, WhatTheSunLeavesIsNoUnit) {
  Rng rng{8};
  for (int draw = 0; draw < 300; ++draw) {
    const int since = static_cast<int>(rng.below(30));
    const double left = std::exp(rng.uniform(-4.0, 0.0));
    EXPECT_THAT(findings_of({load("America/Los_Angeles", month(2025, 5), std::chrono::minutes{60},
                                  rng, [&](int day) { return day >= since ? -left : -1.0; })}),
                IsEmpty())
        << left << " " << since;
  }
}

// A peak that only an estimate has is none, and somebody must know; one beside it is no news.
TEST(SeriesDoubts, APeakThatOnlyAnEstimateHasIsTold) {
  Rng rng{7};
  for (const double factor : {1.1, 0.9}) {
    for (const Reason reason : {Reason::estimated, Reason::partial}) {
      SCOPED_TRACE(factor);
      std::vector<MonthSlots> months;
      for (const unsigned number : {3u, 4u, 5u}) {
        months.push_back(load("Europe/Berlin", month(2025, number), std::chrono::minutes{15}, rng,
                              [](int) { return 1.0; }));
        if (number == 4) continue;
        const double highest_kW = std::ranges::max(months.back().measured_kW);
        const auto slot = static_cast<std::size_t>(rng.uniform(0.0, 2900.0));
        months.back().measured_kW[slot] = factor * highest_kW;
        months.back().validity[slot] = Validity::scaled;
        months.back().reasons[slot] = reason;
      }
      const auto found = findings_of(months);
      if (factor > 1.0 && reason == Reason::estimated) {
        EXPECT_THAT(found, ElementsAre(Field(&DataFinding::sentence,
                                             HasSubstr("In 2 months a value that its quality"))));
      } else {
        EXPECT_THAT(found, IsEmpty());
      }
    }
  }
}

}  // namespace
}  // namespace recald::metering::series_doubts_test
