/// Rows that are not the meter's intervals: at other steps, beside the grid, at steps that change,
/// registers that are logged at any time. Each test draws its files.
#include "adapters/csv/row_steps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "adapters/csv/readings_csv.hpp"

namespace recald::csv::row_steps_test {
namespace {

using metering::Instant;
using metering::Reading;
using metering::Validity;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::HasSubstr;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2025} / 9 / 1};

/// A load that is known at every instant.
double energy_kWh(Instant from, Instant to) {
  const auto until = [](Instant t) {
    const double hour = metering::in_hours(t - kStart);
    return 8.0 * hour - 3.0 * std::sin(hour * std::numbers::pi / 12.0) * 12.0 / std::numbers::pi;
  };
  return until(to) - until(from);
}

struct Outcome {
  ReadingsReport report;
  std::vector<Reading> readings;

  [[nodiscard]] double sum_kWh() const {
    double sum_kWh = 0.0;
    for (const Reading& one : readings) {
      if (std::isfinite(one.mean_kW)) sum_kWh += one.mean_kW * metering::in_hours(interval());
    }
    return sum_kWh;
  }
  [[nodiscard]] seconds interval() const { return report.meters.at(0).shown.interval; }
};

struct File {
  Stamps stamps = Stamps::start;
  bool is_rate = false;
  std::string text = "timestamp,meter,value,unit\n";
  Instant end = kStart;

  /// Rows one after the other, each over `step`, with its stamp off by `beside`.
  void add(seconds step, int rows, seconds beside = seconds{0}) {
    for (int i = 0; i < rows; ++i, end += step) add_row(step, beside);
  }
  void add_row(seconds step, seconds beside) {
    const double used_kWh = energy_kWh(end, end + step);
    const double value = is_rate ? used_kWh / metering::in_hours(step) : used_kWh;
    const Instant stamp = (stamps == Stamps::start ? end : end + step) + beside;
    text += metering::to_string(stamp) + ",main," + std::to_string(value) +
            (is_rate ? ",kW\n" : ",kWh\n");
  }

  [[nodiscard]] Outcome read(ReadingsOptions options = {}) const {
    if (options.meters.empty()) options.meters.push_back({.name = "main"});
    options.meters.front().stamps = stamps;
    Outcome outcome;
    const ReadingsSink sink{.on_meter = {},
                            .on_reading = [&](const Reading& r) { outcome.readings.push_back(r); }};
    auto report = read_readings_text(text, "feed.csv", options, sink);
    EXPECT_TRUE(report.has_value());
    outcome.report = std::move(*report);
    return outcome;
  }
};

ReadingsOptions with_interval(seconds interval) {
  ReadingsOptions options;
  options.meters.push_back({.name = "main", .interval = interval});
  return options;
}

class Steps : public ::testing::TestWithParam<std::tuple<Stamps, bool>> {
 protected:
  [[nodiscard]] static File file() {
    return {.stamps = std::get<0>(GetParam()), .is_rate = std::get<1>(GetParam())};
  }
};

INSTANTIATE_TEST_SUITE_P(Files, Steps,
                         ::testing::Combine(::testing::Values(Stamps::start, Stamps::end),
                                            ::testing::Bool()),
                         [](const auto& one) {
                           return std::string{std::get<0>(one.param) == Stamps::start ? "start"
                                                                                      : "end"} +
                                  (std::get<1>(one.param) ? "_kW" : "_kWh");
                         });

// Rows every second, ten seconds, seven minutes or 901 seconds become intervals, and no energy is
// lost but what lies in the last, open interval.
TEST_P(Steps, RowsAtAnyStepAreAveraged) {
  struct Case {
    seconds step;
    seconds interval;
  };
  for (const auto& [step, interval] :
       {Case{seconds{1}, minutes{1}}, Case{seconds{10}, minutes{1}}, Case{seconds{30}, minutes{1}},
        Case{minutes{7}, minutes{10}}, Case{seconds{901}, minutes{15}},
        Case{minutes{2}, minutes{2}}, Case{minutes{1}, minutes{1}}}) {
    SCOPED_TRACE(step.count());
    File made = file();
    made.add(step, static_cast<int>(days{1} / step));
    const Outcome outcome = made.read();
    EXPECT_EQ(outcome.interval(), interval);
    EXPECT_EQ(outcome.report.issues.total, 0u);
    for (const Reading& one : outcome.readings) {
      if (one.validity != Validity::ok) continue;
      const double truth_kW =
          energy_kWh(one.start, one.start + interval) / metering::in_hours(interval);
      EXPECT_NEAR(one.mean_kW, truth_kW, 0.25) << metering::to_string(one.start);
    }
    EXPECT_NEAR(outcome.sum_kWh(), energy_kWh(kStart, made.end), 2.0);
    const auto words = step_sentences(outcome.report.meters[0].steps, interval);
    EXPECT_EQ(words.size(), step == interval ? 0u : 1u);
  }
}

