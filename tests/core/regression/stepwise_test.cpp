#include "core/regression/stepwise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <limits>

#include "core/random/rng.hpp"
#include "core/regression/least_squares.hpp"
#include "core/regression/sweep.hpp"
#include "tests/core/regression/golden_case.hpp"

namespace recald::regression {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Start = StepwiseOptions::Start;

Eigen::MatrixXd random_matrix(Rng& rng, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd matrix(rows, columns);
  for (double& x : matrix.reshaped()) x = rng.uniform();
  return matrix;
}

CentredProducts products_of(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
  return centre(cross_products(x, y));
}

/// Residual sum of squares from the rows, by QR.
double residual_squares(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                        const std::vector<int>& columns) {
  Eigen::MatrixXd design(x.rows(), static_cast<Eigen::Index>(columns.size()) + 1);
  design << Eigen::VectorXd::Ones(x.rows()), x(Eigen::all, columns);
  return (y - design * design.householderQr().solve(y)).squaredNorm();
}

bool respects_hierarchy(const std::vector<int>& model, std::span<const Parents> parents) {
  return std::all_of(model.begin(), model.end(), [&](int column) {
    const auto& needed = parents[static_cast<std::size_t>(column)];
    return std::all_of(needed.begin(), needed.end(), [&](int parent) {
      return parent < 0 || std::find(model.begin(), model.end(), parent) != model.end();
    });
  });
}

/// The same search the slow way: every neighbour is fitted from its rows.
std::vector<int> brute_force(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                             std::span<const Parents> parents, std::vector<int> model,
                             Criterion criterion) {
  const auto rows = static_cast<double>(x.rows());
  const auto value = [&](const std::vector<int>& columns) {
    return information_criterion(criterion, residual_squares(x, y, columns), rows, 1.0,
                                 static_cast<int>(columns.size()));
  };
  for (;;) {
    double best = value(model) - 1e-7;
    std::vector<int> next = model;
    for (int j = 0; j < x.cols(); ++j) {
      std::vector<int> neighbour = model;
      const auto found = std::find(neighbour.begin(), neighbour.end(), j);
      if (found == neighbour.end()) {
        neighbour.push_back(j);
      } else {
        neighbour.erase(found);
      }
      if (!respects_hierarchy(neighbour, parents) || value(neighbour) >= best) continue;
      best = value(neighbour);
      next = neighbour;
    }
    if (next == model) break;
    model = next;
  }
  std::sort(model.begin(), model.end());
  return model;
}

// Computed by R 4.2.2 (2022-11-10 r83330) on the data of golden_case.hpp:
//   step(lm(y ~ .^2, d), direction = "both"); with k = log(40) for BIC. R prints 12-15 digits.
TEST(Stepwise, AgreesWithR) {
  const auto terms = all_terms(3, false);
  const auto parents = parents_of(terms);
  const auto products = products_of(columns_of(golden_variables(), terms), golden_response());

  const auto aic = stepwise(products, parents, {});
  ASSERT_TRUE(aic.has_value()) << aic.error().message;
  EXPECT_THAT(aic->columns, ElementsAre(0, 1, 2, 3, 5));  // a, b, c, a:b, b:c
  EXPECT_NEAR(aic->criterion, -188.376432671664, 1e-9);
  EXPECT_NEAR(aic->intercepts(0), 1.105505495451, 1e-10);
  EXPECT_NEAR(aic->coefficients(0, 0), 2.034723696957, 1e-10);
  EXPECT_NEAR(aic->coefficients(3, 0), 1.441119149187, 1e-10);
  EXPECT_NEAR(aic->coefficients(4, 0), 0.259814168825, 1e-10);

  const auto forward = stepwise(products, parents, {.start = Start::empty});
  EXPECT_THAT(forward->columns, ElementsAre(0, 1, 2, 3, 5));
  EXPECT_EQ(forward->steps, 5);

  const auto bic = stepwise(products, parents, {.criterion = Criterion::bic});
  EXPECT_THAT(bic->columns, ElementsAre(0, 1, 2, 3));
  EXPECT_NEAR(bic->criterion, -179.248487983049, 1e-9);
}

// n = 10, RSS = 4, two terms: 10 ln 0.4 = -9.162907; + 2 * 3; + 8 for K = 4 in AICc; + 3 ln 10.
TEST(Stepwise, CriteriaByHand) {
  EXPECT_NEAR(information_criterion(Criterion::aic, 4.0, 10.0, 1.0, 2), -3.162907, 1e-6);
  EXPECT_NEAR(information_criterion(Criterion::aic_corrected, 4.0, 10.0, 1.0, 2), 4.837093, 1e-6);
  EXPECT_NEAR(information_criterion(Criterion::bic, 4.0, 10.0, 1.0, 2), -2.255152, 1e-6);
  // Three responses of that kind, summed.
  EXPECT_NEAR(information_criterion(Criterion::aic, 12.0, 10.0, 3.0, 2), 3.0 * -3.162907, 1e-5);
}

TEST(Stepwise, FindsWhatRefittingFromRowsFinds) {
  const auto terms = all_terms(4, true);
  const auto parents = parents_of(terms);
  std::vector<int> full(terms.size());
  for (std::size_t j = 0; j < full.size(); ++j) full[j] = static_cast<int>(j);
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const Eigen::MatrixXd x = columns_of(random_matrix(rng, 40, 4), terms);
    Eigen::VectorXd y = x * random_matrix(rng, x.cols(), 1);
    for (double& value : y) value += 0.3 * rng.normal();
    for (const Criterion criterion : {Criterion::aic, Criterion::aic_corrected, Criterion::bic}) {
      const auto backward = stepwise(products_of(x, y), parents, {.criterion = criterion});
      EXPECT_EQ(backward->columns, brute_force(x, y, parents, full, criterion));
      EXPECT_NEAR(backward->residual_squares(0), residual_squares(x, y, backward->columns), 1e-9);
      const auto forward =
          stepwise(products_of(x, y), parents, {.criterion = criterion, .start = Start::empty});
      EXPECT_EQ(forward->columns, brute_force(x, y, parents, {}, criterion));
    }
  }
}

