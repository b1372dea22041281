/// Lasso regression, used to choose which building parameters matter.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/regression/cross_products.hpp"
#include "core/result.hpp"

namespace recald::screening {

struct LassoOptions {
  int penalties = 100;           ///< Points of the path.
  double smallest_ratio = 1e-3;  ///< Last penalty of the path over the first.
  /// Stop when no coefficient moved more than this times the response's standard deviation.
  double tolerance = 1e-9;
  int sweeps_max = 100'000;  ///< Upper bound on passes over the columns, per penalty.
};

/// Columns scaled to mean 0 and variance 1 (divisor n), responses to mean 0.
struct StandardisedProducts {
  /// A column without spread becomes zero and is never selected.
  explicit StandardisedProducts(const regression::CentredProducts& products);

  Eigen::VectorXd x_mean;       ///< (p)
  Eigen::VectorXd x_sd;         ///< (p)
  Eigen::VectorXd y_mean;       ///< (m)
  Eigen::MatrixXd correlation;  ///< (p x p) X'X / n, diagonal 1.
  Eigen::MatrixXd covariance;   ///< (p x m) X'Y / n, in the responses' unit.
  double variance;              ///< Sum of the responses' variances.

  /// The smallest penalty at which nothing is selected.
  [[nodiscard]] double largest_penalty() const;
};

struct LassoFit {
  Eigen::MatrixXd coefficients;  ///< (p x m) of standardised columns; zero rows mark dropped ones.
  int sweeps;                    ///< Passes used, over all or the selected columns.

  [[nodiscard]] bool selects(Eigen::Index j) const { return !coefficients.row(j).isZero(0.0); }
};

struct LassoPath {
  Eigen::VectorXd penalties;  ///< Descending, equally spaced in their logarithm.
  std::vector<LassoFit> fits;
};

/// Minimises  |Y - X B|^2 / (2 n) + lambda sum_j |b_j|  over B (p x m) by cyclic coordinate
/// descent, b_j the row of column j and |.| its Euclidean length.
///
/// One response makes this the lasso, eq. (2) of the seed. Several responses, such as one output in
/// all months, select a column for all of them or for none, so that an effect which warms in winter
/// and cools in summer counts although it averages out.
///
/// With one response the descent only has to find which columns are in and their signs; then the
/// optimum is the solution of linear equations, taken when it has those signs.
///
/// @param penalty  lambda > 0, in the unit of the response.
/// @return the minimum, or invalid_value when sweeps_max is reached.
/// @note   O(p m) a coefficient that moves; the rows are never seen.
/// @see    Friedman, Hastie, Tibshirani (2010), J. Stat. Softw. 33(1), eq. (5) with alpha = 1 and
///         2.2 (covariance updates); Yuan, Lin (2006), J. R. Stat. Soc. B 68(1), eq. (2.4);
///         Obozinski, Taskar, Jordan (2010), Stat. Comput. 20, eq. (2).
[[nodiscard]] Result<LassoFit> fit_lasso(const StandardisedProducts& products, double penalty,
                                         const LassoOptions& options = {});

/// Fits at each of the penalties, descending, each from where the last one ended.
[[nodiscard]] Result<LassoPath> lasso_path(const StandardisedProducts& products,
                                           const Eigen::VectorXd& penalties,
                                           const LassoOptions& options = {});

/// From `largest_penalty` down to `smallest_ratio` of it.
[[nodiscard]] Eigen::VectorXd penalty_grid(const StandardisedProducts& products,
                                           const LassoOptions& options = {});

}  // namespace recald::screening
