#include "core/regression/design_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/regression/fit_quality.hpp"
#include "core/regression/folds.hpp"
#include "tests/core/regression/made_design.hpp"

namespace recald::regression {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

Error error_of(const DesignData& design) {
  const auto good = check_design(design);
  return good ? Error{ErrorCode::unsupported, "no error"} : good.error();
}

TEST(DesignData, AGoodDesignPasses) {
  EXPECT_TRUE(check_design(made_design(20, 12, 0.01)).has_value());
}

TEST(DesignData, SaysWhatIsMissingAndWhere) {
  auto design = made_design(20, 12, 0.01);
  design.values(6, 12 + 2) = kMissing;
  EXPECT_EQ(error_of(design).code, ErrorCode::not_finite);
  EXPECT_EQ(error_of(design).message,
            "output 'chw_peak_kw' is missing in run 7, month 2016-3; complete the design or leave "
            "that run out");
  design = made_design(20, 12, 0.01);
  design.theta(4, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error_of(design).message,
            "parameter 'outdoor_air' is infinite in run 5; complete the design or leave that run "
            "out");
  design = made_design(20, 12, 0.01);
  design.month_inputs(3, 0) = kMissing;
  EXPECT_EQ(error_of(design).message,
            "month input 'drybulb' has no number in month 2016-4; fill it in or leave that input "
            "out");
}

TEST(DesignData, SaysWhatNeverChanges) {
  auto design = made_design(20, 12, 0.01);
  design.theta.col(2).setConstant(0.05);
  EXPECT_EQ(error_of(design).code, ErrorCode::invalid_value);
  EXPECT_EQ(error_of(design).message,
            "parameter 'occupancy' is 0.05 throughout; vary it or leave it out");
  design = made_design(20, 12, 0.01);
  design.month_inputs.col(1).setConstant(90.0);
  EXPECT_EQ(error_of(design).message,
            "month input 'winddir' is 90 throughout; it explains nothing, leave it out");
  design = made_design(20, 12, 0.01);
  design.values.rightCols(12).setZero();
  EXPECT_EQ(error_of(design).message,
            "output 'steam_daily_kwh' is 0 in all runs and months; leave it out");
}

TEST(DesignData, SaysWhichParameterOthersDetermine) {
  auto design = made_design(20, 12, 0.01);
  design.theta.col(2) = 0.1 * design.theta.col(0) - design.theta.col(1);
  EXPECT_EQ(error_of(design).code, ErrorCode::invalid_value);
  EXPECT_EQ(error_of(design).message,
            "parameter 'occupancy' is determined by the parameters before it in all runs, so their "
            "effects cannot be told apart; leave one of them out or vary them independently");
}

TEST(DesignData, NeedsEnoughRunsAndDifferentNames) {
  EXPECT_EQ(error_of(made_design(4, 12, 0.01)).code, ErrorCode::not_enough_data);
  EXPECT_EQ(error_of(made_design(4, 12, 0.01)).message,
            "the design has 4 runs and 3 parameters; at least 5 runs are needed");
  auto design = made_design(20, 12, 0.01);
  design.parameters[1] = "set_point";
  EXPECT_EQ(error_of(design).message, "parameter 'set_point' comes twice; rename one of them");
}

TEST(RunFolds, DealEachRunOnceInEvenFolds) {
  Rng rng(1);
  const RunFolds folds(203, 10, rng);
  std::vector<int> all;
  for (int f = 0; f < folds.count(); ++f) {
    const auto out = folds.left_out(f);
    EXPECT_TRUE(out.size() == 20 || out.size() == 21);
    EXPECT_TRUE(std::is_sorted(out.begin(), out.end()));
    EXPECT_EQ(folds.kept(f).size() + out.size(), 203U);
    all.insert(all.end(), out.begin(), out.end());
  }
  std::sort(all.begin(), all.end());
  for (int r = 0; r < 203; ++r) EXPECT_EQ(all[static_cast<std::size_t>(r)], r);
}

TEST(Meters, AreGroupedByTheNamesOfTheirOutputs) {
  const auto meters = group_by_meter({"chw_daily_kwh", "elec_daily_kWh", "chw_peak_kw", "tariff"});
  ASSERT_EQ(meters.size(), 3U);
  EXPECT_EQ(meters[0].meter, "chw");
  EXPECT_THAT(meters[0].existing(), ::testing::ElementsAre(0, 2));
  EXPECT_EQ(meters[1].meter, "elec");
  EXPECT_THAT(meters[1].existing(), ::testing::ElementsAre(1));
  EXPECT_EQ(meters[2].meter, "tariff");
  const auto bare = group_by_meter({"daily_kwh", "peak_kw"});
  ASSERT_EQ(bare.size(), 1U);
  EXPECT_EQ(bare[0].meter, "");
  EXPECT_THAT(bare[0].existing(), ::testing::ElementsAre(0, 1));
}

}  // namespace
}  // namespace recald::regression
