/// Registers that read zero for hours or days and come back to their true count.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <ostream>

#include "core/metering/months/close_month.hpp"
#include "core/metering/months/month_closer.hpp"
#include "core/metering/registers/interval_book.hpp"
#include "month_builder.hpp"

namespace recald::metering::counter_outage_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::seconds;
using testing::kHour;
using testing::kQuarter;
using testing::month;
using testing::utc;

const Instant kStart = utc(2023, 1, 1);
const Instant kEnd = utc(2023, 4, 1);
constexpr double kRated_kW = 120.0;

/// An office: 12 kW at night, up to 60 kW on working days.
double load_kW(Instant t) {
  const double hour = in_hours(t - kStart);
  const double of_day = std::fmod(hour, 24.0);
  const int day = static_cast<int>(hour / 24.0);
  const double base_kW = 12.0 + 2.0 * std::sin(0.9 * hour);
  if (day % 7 == 0 || day % 7 == 6 || of_day < 6.0 || of_day >= 20.0) return base_kW;
  return base_kW + 48.0 * std::sin((of_day - 6.0) / 14.0 * std::numbers::pi);
}

struct Outage {
  Instant begin;
  Instant end;
  [[nodiscard]] bool contains(Instant t) const { return begin <= t && t < end; }
};

struct Case {
  const char* name;
  seconds interval;
  double start_kWh;
  double resolution_kWh;
  std::vector<Outage> outages;
  std::vector<Outage> silences{};  ///< No sample at all.
  friend void PrintTo(const Case& which, std::ostream* out) { *out << which.name; }
};

struct Register {
  std::vector<RegisterSample> samples;
  std::map<Month, double> true_kWh;
};

bool is_any(const std::vector<Outage>& spans, Instant t) {
  return std::any_of(spans.begin(), spans.end(), [&](const Outage& o) { return o.contains(t); });
}

Register record(const Case& which) {
  Register made;
  double count_kWh = which.start_kWh;
  for (Instant t = kStart; t <= kEnd; t += which.interval) {
    if (!is_any(which.silences, t)) {
      const double r = which.resolution_kWh;
      const double shown_kWh = r > 0.0 ? std::floor(count_kWh / r) * r : count_kWh;
      made.samples.push_back({t, is_any(which.outages, t) ? 0.0 : shown_kWh});
    }
    const double step_kWh = load_kW(t) * in_hours(which.interval);
    const auto date = std::chrono::year_month_day{std::chrono::floor<days>(t)};
    made.true_kWh[date.year() / date.month()] += step_kWh;
    count_kWh += step_kWh;
  }
  return made;
}

class CounterOutage : public ::testing::TestWithParam<Case> {};

// Whatever the length, the months' energy is the counter's, and the outage is `scaled`.
TEST_P(CounterOutage, IsItsCountersDifference) {
  const Case& which = GetParam();
  const Register made = record(which);
  const auto readings =
      readings_from_register(0, made.samples, which.interval, {kRated_kW, which.resolution_kWh});

  Meter meter;
  meter.id = "main";
  meter.interval = which.interval;
  meter.rated_kW = kRated_kW;
  meter.zero_run_max = hours{2};
  std::vector<ClosedMonth> closed;
  MonthCloser closer{testing::calendar("UTC"), {meter}, {}, [&](ClosedMonth&& one) {
                       closed.push_back(std::move(one));
                     }};
  for (const Reading& reading : readings) closer.add(reading);
  closer.finish();

  double sum_kWh = 0.0;
  double true_kWh = 0.0;
  for (const ClosedMonth& one : closed) {
    const double got_kWh = one.figure.daily_average_kWh * one.slots.grid->days();
    const double month_kWh = made.true_kWh.at(one.figure.month);
    // An outage over a month's end may be shared out a little wrongly.
    EXPECT_NEAR(got_kWh, month_kWh, 0.03 * month_kWh) << to_string(one.figure.month);
    sum_kWh += got_kWh;
    true_kWh += month_kWh;
  }
  EXPECT_NEAR(sum_kWh, true_kWh, 0.001 * true_kWh);
  int inside = 0;
  int scaled = 0;
  for (const Reading& reading : readings) {
    if (!is_any(which.outages, reading.start)) continue;
    ++inside;
    scaled += reading.validity == Validity::scaled ? 1 : 0;
  }
  EXPECT_GT(inside, 0);
  EXPECT_EQ(scaled, inside);
}

