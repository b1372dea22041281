#include "core/drift/watch/watch.hpp"

#include <gmock/gmock.h>

#include "core/random/rng.hpp"

namespace recald::drift {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<std::optional<double>> normals(Rng& rng, int outputs) {
  std::vector<std::optional<double>> surprises;
  for (int k = 0; k < outputs; ++k) surprises.emplace_back(rng.normal());
  return surprises;
}

// 4 000 quiet months of three meters: the family keeps to one alarm in 240 months.
TEST(Watch, AFamilyOfMetersKeepsToTheStatedRate) {
  Rng rng{31};
  int alarms = 0;
  constexpr int kSites = 800;
  constexpr int kSiteMonths = 60;
  for (int site = 0; site < kSites; ++site) {
    Watch watch{3, {}};
    for (int month = 0; month < kSiteMonths; ++month) {
      alarms += static_cast<int>(watch.observe(month, normals(rng, 3)).size());
    }
  }
  RecordProperty("alarms", alarms);
  EXPECT_GT(alarms, 0);
  EXPECT_LT(alarms, kSites * kSiteMonths / 240.0);
}

TEST(Watch, AStepIsFoundDatedAndItsDirectionTold) {
  Rng rng{32};
  Watch watch{2, {}};
  std::vector<Alarm> alarms;
  int month = 0;
  for (; month < 30; ++month) {
    EXPECT_THAT(watch.observe(month, normals(rng, 2)), IsEmpty());
  }
  for (; month < 40 && alarms.empty(); ++month) {
    auto surprises = normals(rng, 2);
    *surprises[1] -= 3.0;
    alarms = watch.observe(month, surprises);
  }
  ASSERT_THAT(alarms, SizeIs(1));
  EXPECT_EQ(alarms[0].output, 1);
  EXPECT_EQ(alarms[0].direction, -1);
  EXPECT_GE(alarms[0].evidence, 480.0);
  EXPECT_LE(alarms[0].since_earliest, 30);
  EXPECT_GE(alarms[0].since_latest, 30);
  EXPECT_NEAR(alarms[0].since, 30, 1);
  EXPECT_TRUE(alarms[0].is_calibrated);
}

// Surprises of twice the size that was promised, to either side; then a change beside them.
TEST(Watch, ForecastsThatAreTooSureMakeItsAlarmsDoubtful) {
  Watch watch{1, {}};
  std::vector<Alarm> alarms;
  int month = 0;
  for (; month < 30; ++month) {
    EXPECT_THAT(watch.observe(month, {month % 2 == 0 ? 2.0 : -2.0}), IsEmpty());
  }
  for (; month < 40 && alarms.empty(); ++month) alarms = watch.observe(month, {4.0});
  ASSERT_THAT(alarms, SizeIs(1));
  EXPECT_FALSE(alarms[0].is_calibrated);
}

TEST(Watch, MissingMonthsAreNoMonths) {
  Rng rng{34};
  Watch whole{1, {}};
  Watch gaps{1, {}};
  for (int i = 0; i < 20; ++i) {
    const auto surprises = normals(rng, 1);
    (void)whole.observe(i, surprises);
    (void)gaps.observe(3 * i, surprises);
    (void)gaps.observe(3 * i + 1, {std::nullopt});
  }
  EXPECT_EQ(gaps.state(0).log_evidence, whole.state(0).log_evidence);
  EXPECT_EQ(gaps.state(0).change_within_year, whole.state(0).change_within_year);
  ASSERT_TRUE(whole.state(0).calibration.has_value());
}

TEST(Watch, SameSurprisesSameState) {
  const auto run = [] {
    Rng rng{35};
    Watch watch{2, {}};
    for (int month = 0; month < 50; ++month) (void)watch.observe(month, normals(rng, 2));
    return watch.state(1);
  };
  EXPECT_EQ(run().log_evidence, run().log_evidence);
  EXPECT_EQ(run().cusum_upper, run().cusum_upper);
}

}  // namespace
}  // namespace recald::drift
