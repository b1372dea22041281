#include "core/regression/outlying_runs.hpp"

#include <gtest/gtest.h>

#include "tests/core/regression/made_design.hpp"

namespace recald::regression {
namespace {

TEST(OutlyingRuns, AnOrdinaryDesignHasNone) {
  EXPECT_TRUE(outlying_runs(made_design(200, 12, 0.05)).empty());
  EXPECT_TRUE(outlying_runs(made_design(12, 12, 0.05)).empty());
}

TEST(OutlyingRuns, OneOfTwoHundredWithEightTimesTheMedianIsFound) {
  DesignData design = made_design(200, 12, 0.01);
  Eigen::VectorXd column = design.values.col(12 + 5);
  std::sort(column.begin(), column.end());
  design.values(41, 12 + 5) = 8.0 * column[100];
  const auto found = outlying_runs(design);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].run, 41);
  EXPECT_EQ(found[0].output, 1);
  EXPECT_EQ(found[0].month, 5);
  EXPECT_EQ(found[0].value, 8.0 * column[100]);
  EXPECT_NEAR(found[0].median, column[100], 0.05 * column[100]);
}

// Two failed runs are alike: neither may hide behind the other.
TEST(OutlyingRuns, TwoThatAreAlikeAreBothFound) {
  DesignData design = made_design(100, 12, 0.01);
  const double wild = 8.0 * design.values.col(2).maxCoeff();
  for (const Eigen::Index run : {3, 70}) design.values(run, 2) = wild;
  EXPECT_EQ(outlying_runs(design).size(), 2u);
}

// Heat in a month in which most runs have none is rare, and no failure.
TEST(OutlyingRuns, AMonthOfAlmostNothingIsMeasuredByTheOthers) {
  DesignData design = made_design(100, 12, 0.01);
  const double typical = design.values.col(0).mean();
  design.values.col(6).setZero();
  design.values(9, 6) = 0.02 * typical;
  for (const OutlyingRun& out : outlying_runs(design)) EXPECT_NE(out.run, 9);
}

}  // namespace
}  // namespace recald::regression