// Orthogonal columns without hierarchy: each column's gain is its own, so the steps end at the best
// of all 2^p models.
TEST(Stepwise, IsTheBestOfAllModelsWhereColumnsAreOrthogonal) {
  Rng rng(3);
  Eigen::MatrixXd raw(30, 9);
  raw << Eigen::VectorXd::Ones(30), random_matrix(rng, 30, 8);
  const Eigen::MatrixXd q = raw.householderQr().householderQ() * Eigen::MatrixXd::Identity(30, 9);
  const Eigen::MatrixXd x = q.rightCols(8);
  Eigen::VectorXd y = x * Eigen::VectorXd::LinSpaced(8, 0.0, 1.0);
  for (double& value : y) value += 0.3 * rng.normal();
  const std::vector<Parents> parents(8, Parents{-1, -1});

  double best = std::numeric_limits<double>::infinity();
  std::vector<int> best_model;
  for (unsigned mask = 0; mask < 256; ++mask) {
    std::vector<int> model;
    for (int j = 0; j < 8; ++j) {
      if ((mask >> j & 1U) != 0U) model.push_back(j);
    }
    const double value = information_criterion(Criterion::aic, residual_squares(x, y, model), 30.0,
                                               1.0, static_cast<int>(model.size()));
    if (value < best) {
      best = value;
      best_model = model;
    }
  }
  for (const Start start : {Start::full, Start::empty}) {
    const auto fit = stepwise(products_of(x, y), parents, {.start = start});
    EXPECT_EQ(fit->columns, best_model);
    EXPECT_NEAR(fit->criterion, best, 1e-9);
  }
}

TEST(Stepwise, ReportsAColumnThatOthersDetermine) {
  Rng rng(4);
  Eigen::MatrixXd x = random_matrix(rng, 30, 4);
  x.col(2) = 2.0 * x.col(0) - x.col(1);
  const Eigen::VectorXd y = x.col(0) + x.col(3) + 0.1 * random_matrix(rng, 30, 1);
  const std::vector<Parents> parents(4, Parents{-1, -1});
  const auto fit = stepwise(products_of(x, y), parents, {});
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_THAT(fit->aliased, ElementsAre(2));
  const auto forward = stepwise(products_of(x, y), parents, {.start = Start::empty});
  ASSERT_TRUE(forward.has_value()) << forward.error().message;
  EXPECT_LE(forward->columns.size(), 3U);
}

TEST(Stepwise, SharesTermsAmongResponses) {
  Rng rng(5);
  const Eigen::MatrixXd x = random_matrix(rng, 60, 6);
  Eigen::MatrixXd y(60, 3);
  y << x.col(1) + x.col(4), x.col(4) - x.col(1), 2.0 * x.col(1);
  y += 0.05 * random_matrix(rng, 60, 3);
  const std::vector<Parents> parents(6, Parents{-1, -1});
  const auto fit =
      stepwise(products_of(x, y), parents, {.criterion = Criterion::bic, .start = Start::empty});
  EXPECT_THAT(fit->columns, ElementsAre(1, 4));
  EXPECT_NEAR(fit->coefficients(0, 2), 2.0, 0.05);
  EXPECT_NEAR(fit->coefficients(0, 1), -1.0, 0.05);
}

