/// The sweep operator: adding a column to a regression, or taking it out, without solving again.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/regression/cross_products.hpp"

namespace recald::regression {

/// X'X and X'Y about the means with some columns swept, i.e. fitted by least squares.
///
/// With S the swept columns and U the others, the symmetric matrix A holds
///   A_SS = -(X_S'X_S)^-1,   A_SU = (X_S'X_S)^-1 X_S'X_U,   A_UU = residual products of X_U,
/// and B = A_.Y holds the coefficients of S and the residual products of U with Y. One sweep costs
/// p^2 / 2 + p m multiplications.
/// @see Dempster (1969), Elements of Continuous Multivariate Analysis, 4.3.2;
///      Goodnight (1979), The American Statistician 33(3).
class SweptProducts {
 public:
  explicit SweptProducts(const CentredProducts& products);

  [[nodiscard]] Eigen::Index columns() const { return a_.cols(); }
  [[nodiscard]] bool swept(Eigen::Index j) const { return swept_[static_cast<std::size_t>(j)]; }
  [[nodiscard]] int swept_count() const { return swept_count_; }
  /// (m) residual sum of squares of each response.
  [[nodiscard]] const Eigen::VectorXd& residual_squares() const { return residual_; }
  [[nodiscard]] double residual_squares_sum() const { return residual_.sum(); }

  /// Share of column j's sum of squares that the swept columns leave unexplained, 1 / VIF.
  /// @pre !swept(j)
  [[nodiscard]] double free_share(Eigen::Index j) const;

  /// Change of the residual sum of squares, summed over the responses, that `toggle(j)` makes:
  /// negative when j would come in, positive when it would go.
  [[nodiscard]] double toggle_change(Eigen::Index j) const {
    return -b_.row(j).squaredNorm() / a_(j, j);
  }

  /// Sweeps column j in, or out again. @pre a column that comes in has free_share > 0
  void toggle(Eigen::Index j);

 private:
  Eigen::MatrixXd a_;  ///< Lower triangle only.
  Eigen::MatrixXd b_;
  Eigen::VectorXd residual_;
  Eigen::VectorXd total_;  ///< (p) diagonal before any sweep.
  Eigen::VectorXd pivot_column_;
  Eigen::RowVectorXd pivot_response_;
  std::vector<bool> swept_;
  int swept_count_ = 0;
};

}  // namespace recald::regression