TEST_P(Steps, ADeclaredIntervalIsKept) {
  for (const seconds step : {seconds{60}, seconds{300}, seconds{10}}) {
    File made = file();
    made.add(step, static_cast<int>(days{1} / step));
    const Outcome outcome = made.read(with_interval(minutes{15}));
    EXPECT_EQ(outcome.interval(), minutes{15});
    ASSERT_EQ(outcome.readings.size(), 96u);
    for (const Reading& one : outcome.readings) {
      EXPECT_NEAR(one.mean_kW, 4.0 * energy_kWh(one.start, one.start + minutes{15}), 1e-3);
    }
  }
}

// Hours and then halves, or the other way round, with gaps and in any order of the two: read at the
// longer interval both are right; the first row of the new step is named.
TEST_P(Steps, AStepThatChangesIsFollowed) {
  for (const auto& [before, after] : {std::pair{minutes{60}, minutes{30}},
                                      {minutes{30}, minutes{60}},
                                      {minutes{60}, minutes{15}},
                                      {minutes{15}, minutes{30}}}) {
    for (const int rows : {24, 100, 173}) {
      SCOPED_TRACE(before.count() * 1000 + rows);
      File made = file();
      made.add(before, rows);
      while (made.end.time_since_epoch() % hours{1} != seconds{0}) made.add(before, 1);
      const Instant change = made.end;
      made.add(after, rows);
      while (made.end.time_since_epoch() % hours{1} != seconds{0}) made.add(after, 1);
      const seconds longer = std::max(before, after);
      const Outcome outcome = made.read(with_interval(longer));
      EXPECT_EQ(outcome.report.issues.total, 0u);
      EXPECT_EQ(std::ssize(outcome.readings), (made.end - kStart) / longer);
      for (const Reading& one : outcome.readings) {
        const double truth_kW =
            energy_kWh(one.start, one.start + longer) / metering::in_hours(longer);
        EXPECT_NEAR(one.mean_kW, truth_kW, 1e-3) << metering::to_string(one.start);
      }
      const auto words = step_sentences(outcome.report.meters[0].steps, longer);
      ASSERT_FALSE(words.empty());
      EXPECT_THAT(words.back(),
                  HasSubstr(in_words(after) + ", before that every " + in_words(before)));
      const Instant named = outcome.report.meters[0].steps.back().stamp;
      EXPECT_LE(std::chrono::abs(named - change), hours{1});
    }
  }
}

// A file that was read at its first interval has no place for longer rows: they are left out, and
// the interval that has both is named.
TEST_P(Steps, LongerRowsAreLeftOutAndTold) {
  File made = file();
  made.add(minutes{15}, 200);
  made.add(minutes{60}, 50);
  const Outcome outcome = made.read();
  EXPECT_EQ(outcome.interval(), minutes{15});
  EXPECT_NEAR(outcome.sum_kWh(), energy_kWh(kStart, kStart + 200 * minutes{15}), 3.0);
  EXPECT_EQ(outcome.report.issues.total, 1u);
  const auto words = step_sentences(outcome.report.meters[0].steps, outcome.interval());
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], HasSubstr("interval = \"60m\""));
}

// Each day's amount counts in its own hours; where hours begin, they are as they were measured.
TEST_P(Steps, DaysBeforeHoursCountEvenly) {
  for (const int rows : {5, 30, 70, 400}) {
    SCOPED_TRACE(rows);
    File made = file();
    made.add(days{1}, rows);
    const Instant first = made.end;
    made.add(hours{1}, 200);
    const Outcome outcome = made.read();
    EXPECT_EQ(outcome.interval(), hours{1});
    EXPECT_EQ(std::ssize(outcome.readings), (made.end - kStart) / hours{1});
    EXPECT_NEAR(outcome.sum_kWh(), energy_kWh(kStart, made.end), 0.1);
    for (const Reading& one : outcome.readings) {
      const bool is_of_day = one.start < first;
      EXPECT_EQ(one.validity == metering::Validity::scaled, is_of_day);
      const Instant begin = is_of_day ? std::chrono::floor<days>(one.start) : one.start;
      const seconds length = is_of_day ? seconds{days{1}} : seconds{3600};
      EXPECT_NEAR(one.mean_kW, energy_kWh(begin, begin + length) / metering::in_hours(length),
                  1e-3);
    }
    const auto words = step_sentences(outcome.report.meters[0].steps, hours{1});
    ASSERT_FALSE(words.empty());
    EXPECT_THAT(words[0], HasSubstr("counts evenly over its time"));
  }
}

