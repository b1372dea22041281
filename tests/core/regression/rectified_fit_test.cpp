#include "core/regression/rectified_fit.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/random/rng.hpp"
#include "core/statistics/rectified_mean.hpp"

namespace recald::regression {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Case {
  MatrixXd columns;
  VectorXd z;
};

/// Half of the rows would need less than nothing.
Case make_case(int rows, std::uint64_t seed) {
  Rng rng{seed};
  Case made{MatrixXd(rows, 2), VectorXd(rows)};
  for (double& value : made.columns.reshaped()) value = rng.uniform();
  made.z = 10.0 * made.columns.col(0) - 8.0 * made.columns.col(1);
  made.z.array() -= 1.0;
  return made;
}

VectorXd bent(const VectorXd& z, double width) {
  return z.unaryExpr([=](double one) { return rectified_mean(one, width); });
}

TEST(RectifiedFit, FindsWhatIsBehindABend) {
  const Case made = make_case(60, 1);
  const RectifiedFit fit = fit_rectified(made.columns, bent(made.z, 2.0), 2.0);
  EXPECT_NEAR(fit.intercept, -1.0, 1e-4);
  EXPECT_NEAR(fit.coefficients(0), 10.0, 1e-4);
  EXPECT_NEAR(fit.coefficients(1), -8.0, 1e-4);
  EXPECT_TRUE(fit.predict(made.columns).isApprox(bent(made.z, 2.0), 1e-5));
}

TEST(RectifiedFit, ABendIsChosenWhereThereIsOne) {
  const Case made = make_case(60, 2);
  const RectifiedFit fit = choose_rectified(made.columns, bent(made.z, 1.5));
  EXPECT_GT(fit.width, 0.0);
  const Case other = make_case(200, 3);
  const VectorXd truth = bent(other.z, 1.5);
  const RectifiedFit straight = fit_rectified(made.columns, bent(made.z, 1.5), 0.0);
  EXPECT_LT((fit.predict(other.columns) - truth).norm(),
            0.3 * (straight.predict(other.columns) - truth).norm());
}

TEST(RectifiedFit, WhatIsStraightOrMayBeNegativeStaysStraight) {
  const Case made = make_case(60, 4);
  EXPECT_EQ(choose_rectified(made.columns, made.z).width, 0.0);
  Rng rng{5};
  VectorXd noisy = made.z.array() + 20.0;
  for (double& value : noisy) value += 0.1 * rng.normal();
  EXPECT_EQ(choose_rectified(made.columns, noisy).width, 0.0);
}

TEST(RectifiedFit, LeftOutSquaresAreThoseOfFitsWithoutTheRow) {
  const Case made = make_case(40, 6);
  Rng rng{7};
  VectorXd response = bent(made.z, 2.0);
  for (double& value : response) value += 0.05 * rng.uniform();
  double squares = 0.0;
  for (int out = 0; out < 40; ++out) {
    std::vector<int> kept;
    for (int row = 0; row < 40; ++row) {
      if (row != out) kept.push_back(row);
    }
    const RectifiedFit fit = fit_rectified(made.columns(kept, Eigen::all), response(kept), 2.0);
    const double error = response(out) - fit.predict(made.columns.row(out))(0);
    squares += error * error;
  }
  EXPECT_NEAR(fit_rectified(made.columns, response, 2.0).left_out_squares / squares, 1.0, 0.05);
}

}  // namespace
}  // namespace recald::regression
