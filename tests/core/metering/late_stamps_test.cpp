/// Registers that were read on the grid and stamped late, and such that were read late, drawn by
/// program.
#include "core/metering/registers/late_stamps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random/rng.hpp"

namespace recald::metering::late_stamps_test {
namespace {

using std::chrono::seconds;

struct Logger {
  bool is_read_late;  ///< Else only its stamps are late.
  int interval_s;
  int late_max_s;
  double step_kWh;  ///< Of the register.
};

/// A load with nights, weekends and noise, known to the second.
std::vector<RegisterSample> samples_of(const Logger& logger, int days, Rng& rng) {
  std::vector<RegisterSample> samples;
  const Instant begin{std::chrono::sys_days{std::chrono::year{2024} / 3 / 1}};
  double counted_kWh = 1234.5;
  const int count = days * 86'400 / logger.interval_s;
  for (int i = 0; i < count; ++i) {
    const double hour = std::fmod(i * logger.interval_s / 3600.0, 24.0);
    const double load_kW =
        (20.0 + 15.0 * std::sin((hour - 8.0) * 0.2618)) * rng.uniform(0.75, 1.25);
    const auto late_s = static_cast<int>(rng.uniform(0.0, logger.late_max_s + 1.0));
    const double at_kWh = counted_kWh + (logger.is_read_late ? load_kW * late_s / 3600.0 : 0.0);
    samples.push_back({begin + seconds{i * logger.interval_s + late_s},
                       logger.step_kWh * std::floor(at_kWh / logger.step_kWh)});
    counted_kWh += load_kW * logger.interval_s / 3600.0;
  }
  return samples;
}

TEST(LateStamps, EnergyShowsWhenARegisterWasRead) {
  Rng rng{11};
  int decided = 0;  // of quarters of an hour, whose months have readings enough
  for (const bool is_read_late : {false, true}) {
    for (const int interval_s : {900, 1800, 3600}) {
      for (const double step_kWh : {0.001, 0.1}) {
        for (int draw = 0; draw < 10; ++draw) {
          const Logger logger{is_read_late, interval_s, 40, step_kWh};
          const auto judged = judge_stamps(samples_of(logger, 60, rng), seconds{interval_s});
          const auto wrong = is_read_late ? StampsBeside::as_grid : StampsBeside::as_read;
          EXPECT_NE(judged, wrong) << interval_s << " " << step_kWh;
          EXPECT_NE(judged, StampsBeside::none);
          if (interval_s == 900 && judged != StampsBeside::unclear) ++decided;
        }
      }
    }
  }
  EXPECT_GT(decided, 36);  // of 40
}

TEST(LateStamps, AFewDaysLeaveItOpenAndOneOffsetIsNone) {
  Rng rng{12};
  const Logger logger{true, 900, 5, 0.001};
  EXPECT_EQ(judge_stamps(samples_of(logger, 2, rng), seconds{900}), StampsBeside::unclear);
  for (const int late_s : {0, 1, -1, 13}) {
    auto samples = samples_of({false, 900, 0, 0.001}, 30, rng);
    for (RegisterSample& sample : samples) sample.time += seconds{late_s};
    EXPECT_EQ(judge_stamps(samples, seconds{900}), StampsBeside::none);
  }
  EXPECT_EQ(judge_stamps({}, seconds{900}), StampsBeside::none);
}

TEST(LateStamps, OnTheGridTheyKeepTheirOrder) {
  Rng rng{13};
  auto samples = samples_of({false, 900, 40, 0.001}, 3, rng);
  put_on_grid(samples, seconds{900});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].time.time_since_epoch() % seconds{900}, seconds{0});
    if (i > 0) {
      EXPECT_GT(samples[i].time, samples[i - 1].time);
    }
  }
}

}  // namespace
}  // namespace recald::metering::late_stamps_test
