/// Registers that are not plain totals: zeroed each day or month, running back, wrapping where
/// their digits end, standing still in what was read, logged only when they change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>

#include "core/metering/months/close_month.hpp"
#include "core/metering/months/month_closer.hpp"
#include "core/metering/registers/interval_book.hpp"
#include "core/metering/registers/rest.hpp"
#include "month_builder.hpp"

namespace recald::metering::register_kinds_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::kBlank;
using testing::kHour;
using testing::kQuarter;
using testing::utc;

constexpr double kRated_kW = 60.0;

/// A load whose quarters of an hour are drawn, from `begin` on.
struct DrawnLoad {
  Instant begin;
  std::vector<double> quarters_kWh;

  DrawnLoad(unsigned seed, Instant from, Instant to, bool rests_at_night) : begin{from} {
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> of_usual{0.7, 1.3};
    for (Instant t = from; t < to; t += kQuarter) {
      const auto hour = (t.time_since_epoch() / kHour) % 24;
      const bool rests = rests_at_night && (hour < 6 || hour >= 20);
      quarters_kWh.push_back(rests ? 0.0 : 2.5 * of_usual(random));
    }
  }

  [[nodiscard]] double used_kWh(Instant from, Instant to) const {
    double sum_kWh = 0.0;
    for (Instant t = from; t < to; t += kQuarter) {
      sum_kWh += quarters_kWh[static_cast<std::size_t>((t - begin) / kQuarter)];
    }
    return sum_kWh;
  }
  [[nodiscard]] Instant end() const { return begin + kQuarter * quarters_kWh.size(); }
};

double energy_kWh(const std::vector<Reading>& readings, seconds interval) {
  double sum_kWh = 0.0;
  for (const Reading& reading : readings) {
    if (std::isfinite(reading.mean_kW)) sum_kWh += reading.mean_kW * in_hours(interval);
  }
  return sum_kWh;
}

std::ptrdiff_t count(const std::vector<Reading>& readings, Validity validity) {
  return std::ranges::count(readings, validity, &Reading::validity);
}

struct ZeroedCase {
  const char* name;
  Resets resets;
  seconds step;
  bool shows_total_at_midnight;  ///< Else it is zero there already.
  friend void PrintTo(const ZeroedCase& which, std::ostream* out) { *out << which.name; }
};

class Zeroed : public ::testing::TestWithParam<ZeroedCase> {};

// Between the last sample before a reset and the reset nobody has counted; everything else is
// exact, through both changes of the clock.
TEST_P(Zeroed, CountsFromZeroAcrossItsResets) {
  const auto& [name, resets, step, shows_total] = GetParam();
  const auto calendar = testing::calendar("Europe/Amsterdam");
  const ResetTimes zeroed = reset_times(resets, calendar);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const Instant from = calendar.day_span(std::chrono::year{2025} / 3 / 20).begin;
    const Instant to = calendar.day_span(std::chrono::year{2025} / 11 / 3).begin;
    const DrawnLoad load{seed, from, to, seed % 2 == 0};
    std::vector<RegisterSample> samples;
    double lost_kWh = 0.0;
    for (Instant t = from; t <= to; t += step) {
      const Instant day = zeroed(shows_total && t > from ? t - seconds{1} : t);
      samples.push_back({t, load.used_kWh(std::max(from, day), t)});
      if (!shows_total && day == t && t > from) lost_kWh += load.used_kWh(t - step, t);
    }
    const auto readings = readings_from_register(0, samples, step, {kRated_kW, 0.001}, zeroed);
    EXPECT_NEAR(energy_kWh(readings, step), load.used_kWh(from, to) - lost_kWh, 1e-6);
    if (shows_total) {
      EXPECT_EQ(count(readings, Validity::ok), std::ssize(readings));
    }
    EXPECT_EQ(std::ssize(readings), (to - from) / step);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Registers, Zeroed,
    ::testing::Values(ZeroedCase{"daily", Resets::daily, kQuarter, true},
                      ZeroedCase{"daily_hourly", Resets::daily, kHour, true},
                      ZeroedCase{"daily_zero_at_midnight", Resets::daily, kQuarter, false},
                      ZeroedCase{"monthly", Resets::monthly, kHour, true},
                      ZeroedCase{"monthly_zero_at_midnight", Resets::monthly, kQuarter, false}),
    [](const auto& one) { return std::string{one.param.name}; });

