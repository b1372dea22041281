#include "core/regression/fit_quality.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::regression {
namespace {

TEST(CheckPredictions, TellsParametersFromMonths) {
  DesignData check;
  check.theta = Eigen::MatrixXd::Zero(3, 1);
  check.outputs = {"heat"};
  check.months = {"2021-01", "2021-07"};
  check.values = (Eigen::MatrixXd(3, 2) << 100, 10, 110, 11, 120, 12).finished();
  Eigen::MatrixXd predicted = check.values;
  predicted(0, 1) += 1.0;
  const auto outputs = check_predictions(check, predicted);
  ASSERT_EQ(outputs.size(), 1u);
  EXPECT_EQ(outputs[0].name, "heat");
  EXPECT_NEAR(outputs[0].cvrmse, std::sqrt(1.0 / 6.0) / 60.5, 1e-12);
  EXPECT_NEAR(outputs[0].r2_worst_month, 1.0 - 1.0 / 2.0, 1e-12);
  EXPECT_NEAR(outputs[0].r2_median_month, 0.75, 1e-12);
  EXPECT_EQ(outputs[0].worst_month, "2021-07");
  EXPECT_NEAR(outputs[0].error_of_worst, std::sqrt(1.0 / 3.0) / 11.0, 1e-12);
}

TEST(AssessFit, TellsTheErrorOfEachMonth) {
  DesignData design;
  design.theta = Eigen::MatrixXd::Zero(2, 1);
  design.outputs = {"heat"};
  design.months = {"2021-01", "2021-07"};
  design.values = (Eigen::MatrixXd(2, 2) << 100, 0, 200, 0).finished();
  const Eigen::MatrixXd exact = design.values / 200.0;  // on the output's scale
  Eigen::MatrixXd left_out = exact;
  left_out(0, 0) += 0.1;  // 20 of 200
  const auto quality = assess_fit(design, {{0.0, 200.0}}, exact, left_out);
  EXPECT_NEAR(quality.outputs[0].sigma_by_month(0), 20.0 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(quality.outputs[0].sigma_by_month(1), 0.0);
  EXPECT_NEAR(quality.outputs[0].sigma_r, 10.0, 1e-9);
}

}  // namespace
}  // namespace recald::regression
