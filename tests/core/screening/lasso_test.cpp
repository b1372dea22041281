#include "core/screening/lasso.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random/rng.hpp"
#include "core/screening/cross_validation.hpp"
#include "core/screening/stability.hpp"
#include "tests/core/regression/golden_case.hpp"

namespace recald::screening {
namespace {

using regression::centre;
using regression::cross_products;

Eigen::MatrixXd random_matrix(Rng& rng, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd matrix(rows, columns);
  for (double& x : matrix.reshaped()) x = rng.uniform();
  return matrix;
}

/// Correlated columns of any mean and scale; responses of some of them and noise.
struct Problem {
  Eigen::MatrixXd x;
  Eigen::MatrixXd y;
};

Problem random_problem(std::uint64_t seed, Eigen::Index rows, Eigen::Index columns,
                       Eigen::Index responses) {
  Rng rng(seed);
  Problem problem{random_matrix(rng, rows, columns), {}};
  for (Eigen::Index j = 1; j < columns; j += 2) {
    problem.x.col(j) = 0.8 * problem.x.col(j - 1) + 0.2 * problem.x.col(j);
  }
  Eigen::MatrixXd slopes = random_matrix(rng, columns, responses);
  slopes.array() -= 0.5;
  problem.y = problem.x * slopes + 0.3 * random_matrix(rng, rows, responses);
  return problem;
}

/// Columns as the lasso sees them.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd z = x.rowwise() - x.colwise().mean();
  for (Eigen::Index j = 0; j < z.cols(); ++j) {
    z.col(j) /= z.col(j).norm() / std::sqrt(static_cast<double>(x.rows()));
  }
  return z;
}

// An optimum is recognised by its subgradient, so no second solver is needed: the residual
// covariance of a kept column is the penalty along its coefficients, that of a dropped column is
// not longer than the penalty. Computed from the rows.
TEST(Lasso, MeetsOptimalityConditionsOnRandomProblems) {
  for (const Eigen::Index responses : {1, 3}) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(seed);
      const Problem problem = random_problem(seed, 60, 9, responses);
      const StandardisedProducts products(centre(cross_products(problem.x, problem.y)));
      const double penalty =
          products.largest_penalty() * std::pow(0.5, static_cast<double>(1 + seed % 6));
      const auto fit = fit_lasso(products, penalty);
      ASSERT_TRUE(fit.has_value()) << fit.error().message;

      const Eigen::MatrixXd z = standardised(problem.x);
      const Eigen::MatrixXd y = problem.y.rowwise() - problem.y.colwise().mean();
      const Eigen::MatrixXd gradient = z.transpose() * (y - z * fit->coefficients) / 60.0;
      for (Eigen::Index j = 0; j < 9; ++j) {
        const auto b = fit->coefficients.row(j);
        if (fit->selects(j)) {
          EXPECT_LT((gradient.row(j) - penalty * b / b.norm()).norm(), 1e-8) << "column " << j;
        } else {
          EXPECT_LE(gradient.row(j).norm(), penalty + 1e-8) << "column " << j;
        }
      }
    }
  }
}

TEST(Lasso, IsSoftThresholdingWhereColumnsAreOrthogonal) {
  Rng rng(1);
  Eigen::MatrixXd raw(50, 6);
  raw << Eigen::VectorXd::Ones(50), random_matrix(rng, 50, 5);
  const Eigen::MatrixXd q = raw.householderQr().householderQ() * Eigen::MatrixXd::Identity(50, 6);
  const Eigen::MatrixXd x = std::sqrt(50.0) * q.rightCols(5);
  const Eigen::VectorXd y =
      x * Eigen::VectorXd::LinSpaced(5, -1.0, 1.0) + random_matrix(rng, 50, 1);
  const StandardisedProducts products(centre(cross_products(x, y)));
  const Eigen::VectorXd least_squares = x.transpose() * y / 50.0;
  const auto path = lasso_path(products, penalty_grid(products));
  ASSERT_TRUE(path.has_value()) << path.error().message;
  for (Eigen::Index i = 0; i < path->penalties.size(); ++i) {
    for (Eigen::Index j = 0; j < 5; ++j) {
      const double length = std::max(std::abs(least_squares(j)) - path->penalties(i), 0.0);
      EXPECT_NEAR(path->fits[static_cast<std::size_t>(i)].coefficients(j, 0),
                  std::copysign(length, least_squares(j)), 1e-12);
    }
  }
}

