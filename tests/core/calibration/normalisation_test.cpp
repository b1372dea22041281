#include "core/calibration/posterior/normalisation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace recald::calibration::normalisation_test {
namespace {

using ::testing::HasSubstr;
const double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Two outputs of two months, three runs.
Eigen::MatrixXd design() {
  Eigen::MatrixXd outputs(3, 4);
  outputs << 10, 30, 5, 6,  //
      12, 34, 7, 6,         //
      14, 40, 9, 8;
  return outputs;
}

std::vector<OutputMeasurements> measured(std::vector<double> first, std::vector<double> second) {
  return {{"heat", "kWh/day", std::move(first), {}, 1.0},
          {"power", "kW", std::move(second), {}, 1.0}};
}

TEST(Normalisation, MinAndMaxOverRunsAndMonths) {
  const auto n = normalise_design(design(), measured({11, 35}, {6, 7}), 2);
  ASSERT_TRUE(n.has_value());
  EXPECT_EQ(n->scales[0], (OutputScale{10, 40}));
  EXPECT_EQ(n->scales[1], (OutputScale{5, 9}));
  EXPECT_DOUBLE_EQ(n->scales[0].normalise(25), 0.5);
  EXPECT_DOUBLE_EQ(n->scales[0].normalise_variance(900), 1.0);
  // Normalised: 0, 2/30, 4/30, 20/30, 24/30, 1 and 0, 0.25, 0.5, 0.25, 1, 0.75.
  const double sum = 80.0 / 30.0 + 2.75;
  const double squares = (4.0 + 16.0 + 400.0 + 576.0 + 900.0) / 900.0 + 1.9375;
  EXPECT_NEAR(n->pooled_variance, (squares - sum * sum / 12.0) / 11.0, 1e-14);
}

TEST(Normalisation, AnOutputWithoutMeasurementsPlaysNoPart) {
  Eigen::MatrixXd outputs = design();
  outputs.rightCols(2).setConstant(3.0);
  const auto n = normalise_design(outputs, measured({11, 35}, {kMissing, kMissing}), 2);
  ASSERT_TRUE(n.has_value());
  EXPECT_EQ(n->scales[1], (OutputScale{0, 1}));
}

TEST(Normalisation, AConstantOutputIsRefused) {
  Eigen::MatrixXd outputs = design();
  outputs.rightCols(2).setConstant(3.0);
  const auto n = normalise_design(outputs, measured({11, 35}, {6, 7}), 2);
  ASSERT_FALSE(n.has_value());
  EXPECT_EQ(n.error().code, ErrorCode::invalid_value);
  EXPECT_THAT(n.error().message, HasSubstr("3 kW for power in every run and month"));
}

TEST(RangeCheck, AJanuaryFailureIsSeenThoughJulyReachesThatFar) {
  const auto outputs = measured({25, 35}, {kMissing, 9.5});
  const auto n = normalise_design(design(), outputs, 2);
  ASSERT_TRUE(n.has_value());

  const RangeCheck check = check_range(design(), outputs, *n);

  ASSERT_EQ(check.extrapolation.size(), 1u);  // 9.5 kW: beyond every run
  EXPECT_EQ(check.extrapolation[0].output, 1);
  EXPECT_EQ(check.extrapolation[0].month, 1);
  EXPECT_EQ(check.extrapolation[0].high, 9.0);
  ASSERT_EQ(check.by_month.size(), 2u);  // 25 kWh lies within 10…40, but January's runs end at 14
  EXPECT_EQ(check.by_month[0].output, 0);
  EXPECT_EQ(check.by_month[0].month, 0);
  EXPECT_EQ(check.by_month[0].low, 10.0);
  EXPECT_EQ(check.by_month[0].high, 14.0);
  EXPECT_EQ(check.by_month[1].value, 9.5);

  const std::vector<std::string> months{"2015-01", "2015-07"};
  const Findings findings = range_findings(check, outputs, months);
  ASSERT_EQ(findings.size(), 3u);
  EXPECT_EQ(findings[0].kind, FindingKind::extrapolation);
  EXPECT_EQ(findings[1].kind, FindingKind::range_fail);
  EXPECT_EQ(findings[0].sentence,
            "Power: 1 of 1 months is outside all runs of the model, the worst July 2015 (+6 %).");
  EXPECT_EQ(findings[1].sentence,
            "Heat: 1 of 2 months is outside the model's runs of that month, the worst January 2015 "
            "(+79 %).");
  EXPECT_THAT(findings[1].details, HasSubstr("Outside: January 2015 (+79 %). "));
  EXPECT_EQ(findings[1].share, 0.5);
}

TEST(RangeCheck, TooLowIsOutOfRangeToo) {
  const auto outputs = measured({9, 29}, {5, 6});
  const auto n = normalise_design(design(), outputs, 2);
  const RangeCheck check = check_range(design(), outputs, *n);
  ASSERT_EQ(check.extrapolation.size(), 1u);
  EXPECT_EQ(check.extrapolation[0].value, 9.0);
  ASSERT_EQ(check.by_month.size(), 2u);  // and July, 29 where its runs begin at 30
  EXPECT_EQ(check.by_month[1].low, 30.0);
}

TEST(RangeCheck, ValuesAtTheEdgeAreInside) {
  const auto outputs = measured({10, 40}, {5, 8});
  const auto n = normalise_design(design(), outputs, 2);
  const RangeCheck check = check_range(design(), outputs, *n);
  EXPECT_TRUE(check.extrapolation.empty());
  EXPECT_TRUE(check.by_month.empty());
}

}  // namespace
}  // namespace recald::calibration::normalisation_test
