#include "core/drift/named_change.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace recald::drift {
namespace {

constexpr int kElectricity = 0;
constexpr int kHeat = 2;

Cause cause(CauseKind kind, int index, double probability) {
  return {.kind = kind,
          .index = index,
          .probability = probability,
          .mean = 1.2,
          .q05 = 1.1,
          .q95 = 1.3};
}

/// Months that blame the building's outdoor air or the heat meter alike.
std::vector<Cause> undecided() {
  return {cause(CauseKind::parameter, 1, 0.40), cause(CauseKind::meter, kHeat, 0.45),
          cause(CauseKind::unknown, -1, 0.05), cause(CauseKind::nothing, 0, 0.10)};
}

double probability(const std::vector<Cause>& causes, CauseKind kind) {
  double sum = 0.0;
  for (const Cause& one : causes) {
    if (one.kind == kind) sum += one.probability;
  }
  return sum;
}

double total(const std::vector<Cause>& causes) {
  return std::accumulate(causes.begin(), causes.end(), 0.0,
                         [](double sum, const Cause& one) { return sum + one.probability; });
}

TEST(NamedChange, HoursDecideWhatMonthsLeaveOpen) {
  const NamedChange names{{{"outdoor_air_amount", "Outdoor air", -1, 0.85},
                           {"scale_fault", "Wrong scale", kHeat, 0.10}},
                          0.05};
  const auto causes = with_names(undecided(), names);
  EXPECT_EQ(causes.front().effect, "outdoor_air_amount");
  EXPECT_EQ(causes.front().kind, CauseKind::effect);
  EXPECT_NEAR(causes.front().probability, 0.9 * 0.85, 1e-12);
  EXPECT_NEAR(total(causes), 1.0, 1e-12);
  EXPECT_NEAR(probability(causes, CauseKind::nothing), 0.10, 1e-12)
      << "whether it is anything at all is the months' to say";
}

TEST(NamedChange, AMeterIsToldWhatIsLikeliestWrongWithIt) {
  const NamedChange names{{{"scale_fault", "Wrong scale", kHeat, 0.3},
                           {"phase_lost", "A phase lost", kHeat, 0.6},
                           {"server_room", "Server room", -1, 0.1}},
                          0.0};
  const auto causes = with_names(undecided(), names);
  EXPECT_EQ(causes.front().kind, CauseKind::meter);
  EXPECT_EQ(causes.front().index, kHeat);
  EXPECT_EQ(causes.front().effect, "phase_lost");
  EXPECT_NEAR(causes.front().probability, 0.9 * 0.9, 1e-12) << "both are faults of that meter";
  EXPECT_DOUBLE_EQ(causes.front().mean, 1.2) << "the factor is the months'";
}

TEST(NamedChange, WhatTheHoursCannotNameTheMonthsDo) {
  const NamedChange names{{{"server_room", "Server room", -1, 0.1}}, 0.9};
  const auto causes = with_names(undecided(), names);
  EXPECT_EQ(causes.front().kind, CauseKind::parameter);
  EXPECT_NEAR(probability(causes, CauseKind::effect), 0.9 * 0.1, 1e-12);
  EXPECT_NEAR(causes.front().probability, 0.9 * 0.9 * 0.40 / 0.45, 1e-12);
}

TEST(NamedChange, WhatIsSaidOfAMeterWithoutAMonthSinceIsUnknown) {
  const NamedChange names{
      {{"clock_offset", "Clock", kElectricity, 0.8}, {"server_room", "Server room", -1, 0.2}}, 0.0};
  const auto causes = with_names(undecided(), names);
  EXPECT_NEAR(probability(causes, CauseKind::effect), 0.9 * 0.2, 1e-12);
  EXPECT_NEAR(probability(causes, CauseKind::parameter), 0.9 * 0.8 * 0.40 / 0.45, 1e-12);
  EXPECT_NEAR(total(causes), 1.0, 1e-12);
}

}  // namespace
}  // namespace recald::drift