// Rows that are missing here and there are gaps, however many.
TEST_P(Steps, GapsAreNoChange) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    File made = file();
    std::size_t rows = 0;
    for (int i = 0; i < 1000; ++i) {
      if (random() % 4 == 0) {
        made.end += minutes{15};
      } else {
        made.add(minutes{15}, 1);
        ++rows;
      }
    }
    const Outcome outcome = made.read();
    EXPECT_EQ(outcome.interval(), minutes{15});
    EXPECT_EQ(outcome.readings.size(), rows);
    EXPECT_EQ(outcome.report.meters[0].steps.size(), 1u);
    for (const Reading& one : outcome.readings) {
      EXPECT_NEAR(one.mean_kW, 4.0 * energy_kWh(one.start, one.start + minutes{15}), 1e-3);
    }
  }
}

// Seconds beside the grid, constant, drifting or at random: a fifth of the interval is put on it if
// it is allowed or looked for; else each row is refused and names the key.
TEST_P(Steps, StampsBesideTheGridArePutOnIt) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::uniform_int_distribution<int> any{seed % 2 == 0 ? -59 : 1, 59};
    File made = file();
    const seconds step = seed % 3 == 0 ? hours{1} : minutes{15};
    const int constant = any(random);
    for (int i = 0; i < 500; ++i) {
      const int drift = 1 + i * 58 / 500;
      const int beside = seed % 4 == 0 ? constant : seed % 4 == 1 ? drift : any(random);
      made.add(step, 1, seconds{beside});
    }
    ReadingsOptions options;
    options.finds_tolerance = true;
    Outcome outcome = made.read(options);
    EXPECT_EQ(outcome.interval(), step);
    ASSERT_EQ(outcome.readings.size(), 500u);
    EXPECT_GT(outcome.report.meters[0].beside_max, seconds{0});
    EXPECT_LE(outcome.report.meters[0].beside_max, seconds{59});
    for (std::size_t i = 0; i < 500; ++i) {
      EXPECT_EQ(outcome.readings[i].start, kStart + step * i);
    }
    options = with_interval(step);
    options.meters[0].grid_tolerance = seconds{60};
    EXPECT_EQ(made.read(options).readings.size(), 500u);
    options.meters[0].grid_tolerance = seconds{0};
    outcome = made.read(options);
    EXPECT_LT(outcome.readings.size(), 50u);
    EXPECT_THAT(outcome.report.issues.listed[0].reason, HasSubstr("grid_tolerance = \""));
  }
}

// A power that is logged at any time is averaged over the time until the next.
TEST(IrregularRows, OfAPowerAreAveraged) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::uniform_int_distribution<int> step_s{20, 100};
    File made{.stamps = Stamps::start, .is_rate = true};
    while (made.end < kStart + days{1}) made.add(seconds{step_s(random)}, 1);
    const Outcome outcome = made.read();
    EXPECT_EQ(outcome.report.issues.total, 0u)
        << (outcome.report.issues.listed.empty() ? "" : outcome.report.issues.listed[0].reason);
    EXPECT_NEAR(outcome.sum_kWh(), energy_kWh(kStart, made.end), 0.5);
  }
}

// Amounts at any time have no interval; they may be those of a register.
TEST(IrregularRows, OfAnAmountAreRefused) {
  std::mt19937 random{1};
  std::uniform_int_distribution<int> step_s{200, 400};
  File made;
  for (int i = 0; i < 300; ++i) made.add(seconds{step_s(random)}, 1);
  const Outcome outcome = made.read();
  EXPECT_TRUE(outcome.readings.empty());
  EXPECT_THAT(outcome.report.issues.listed.at(0).reason,
              HasSubstr("does not come at regular times"));
}

TEST(IrregularRows, OfARegisterAreInterpolated) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::uniform_int_distribution<int> step_s{280, 320};
    std::string text = "timestamp,meter,value,unit\n";
    Instant t = kStart;
    for (; t < kStart + days{3}; t += seconds{step_s(random)}) {
      text += metering::to_string(t) + ",main," + std::to_string(5000.0 + energy_kWh(kStart, t)) +
              ",kWh\n";
    }
    File made;
    made.text = text;
    ReadingsOptions options;
    options.meters.push_back({.name = "main", .counter = {{.rated_kW = 20.0}}});
    const Outcome outcome = made.read(options);
    EXPECT_EQ(outcome.interval(), minutes{15});
    for (const Reading& one : outcome.readings) {
      EXPECT_EQ(one.validity, Validity::ok);
      EXPECT_NEAR(one.mean_kW, 4.0 * energy_kWh(one.start, one.start + minutes{15}), 0.1);
    }
  }
}

}  // namespace
}  // namespace recald::csv::row_steps_test
