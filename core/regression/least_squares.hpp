/// Ordinary least squares from sums of products.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/regression/cross_products.hpp"
#include "core/result.hpp"

namespace recald::regression {

struct LeastSquaresFit {
  Eigen::MatrixXd coefficients;      ///< (k x m)
  Eigen::VectorXd intercepts;        ///< (m)
  Eigen::VectorXd residual_squares;  ///< (m)
};

/// Fits the responses on some of the columns and an intercept.
///
/// @param columns  (k) of the products' p columns, all different; may be empty.
/// @return the fit, or not_positive_definite when the columns determine each other.
/// @note   O(k^3 / 6 + k^2 m).
[[nodiscard]] Result<LeastSquaresFit> fit_least_squares(const CentredProducts& products,
                                                        std::span<const int> columns);

}  // namespace recald::regression
