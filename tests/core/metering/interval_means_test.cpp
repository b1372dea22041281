#include "core/metering/registers/interval_means.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "month_builder.hpp"

namespace recald::metering::interval_means_test {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;
using testing::kBlank;
using testing::kQuarter;
using testing::utc;

const Instant kStart = utc(2025, 6, 1);

struct Taken {
  std::vector<Reading> readings;
  IntervalMeans means{3, kQuarter, seconds{0}};
  IntervalMeans::Sink sink = [this](const Reading& one) { readings.push_back(one); };

  void take(seconds begin, seconds length, double mean_kW, Validity validity = Validity::ok) {
    means.take({kStart + begin, kStart + begin + length},
               {.meter = 0, .start = {}, .mean_kW = mean_kW, .validity = validity}, sink);
  }
};

// Whatever the lengths of spans, what lies in an interval is in it, and nothing is lost.
TEST(IntervalMeans, EnergyIsKept) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::uniform_int_distribution<int> length{1, seed % 3 == 0 ? 3000 : 420};
    std::uniform_real_distribution<double> load_kW{0.0, 50.0};
    Taken taken;
    double energy_kWh = 0.0;
    seconds at{0};
    while (at < std::chrono::hours{30}) {
      const seconds span{length(random)};
      const double mean_kW = load_kW(random);
      taken.take(at, span, mean_kW);
      energy_kWh += mean_kW * in_hours(span);
      at += span;
    }
    const seconds rest = (kQuarter - at % kQuarter) % kQuarter;
    taken.take(at, rest, 0.0);
    taken.means.finish(taken.sink);
    double sum_kWh = 0.0;
    for (std::size_t i = 0; i < taken.readings.size(); ++i) {
      EXPECT_EQ(taken.readings[i].start, kStart + kQuarter * i);
      EXPECT_EQ(taken.readings[i].validity, Validity::ok);
      EXPECT_EQ(taken.readings[i].meter, 3u);
      sum_kWh += taken.readings[i].mean_kW / 4.0;
    }
    EXPECT_NEAR(sum_kWh, energy_kWh, 1e-9 * energy_kWh);
  }
}

// Four fifths of an interval are enough; what is blank, filled or suspect is none of them.
TEST(IntervalMeans, AnIntervalNeedsFourFifths) {
  for (const Validity gap : {Validity::missing, Validity::filled, Validity::suspect}) {
    for (const int blank_s : {0, 170, 190}) {
      Taken taken;
      taken.take(seconds{0}, seconds{900 - blank_s}, 12.0);
      taken.take(seconds{900 - blank_s}, seconds{blank_s}, 99.0, gap);
      taken.means.finish(taken.sink);
      ASSERT_EQ(taken.readings.size(), 1u);
      const Reading& reading = taken.readings[0];
      EXPECT_EQ(reading.validity, blank_s > 180 ? Validity::missing : Validity::ok);
      if (blank_s > 180) {
        EXPECT_TRUE(std::isnan(reading.mean_kW));
        EXPECT_TRUE(has(reading.reasons, Reason::partial));
      } else {
        EXPECT_NEAR(reading.mean_kW, 12.0, 1e-12);
      }
    }
  }
}

TEST(IntervalMeans, OneEstimateMakesAnEstimate) {
  Taken taken;
  taken.take(seconds{0}, minutes{10}, 12.0);
  taken.take(minutes{10}, minutes{5}, 12.0, Validity::scaled);
  taken.take(minutes{15}, minutes{15}, 12.0);
  taken.means.finish(taken.sink);
  ASSERT_EQ(taken.readings.size(), 2u);
  EXPECT_EQ(taken.readings[0].validity, Validity::scaled);
  EXPECT_EQ(taken.readings[1].validity, Validity::ok);
}

// Two rows that overlap do not count twice.
TEST(IntervalMeans, WhatWasTakenIsNotTakenAgain) {
  Taken taken;
  taken.take(seconds{0}, minutes{10}, 12.0);
  taken.take(minutes{5}, minutes{10}, 12.0);
  taken.means.finish(taken.sink);
  ASSERT_EQ(taken.readings.size(), 1u);
  EXPECT_NEAR(taken.readings[0].mean_kW, 12.0, 1e-12);
}

}  // namespace
}  // namespace recald::metering::interval_means_test