// Samples beside the boundary: the register is zeroed between two of them.
TEST(ZeroedRegister, BetweenTwoSamplesTheLoadGoesOnForAShortTime) {
  const auto calendar = testing::calendar("UTC");
  std::vector<RegisterSample> samples;
  for (Instant t = utc(2025, 6, 1) + minutes{2}; t < utc(2025, 6, 4); t += minutes{5}) {
    samples.push_back({t, in_hours((t.time_since_epoch()) % days{1}) * 12.0});  // 12 kW
  }
  const auto readings = readings_from_register(0, samples, kQuarter, {kRated_kW, 0.001},
                                               reset_times(Resets::daily, calendar));
  for (const Reading& reading : readings) EXPECT_NEAR(reading.mean_kW, 12.0, 1e-6);
  EXPECT_EQ(count(readings, Validity::scaled), 2);
}

TEST(NetRegister, CountsBackWhatIsDelivered) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> net_kWh{-6.0, 5.0};
    std::vector<RegisterSample> samples{{utc(2025, 6, 1), 300.0}};
    std::vector<double> truth_kW;
    for (int i = 1; i < 3000; ++i) {
      truth_kW.push_back(4.0 * net_kWh(random));
      samples.push_back(
          {samples.back().time + kQuarter, samples.back().value_kWh + truth_kW.back() / 4.0});
    }
    const auto readings = readings_from_register(
        0, samples, kQuarter, {.rated_kW = 25.0, .resolution_kWh = 0.001, .runs_back = true});
    ASSERT_EQ(readings.size(), truth_kW.size());
    for (std::size_t i = 0; i < readings.size(); ++i) {
      EXPECT_NEAR(readings[i].mean_kW, truth_kW[i], 1e-6);
      EXPECT_EQ(readings[i].validity, Validity::ok);
    }
  }
}

// A display of five to eight digits of kWh or MWh that nobody described: it goes on at zero.
TEST(WrappingRegister, ItsDigitsSayWhereItWraps) {
  for (const double unit_kWh : {1.0, 1000.0, 40.0}) {
    for (const double end : {1e5, 1e6, 1e8}) {
      SCOPED_TRACE(unit_kWh * end);
      std::vector<RegisterSample> samples;
      for (int i = 0; i < 60; ++i) {
        const double shown = std::fmod(end - 10.0 + 0.4 * i, end);
        samples.push_back({utc(2025, 6, 1) + i * kQuarter, shown * unit_kWh});
      }
      const auto readings = readings_from_register(
          0, samples, kQuarter, {.rated_kW = 2.0 * unit_kWh, .digit_kWh = unit_kWh});
      EXPECT_NEAR(energy_kWh(readings, kQuarter), 59 * 0.4 * unit_kWh, 1e-6 * unit_kWh);
      EXPECT_EQ(count(readings, Validity::ok), 59);
    }
  }
}

// One that falls to zero from elsewhere was reset, or exchanged.
TEST(WrappingRegister, AFallFromTheMiddleIsNoWrap) {
  std::vector<RegisterSample> samples;
  for (int i = 0; i < 60; ++i) {
    samples.push_back({utc(2025, 6, 1) + i * kQuarter, (i < 30 ? 95'000.0 : 0.0) + 0.4 * i});
  }
  const auto readings =
      readings_from_register(0, samples, kQuarter, {.rated_kW = 2.0, .digit_kWh = 1.0});
  EXPECT_EQ(count(readings, Validity::missing), 1);
}

// A gateway repeats its last value for hours. What the register counted meanwhile is distributed
// over that time, and not lost.
TEST(StandingRegister, ARiseThatTheStandstillExplainsIsNotLost) {
  for (const int stands : {3, 10, 40}) {
    SCOPED_TRACE(stands);
    const DrawnLoad load{7, utc(2025, 6, 1), utc(2025, 6, 15), false};
    const Instant begin = utc(2025, 6, 5, 9, 15);
    const Instant end = begin + hours{stands};
    std::vector<RegisterSample> samples;
    for (Instant t = load.begin; t <= load.end(); t += kQuarter) {
      const Instant read = t > begin && t < end ? begin : t;
      samples.push_back({t, 5000.0 + load.used_kWh(load.begin, read)});
    }
    std::vector<RegisterNote> notes;
    const auto readings =
        readings_from_register(0, samples, kQuarter, {.rated_kW = 12.0}, {}, &notes);
    EXPECT_NEAR(energy_kWh(readings, kQuarter), load.used_kWh(load.begin, load.end()), 1e-6);
    EXPECT_EQ(std::ssize(readings), (load.end() - load.begin) / kQuarter);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].event, CounterEvent::caught_up);
  }
}

// An exchange for a register that reads more is explained by no standstill.
TEST(StandingRegister, AnExchangeAfterOneIsNotCounted) {
  std::vector<RegisterSample> samples;
  for (int i = 0; i < 200; ++i) {
    const double value_kWh = i < 90 ? 100.0 + 2.0 * i : i < 110 ? 280.0 : 6000.0 + 2.0 * i;
    samples.push_back({utc(2025, 6, 1) + i * kQuarter, value_kWh});
  }
  std::vector<RegisterNote> notes;
  const auto readings =
      readings_from_register(0, samples, kQuarter, {.rated_kW = 12.0}, {}, &notes);
  EXPECT_NEAR(energy_kWh(readings, kQuarter), 90 * 2.0 + 89 * 2.0, 1e-6);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].event, CounterEvent::jump);
  EXPECT_EQ(notes[0].before.value_kWh, 280.0);
  EXPECT_EQ(notes[0].after.value_kWh, 6220.0);
}

