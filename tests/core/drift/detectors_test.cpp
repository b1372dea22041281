#include "core/drift/watch/detectors.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::drift {
namespace {

/// Steps until the alarm; the level is `shift` after `quiet` of them.
template <class Detector>
int steps_to_alarm(Detector detector, Rng& rng, double shift, int quiet, int steps_max) {
  for (int step = 0; step < steps_max; ++step) {
    if (detector.observe(rng.normal() + (step < quiet ? 0.0 : shift))) return step + 1;
  }
  return steps_max;
}

template <class Detector>
double mean_delay(const Detector& detector, double shift, int runs) {
  Rng rng{11};
  double sum = 0.0;
  int counted = 0;
  for (int run = 0; run < runs; ++run) {
    const int steps = steps_to_alarm(detector, rng, shift, 24, 4000);
    if (steps <= 24) continue;  // a false alarm
    sum += steps - 24;
    ++counted;
  }
  return sum / counted;
}

// The guarantee: with a true model an alarm in 240 months or fewer, on average.
TEST(EDetector, FalseAlarmsAreAsRareAsStated) {
  Rng rng{5};
  constexpr int kRuns = 1000;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    sum += steps_to_alarm(EDetector{1.0 / 240.0}, rng, 0.0, 0, 100'000);
  }
  EXPECT_GT(sum / kRuns, 240.0);
  // It is a bound and not far off: the published table of this mixture has 381.
  EXPECT_NEAR(sum / kRuns, 381.0, 40.0);
}

// Delays after 24 quiet months, simulated elsewhere with 2 000 to 4 000 runs.
TEST(EDetector, FindsShiftsAsFastAsOthersMeasuredIt) {
  const EDetector detector{1.0 / 240.0};
  EXPECT_NEAR(mean_delay(detector, 1.0, 1500), 10.2, 0.8);
  EXPECT_NEAR(mean_delay(detector, -2.0, 1500), 3.8, 0.3);
  EXPECT_NEAR(mean_delay(detector, 3.0, 1500), 2.3, 0.2);
}

TEST(EDetector, SaysTheDirectionAndBeginsAnew) {
  EDetector detector{1.0 / 240.0};
  int steps = 0;
  while (!detector.observe(-2.0)) ++steps;
  EXPECT_LT(steps, 6);
  EXPECT_LT(detector.likeliest_shift(), 0.0);
  EXPECT_GE(detector.log_evidence(), detector.log_threshold());
  EXPECT_FALSE(detector.observe(0.0));
}

TEST(EDetector, GoesOnWhereItStopped) {
  Rng rng{9};
  EDetector whole{1.0 / 240.0};
  EDetector first{1.0 / 240.0};
  for (int i = 0; i < 20; ++i) {
    const double u = rng.normal();
    (void)whole.observe(u);
    (void)first.observe(u);
  }
  EDetector second{1.0 / 240.0};
  second.restore(first.log_processes());
  (void)whole.observe(0.4);
  (void)second.observe(0.4);
  EXPECT_EQ(second.log_evidence(), whole.log_evidence());
}

// Mean run between false alarms 240 and delay 8.3 at one sd: the same simulation as above.
TEST(Cusum, HasItsPublishedRunLengths) {
  Rng rng{6};
  constexpr int kRuns = 1500;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    sum += steps_to_alarm(Cusum{4.34}, rng, 0.0, 0, 100'000);
  }
  EXPECT_NEAR(sum / kRuns, 240.0, 20.0);
  EXPECT_NEAR(mean_delay(Cusum{4.34}, 1.0, 1500), 8.3, 0.6);
}

TEST(ChangePoint, FindsWhenTheLevelChanged) {
  Rng rng{4};
  ChangePoint change;
  for (int i = 0; i < 60; ++i) change.observe(rng.normal());
  EXPECT_LT(change.change_within(6), 0.3);
  for (int i = 0; i < 9; ++i) change.observe(2.5 + rng.normal());
  const auto since = change.since();
  EXPECT_GE(since.longest, 9U);
  EXPECT_LE(since.shortest, 9U);
  EXPECT_NEAR(static_cast<double>(since.likeliest), 9.0, 1.0);
  EXPECT_GT(change.change_within(12), 0.95);
}

// A record of a few months has not changed merely because it is short.
TEST(ChangePoint, WhatBeganWithTheRecordIsNoChange) {
  Rng rng{5};
  for (int run = 0; run < 20; ++run) {
    ChangePoint change;
    EXPECT_EQ(change.change_within(12), 0.0);
    double sum = 0.0;
    for (int month = 1; month <= 12; ++month) {
      change.observe(0.3 * rng.normal());
      sum += change.change_within(12);
      EXPECT_LT(change.change_within(12), 0.7) << month;
    }
    EXPECT_LT(sum / 12.0, 0.35);
  }
}

// Bayes' rule by hand: two observations, a change between them or not.
TEST(ChangePoint, AgreesWithBayesRuleByHand) {
  const ChangePoint::Options options{.mean_run = 10.0, .prior_sd = 1.5, .runs_max = 100};
  ChangePoint change{options};
  const double a = 1.0;
  const double b = -0.5;
  change.observe(a);
  change.observe(b);
  const auto normal = [](double x, double variance) {
    return std::exp(-0.5 * x * x / variance) / std::sqrt(variance);
  };
  const double v = 1.5 * 1.5;
  // After the first: run 0 with the hazard, run 1 without; the second is predicted by either.
  const double fresh = normal(b, v + 1.0);
  const double kept = normal(b - a * v / (v + 1.0), v / (v + 1.0) + 1.0);
  const double total = 0.1 * fresh + 0.9 * kept;
  ASSERT_EQ(change.run_lengths().size(), 3U);
  EXPECT_NEAR(change.run_lengths()[0], 0.1, 1e-12);
  EXPECT_NEAR(change.run_lengths()[1], 0.9 * 0.1 * fresh / total, 1e-12);
  EXPECT_NEAR(change.run_lengths()[2], 0.9 * 0.9 * kept / total, 1e-12);
}

TEST(ChangePoint, LongQuietKeepsBoundedMemoryAndProbabilities) {
  ChangePoint change{{.mean_run = 60.0, .prior_sd = 2.0, .runs_max = 50}};
  Rng rng{8};
  for (int i = 0; i < 500; ++i) change.observe(rng.normal());
  EXPECT_EQ(change.run_lengths().size(), 50U);
  double sum = 0.0;
  for (const double probability : change.run_lengths()) sum += probability;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

}  // namespace
}  // namespace recald::drift