// glmnet 4.1-6 in R 4.2.2 on the data of golden_case.hpp, columns a, b, c, a:b, a:c, b:c:
//   m <- glmnet(X, y, lambda = l, thresh = 1e-22, maxit = 1e7)
//   m$beta * sqrt(colMeans(sweep(X, 2, colMeans(X))^2))
TEST(Lasso, AgreesWithGlmnet) {
  const auto terms = regression::all_terms(3, false);
  const Eigen::MatrixXd x = regression::columns_of(regression::golden_variables(), terms);
  const StandardisedProducts products(centre(cross_products(x, regression::golden_response())));
  const Eigen::VectorXd penalties = Eigen::Vector3d(0.2, 0.05, 0.01);
  Eigen::MatrixXd expected(6, 3);
  expected << 0.575262205534, 0.6855262462416, 0.62859995165545,  //
      0.0, -0.0350802218650, -0.23687660174111,                   //
      0.0, 0.0129421563136, 0.10768422119917,                     //
      0.0, 0.0, 0.24319183328583,                                 //
      0.0, 0.0681644003494, 0.00523929283073,                     //
      0.0, 0.0, 0.0;
  const auto path = lasso_path(products, penalties);
  ASSERT_TRUE(path.has_value()) << path.error().message;
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_LT((path->fits[static_cast<std::size_t>(i)].coefficients - expected.col(i))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9);
  }
}

// The same with a second response y2 <- -a + b + 0.2*cos(3.7*i):
//   glmnet(X, cbind(y, y2), family = "mgaussian", lambda = 0.1, standardize.response = FALSE)
TEST(Lasso, AgreesWithGlmnetOnSeveralResponses) {
  const auto terms = regression::all_terms(3, false);
  const Eigen::MatrixXd variables = regression::golden_variables();
  Eigen::MatrixXd y(40, 2);
  y.col(0) = regression::golden_response();
  for (int i = 0; i < 40; ++i)
    y(i, 1) = variables(i, 1) - variables(i, 0) + 0.2 * std::cos(3.7 * i);
  const StandardisedProducts products(
      centre(cross_products(regression::columns_of(variables, terms), y)));
  const auto fit = fit_lasso(products, 0.1, {.tolerance = 1e-12});
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 2);
  expected.row(0) << 0.6570588678110, -0.2257699336069;
  expected.row(1) << -0.0551435200258, 0.1910252197675;
  expected.row(4) << 0.0476241040770, -0.0122526994931;
  EXPECT_LT((fit->coefficients - expected).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Lasso, NothingIsSelectedAtTheLargestPenaltyAndSomethingBelow) {
  const Problem problem = random_problem(3, 60, 9, 2);
  const StandardisedProducts products(centre(cross_products(problem.x, problem.y)));
  const double largest = products.largest_penalty();
  const auto selected_at = [&](double penalty) {
    const auto fit = fit_lasso(products, penalty);
    return (fit->coefficients.array() != 0.0).rowwise().any().count();
  };
  EXPECT_EQ(selected_at(largest), 0);
  EXPECT_EQ(selected_at(0.999 * largest), 1);
}

TEST(Lasso, NeverSelectsAColumnWithoutSpread) {
  Problem problem = random_problem(4, 60, 5, 1);
  problem.x.col(2).setConstant(3.7);
  const StandardisedProducts products(centre(cross_products(problem.x, problem.y)));
  const auto path = lasso_path(products, penalty_grid(products));
  for (const LassoFit& fit : path->fits) EXPECT_FALSE(fit.selects(2));
}

TEST(Lasso, TwinColumnsStillHaveAMinimum) {
  Problem problem = random_problem(5, 60, 5, 1);
  problem.x.col(3) = problem.x.col(2);
  const StandardisedProducts products(centre(cross_products(problem.x, problem.y)));
  const auto fit = fit_lasso(products, 0.05 * products.largest_penalty());
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
}

TEST(Lasso, SaysWhenItDoesNotSettle) {
  const Problem problem = random_problem(6, 60, 9, 3);
  const StandardisedProducts products(centre(cross_products(problem.x, problem.y)));
  const auto fit = fit_lasso(products, 0.001 * products.largest_penalty(), {.sweeps_max = 2});
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::invalid_value);
  EXPECT_THAT(fit.error().message, ::testing::HasSubstr("did not converge within 2 passes"));
}

/// Rows of `runs` runs, `rows_per_run` each, run by run.
std::vector<int> run_of_rows(int runs, int rows_per_run) {
  std::vector<int> run;
  for (int r = 0; r < runs; ++r) run.insert(run.end(), static_cast<std::size_t>(rows_per_run), r);
  return run;
}