// Lighting that is off from eight to six has used nothing then, whatever the limits of other
// meters.
TEST(RestingRegister, StandingStillIsAMeasuredZero) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const DrawnLoad load{seed, utc(2025, 6, 1), utc(2025, 7, 1), true};
    std::vector<RegisterSample> samples;
    for (Instant t = load.begin; t <= load.end(); t += kQuarter) {
      samples.push_back({t, 5000.0 + load.used_kWh(load.begin, t)});
    }
    Meter meter;
    meter.zero_run_max = hours{2};
    meter.rated_kW = kRated_kW;
    meter.is_counted = true;
    std::vector<ClosedMonth> closed;
    MonthCloser closer{testing::calendar("UTC"), {meter}, {}, [&](ClosedMonth&& one) {
                         closed.push_back(std::move(one));
                       }};
    for (const Reading& one : readings_from_register(0, samples, kQuarter, {kRated_kW})) {
      closer.add(one);
    }
    closer.finish();
    ASSERT_EQ(closed.size(), 1u);
    EXPECT_NEAR(closed[0].figure.daily_average_kWh * 30.0, load.used_kWh(load.begin, load.end()),
                1e-6);
    EXPECT_EQ(closed[0].figure.coverage, 1.0);
  }
}

/// Drops what a register logged on change leaves out.
std::vector<RegisterSample> on_change(const std::vector<RegisterSample>& samples) {
  std::vector<RegisterSample> changed;
  for (const RegisterSample& sample : samples) {
    if (changed.empty() || sample.value_kWh != changed.back().value_kWh) changed.push_back(sample);
  }
  return changed;
}

TEST(RegisterLoggedOnChange, RestsBetweenItsRows) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const DrawnLoad load{seed, utc(2025, 6, 1), utc(2025, 6, 15), true};
    std::vector<RegisterSample> all;
    for (Instant t = load.begin; t <= load.end(); t += kQuarter) {
      all.push_back({t, 5000.0 + load.used_kWh(load.begin, t)});
    }
    const auto whole = with_rests(on_change(all));
    const auto readings = readings_from_register(0, whole, kQuarter, {kRated_kW});
    for (const Reading& reading : readings) {
      const double truth_kW = 4.0 * load.used_kWh(reading.start, reading.start + kQuarter);
      EXPECT_NEAR(reading.mean_kW, truth_kW, 1e-6) << to_string(reading.start);
    }
  }
}

// A register whose load goes on has outages, whether it repeats values elsewhere or not.
TEST(RegisterLoggedOnChange, AnOutageIsNoRest) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const DrawnLoad load{seed, utc(2025, 6, 1), utc(2025, 6, 15), false};
    std::mt19937 random{seed};
    std::uniform_int_distribution<int> length{3, 30};
    std::vector<RegisterSample> samples;
    int silent = 0;
    for (Instant t = load.begin; t <= load.end(); t += kQuarter) {
      if (silent == 0 && random() % 40 == 0) silent = length(random);
      if (silent > 0) --silent;
      if (silent == 0) samples.push_back({t, 5000.0 + load.used_kWh(load.begin, t)});
    }
    EXPECT_EQ(with_rests(samples), samples);
  }
}

TEST(RegisterLoggedOnChange, ARowWithoutAValueIsAnOutage) {
  const DrawnLoad load{3, utc(2025, 6, 1), utc(2025, 6, 15), true};
  std::vector<RegisterSample> samples;
  for (Instant t = load.begin; t <= load.end(); t += kQuarter) {
    samples.push_back({t, 5000.0 + load.used_kWh(load.begin, t)});
  }
  samples = on_change(samples);
  const auto gap = std::ranges::adjacent_find(
      samples, [](const auto& a, const auto& b) { return b.time - a.time > hours{5}; });
  const Instant unavailable = gap->time + hours{1};
  samples.insert(gap + 1, {unavailable, kBlank});
  const auto whole = with_rests(samples);
  const auto after = std::ranges::find(whole, unavailable, &RegisterSample::time) + 1;
  EXPECT_GT(after->time - unavailable, hours{5});  // no sample was made up in between
}

}  // namespace
}  // namespace recald::metering::register_kinds_test