TEST(Stepwise, MoreTermsThanRowsNeedAnEmptyStart) {
  Rng rng(6);
  const Eigen::MatrixXd x = random_matrix(rng, 12, 20);
  const Eigen::VectorXd y = 3.0 * x.col(7) + 0.1 * random_matrix(rng, 12, 1);
  const std::vector<Parents> parents(20, Parents{-1, -1});
  const auto full = stepwise(products_of(x, y), parents, {});
  ASSERT_FALSE(full.has_value());
  EXPECT_EQ(full.error().code, ErrorCode::not_enough_data);
  EXPECT_EQ(full.error().message,
            "a regression that starts with 20 terms needs at least 22 rows, but there are 12; "
            "start from the empty model or add runs");
  const auto fit = stepwise(products_of(x, y), parents,
                            {.criterion = Criterion::aic_corrected, .start = Start::empty});
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_THAT(fit->columns, ::testing::Contains(7));
  EXPECT_LE(fit->columns.size(), 9U);
}

TEST(Stepwise, ExactAndConstantResponsesEnd) {
  Rng rng(7);
  const Eigen::MatrixXd x = random_matrix(rng, 30, 5);
  const std::vector<Parents> parents(5, Parents{-1, -1});
  const auto exact = stepwise(products_of(x, x.col(3)), parents, {.start = Start::empty});
  EXPECT_THAT(exact->columns, ElementsAre(3));
  const auto constant = stepwise(products_of(x, Eigen::VectorXd::Constant(30, 0.7)), parents, {});
  ASSERT_TRUE(constant.has_value());
  EXPECT_TRUE(constant->columns.empty());
  EXPECT_DOUBLE_EQ(constant->intercepts(0), 0.7);
}

TEST(Stepwise, RefusesMissingValues) {
  Eigen::MatrixXd x = golden_variables();
  x(3, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto fit =
      stepwise(products_of(x, golden_response()), std::vector<Parents>(3, Parents{-1, -1}), {});
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::not_finite);
  EXPECT_THAT(fit.error().message, HasSubstr("missing or infinite"));
}

TEST(LeastSquares, RefusesColumnsThatDetermineEachOther) {
  Eigen::MatrixXd x(40, 4);
  x << golden_variables(), golden_variables().col(0) + golden_variables().col(1);
  const auto products = products_of(x, golden_response());
  const std::vector<int> good{0, 1, 2};
  EXPECT_TRUE(fit_least_squares(products, good).has_value());
  const std::vector<int> twin{0, 1, 1};
  const auto fit = fit_least_squares(products, twin);
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::not_positive_definite);
  EXPECT_EQ(fit.error().message,
            "the columns of the regression determine each other; leave one of them out");
  x.col(3).setConstant(0.5);
  const std::vector<int> flat{0, 3};
  EXPECT_FALSE(fit_least_squares(products_of(x, golden_response()), flat).has_value());
}

TEST(Sweep, OutUndoesIn) {
  Rng rng(8);
  const auto products = products_of(random_matrix(rng, 30, 6), random_matrix(rng, 30, 2));
  SweptProducts swept(products);
  const double before = swept.residual_squares_sum();
  const double share = swept.free_share(4);
  for (const int j : {1, 4, 0}) swept.toggle(j);
  const double change = swept.toggle_change(4);
  EXPECT_GT(change, 0.0);
  const double with_all = swept.residual_squares_sum();
  swept.toggle(4);
  EXPECT_NEAR(swept.residual_squares_sum(), with_all + change, 1e-12);
  swept.toggle(0);
  swept.toggle(1);
  EXPECT_NEAR(swept.residual_squares_sum(), before, 1e-12);
  EXPECT_NEAR(swept.free_share(4), share, 1e-12);
}

TEST(Terms, AreNamedAndOrderedAsR) {
  const std::vector<std::string> names{"a", "b", "c"};
  std::vector<std::string> text;
  for (const Term& term : all_terms(3, true)) text.push_back(term_name(term, names));
  EXPECT_THAT(text, ElementsAre("a", "b", "c", "a^2", "b^2", "c^2", "a:b", "a:c", "b:c"));
}

}  // namespace
}  // namespace recald::regression
