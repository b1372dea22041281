/// Sums of products from which least squares, stepwise selection and the lasso start.
#pragma once

#include <Eigen/Core>

namespace recald::regression {

/// All that a regression of m responses on p columns needs to know of its n rows.
///
/// Sums over disjoint rows add up, so leaving rows out is a subtraction and never a new pass over
/// the rows.
struct CrossProducts {
  double rows = 0.0;      ///< n; a double because everything is divided by it.
  Eigen::VectorXd x_sum;  ///< (p)
  Eigen::VectorXd y_sum;  ///< (m)
  Eigen::MatrixXd xx;     ///< (p x p) X'X, both triangles.
  Eigen::MatrixXd xy;     ///< (p x m) X'Y
  Eigen::VectorXd yy;     ///< (m) diagonal of Y'Y

  CrossProducts& operator+=(const CrossProducts& other);
  CrossProducts& operator-=(const CrossProducts& other);
};

/// The same about the column means: what is left once an intercept has been fitted.
struct CentredProducts {
  double rows;
  Eigen::VectorXd x_mean;
  Eigen::VectorXd y_mean;
  Eigen::MatrixXd xx;
  Eigen::MatrixXd xy;
  Eigen::VectorXd yy;
};

/// @param x  (n x p). Columns whose mean is far larger than their spread lose digits when `centre`
///           subtracts: scale to [0, 1] or centre them first.
/// @param y  (n x m)
/// @note  n p^2 / 2 multiplications: for a few responses nearly all there is to pay.
[[nodiscard]] CrossProducts cross_products(const Eigen::Ref<const Eigen::MatrixXd>& x,
                                           const Eigen::Ref<const Eigen::MatrixXd>& y);

/// @pre rows > 0
[[nodiscard]] CentredProducts centre(const CrossProducts& products);

}  // namespace recald::regression