INSTANTIATE_TEST_SUITE_P(
    Registers, CounterOutage,
    ::testing::Values(
        Case{"hours", kQuarter, 81'250.0, 0.1, {{utc(2023, 2, 7, 9), utc(2023, 2, 7, 15)}}},
        Case{"a_day_hourly", kHour, 81'250.0, 1.0, {{utc(2023, 2, 7, 9), utc(2023, 2, 8, 15)}}},
        Case{"days", kQuarter, 81'250.0, 0.1, {{utc(2023, 2, 7, 9), utc(2023, 2, 12, 3)}}},
        Case{"over_a_months_edge",
             kHour,
             81'250.0,
             0.0,
             {{utc(2023, 1, 28, 9), utc(2023, 2, 2, 3)}}},
        Case{"over_7_days", kQuarter, 81'250.0, 0.1, {{utc(2023, 2, 7, 9), utc(2023, 2, 17, 3)}}},
        Case{"twice",
             kHour,
             81'250.0,
             0.1,
             {{utc(2023, 2, 7, 9), utc(2023, 2, 9, 3)}, {utc(2023, 2, 11), utc(2023, 2, 14)}}},
        Case{"flickering",
             kHour,
             81'250.0,
             0.1,
             {{utc(2023, 2, 7, 9), utc(2023, 2, 9, 3)}, {utc(2023, 2, 9, 4), utc(2023, 2, 11)}}},
        // The whole register is less than its load could draw while nothing was read.
        Case{"young_register", kHour, 0.0, 0.1, {{utc(2023, 1, 1, 6), utc(2023, 1, 1, 10)}}},
        Case{"silence_then_zero",
             kHour,
             9'000.0,
             0.1,
             {{utc(2023, 2, 7, 9), utc(2023, 2, 12)}},
             {{utc(2023, 2, 7, 9), utc(2023, 2, 9)}}},
        Case{"zero_then_silence",
             kHour,
             900.0,
             0.1,
             {{utc(2023, 1, 4, 9), utc(2023, 1, 10)}},
             {{utc(2023, 1, 5), utc(2023, 1, 10)}}},
        Case{"five_days_in_each_of_two_months",
             kQuarter,
             81'250.0,
             0.1,
             {{utc(2023, 1, 27), utc(2023, 2, 6)}}},
        Case{"three_weeks", kHour, 81'250.0, 0.1, {{utc(2023, 2, 2), utc(2023, 2, 23)}}}),
    [](const auto& one) { return std::string{one.param.name}; });

/// Energy in kWh of readings from [begin, end).
double energy_kWh(const std::vector<Reading>& readings, Instant begin, Instant end,
                  seconds interval) {
  double sum_kWh = 0.0;
  for (const Reading& reading : readings) {
    if (reading.start < begin || reading.start >= end || std::isnan(reading.mean_kW)) continue;
    sum_kWh += reading.mean_kW * in_hours(interval);
  }
  return sum_kWh;
}

/// A register of `before_kWh` that is exchanged for one at zero, which does not count before
/// `counts`; hourly.
std::vector<RegisterSample> exchanged(double before_kWh, Instant at, Instant counts) {
  std::vector<RegisterSample> samples;
  double count_kWh = before_kWh;
  for (Instant t = kStart; t <= kEnd; t += kHour) {
    if (t == at) count_kWh = 0.0;
    samples.push_back({t, count_kWh});
    if (t < at || t >= counts) count_kWh += load_kW(t);
  }
  return samples;
}

int count(const std::vector<Reading>& readings, Validity validity) {
  return static_cast<int>(
      std::count_if(readings.begin(), readings.end(),
                    [&](const Reading& reading) { return reading.validity == validity; }));
}

// A new register counts from zero at once, or after a week of standing still, and passes the old
// count by itself some weeks later: its own count holds throughout.
TEST(CounterOutage, ARealResetThatCountsThroughTheOldValueStaysAReset) {
  const Instant at = utc(2023, 1, 11);
  for (const Instant counts : {at, at + days{7}}) {
    const auto samples = exchanged(3'000.0, at, counts);
    const auto readings = readings_from_register(0, samples, kHour, {kRated_kW, 0.1});
    EXPECT_EQ(count(readings, Validity::scaled), 2);  // until the reset was sure
    EXPECT_EQ(count(readings, Validity::missing), 1);
    EXPECT_NEAR(energy_kWh(readings, counts, kEnd, kHour), samples.back().value_kWh, 1e-6);
  }
}

// Two days after the exchange the new register is about to pass the old count when its load draws
// more than its rating for three hours: too much to book, and no return either.
TEST(CounterOutage, AJumpOfAResetRegisterAcrossTheOldValueIsNotAReturn) {
  const Instant at = utc(2023, 1, 3);
  auto samples = exchanged(0.0, at, at);
  const double old_kWh = samples[47].value_kWh;
  const auto passes = std::find_if(samples.begin() + 48, samples.end(), [&](const auto& sample) {
    return sample.value_kWh > old_kWh - 30.0;
  });
  for (auto sample = passes; sample != samples.end(); ++sample) {
    const auto hours_past = std::min<std::ptrdiff_t>(3, sample - passes + 1);
    sample->value_kWh += 200.0 * static_cast<double>(hours_past);
  }
  const auto readings = readings_from_register(0, samples, kHour, {kRated_kW, 0.1});
  EXPECT_EQ(count(readings, Validity::scaled), 2 + 2);  // until the reset and the jump were sure
  EXPECT_GT(energy_kWh(readings, at, passes->time, kHour), 0.9 * old_kWh);
}

// A converter shows its greatest number for nine days.
TEST(CounterOutage, ARegisterStuckHighReturnsToo) {
  Register made = record({"", kHour, 81'250.0, 0.1, {}});
  const Outage stuck{utc(2023, 2, 7), utc(2023, 2, 16)};
  for (RegisterSample& sample : made.samples) {
    if (stuck.contains(sample.time)) sample.value_kWh = 429'496.0;
  }
  const auto readings = readings_from_register(0, made.samples, kHour, {kRated_kW, 0.1});
  EXPECT_EQ(count(readings, Validity::missing), 0);
  EXPECT_NEAR(energy_kWh(readings, kStart, kEnd, kHour),
              made.samples.back().value_kWh - made.samples.front().value_kWh, 1e-6);
}

// The estimate inside an outage follows the hours of the day.
TEST(CounterOutage, ItsShapeIsThatOfTheDaysAround) {
  const auto made = record({"", kHour, 81'250.0, 0.1, {{utc(2023, 2, 7), utc(2023, 2, 10)}}});
  const auto readings = readings_from_register(0, made.samples, kHour, {kRated_kW, 0.1});
  const auto noon = energy_kWh(readings, utc(2023, 2, 8, 12), utc(2023, 2, 8, 14), kHour);
  const auto night = energy_kWh(readings, utc(2023, 2, 8, 1), utc(2023, 2, 8, 3), kHour);
  EXPECT_GT(noon, 2.5 * night);
}

}  // namespace
}  // namespace recald::metering::counter_outage_test