// The errors come from sums; here every fold is left out and predicted row by row.
TEST(LassoCrossValidation, HasTheErrorsOfTheRowsLeftOut) {
  const Problem problem = random_problem(7, 80, 6, 2);
  const std::vector<int> run = run_of_rows(20, 4);
  Rng rng(1);
  const regression::RunFolds folds(20, 5, rng);
  const auto validation =
      cross_validate_lasso(fold_products(problem.x, problem.y, run, folds), {.penalties = 6});
  ASSERT_TRUE(validation.has_value()) << validation.error().message;

  for (Eigen::Index i = 0; i < 6; ++i) {
    Eigen::VectorXd fold_error(5);
    for (int f = 0; f < 5; ++f) {
      std::vector<int> in;
      std::vector<int> out;
      for (int row = 0; row < 80; ++row) {
        const auto left = folds.left_out(f);
        const bool is_out =
            std::find(left.begin(), left.end(), run[static_cast<std::size_t>(row)]) != left.end();
        (is_out ? out : in).push_back(row);
      }
      ASSERT_EQ(out.size(), 16U);
      const StandardisedProducts training(
          centre(cross_products(problem.x(in, Eigen::all), problem.y(in, Eigen::all))));
      const auto fit = fit_lasso(training, validation->path.penalties(i));
      const Eigen::MatrixXd b = training.x_sd.cwiseInverse().asDiagonal() * fit->coefficients;
      const Eigen::MatrixXd predicted =
          ((problem.x(out, Eigen::all).rowwise() - training.x_mean.transpose()) * b).rowwise() +
          training.y_mean.transpose();
      fold_error(f) = (problem.y(out, Eigen::all) - predicted).squaredNorm() / 16.0;
    }
    EXPECT_NEAR(validation->error(i), fold_error.mean(), 1e-9);
    const double spread = (fold_error.array() - fold_error.mean()).square().mean();
    EXPECT_NEAR(validation->standard_error(i), std::sqrt(spread / 4.0), 1e-9);
  }
}

TEST(LassoCrossValidation, ChoosesWithinOneStandardError) {
  const Problem problem = random_problem(8, 200, 12, 1);
  Rng rng(2);
  const regression::RunFolds folds(200, 10, rng);
  const auto v =
      cross_validate_lasso(fold_products(problem.x, problem.y, run_of_rows(200, 1), folds));
  ASSERT_TRUE(v.has_value()) << v.error().message;
  const double limit = v->error(v->best) + v->standard_error(v->best);
  EXPECT_LE(v->chosen, v->best);
  EXPECT_LE(v->error(v->chosen), limit);
  ASSERT_GT(v->chosen, 0);
  EXPECT_GT(v->error(v->chosen - 1), limit);
}

TEST(LassoCrossValidation, RefusesMissingValuesAndFlatOutputs) {
  Problem problem = random_problem(9, 40, 3, 1);
  Rng rng(3);
  const regression::RunFolds folds(40, 5, rng);
  const std::vector<int> run = run_of_rows(40, 1);
  const Eigen::MatrixXd flat = Eigen::MatrixXd::Zero(40, 1);
  const auto nothing = cross_validate_lasso(fold_products(problem.x, flat, run, folds));
  ASSERT_FALSE(nothing.has_value());
  EXPECT_EQ(nothing.error().message,
            "the outputs do not change with any parameter; there is nothing to select");
  problem.y(7, 0) = std::numeric_limits<double>::quiet_NaN();
  const auto missing = cross_validate_lasso(fold_products(problem.x, problem.y, run, folds));
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::not_finite);
}

TEST(Stability, IsSureOfStrongColumnsAndNotOfIdleOnes) {
  Rng rng(4);
  const Eigen::MatrixXd x = random_matrix(rng, 100, 8);
  const Eigen::VectorXd y = x.col(2) - x.col(5) + 0.1 * random_matrix(rng, 100, 1);
  const auto selected = select_on_halves(x, y, 0.05, rng, {.half_samples = 49});
  ASSERT_TRUE(selected.has_value()) << selected.error().message;
  EXPECT_EQ(selected->rows(), 50);
  const Eigen::RowVectorXd frequency = selected->colwise().mean();
  EXPECT_EQ(frequency(2), 1.0);
  EXPECT_EQ(frequency(5), 1.0);
  EXPECT_LT(frequency(0), 0.6);
}

// Column 1 differs from zero in one run only: of two complementary halves exactly one holds it.
TEST(Stability, HalvesAreComplementary) {
  Rng rng(5);
  Eigen::MatrixXd x = random_matrix(rng, 20, 2);
  x.col(1).setZero();
  x(7, 1) = 1.0;
  const auto selected = select_on_halves(x, x.rowwise().sum(), 0.01, rng);
  ASSERT_TRUE(selected.has_value()) << selected.error().message;
  EXPECT_EQ(selected->col(1).mean(), 0.5);
}

}  // namespace
}  // namespace recald::screening
