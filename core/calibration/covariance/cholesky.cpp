#include "core/calibration/covariance/cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::calibration {
namespace {

/// Column j of L^-1 by forward substitution; `column` points at its first row.
/// @param reciprocals  Of the diagonal of L: a division takes longer than the rest of a step.
void invert_column(const Eigen::MatrixXd& factor, const double* reciprocals, Eigen::Index j,
                   double* column) {
  const Eigen::Index n = factor.rows();
  std::fill(column + j, column + n, 0.0);
  column[j] = 1.0;
  for (Eigen::Index k = j; k < n; ++k) {
    const double value = column[k] * reciprocals[k];
    column[k] = value;
    const double* of_factor = factor.col(k).data();
    for (Eigen::Index i = k + 1; i < n; ++i) column[i] -= value * of_factor[i];
  }
}

}  // namespace

bool factorise_in_place(Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(matrix);
  return in_place.info() == Eigen::Success;
}

double log_determinant_of_factor(const Eigen::MatrixXd& factor) {
  // A product of eight diagonal entries stays within the range of a double, so one log is enough.
  double sum = 0.0;
  double product = 1.0;
  for (Eigen::Index i = 0; i < factor.rows(); ++i) {
    product *= factor(i, i);
    if (i % 8 == 7) {
      sum += std::log(product);
      product = 1.0;
    }
  }
  return 2.0 * (sum + std::log(product));
}

void invert_factor(const Eigen::MatrixXd& factor, Eigen::MatrixXd& scratch,
                   Eigen::MatrixXd& inverse) {
  const Eigen::Index n = factor.rows();
  assert(scratch.rows() == n && scratch.cols() == n && inverse.rows() == n && inverse.cols() == n);
  // The first row of the inverse holds the reciprocals until it is written last.
  double* reciprocals = inverse.col(n - 1).data();
  for (Eigen::Index i = 0; i < n; ++i) reciprocals[i] = 1.0 / factor(i, i);
  for (Eigen::Index j = 0; j < n; ++j) {
    invert_column(factor, reciprocals, j, scratch.col(j).data());
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) {
      inverse(i, j) = Eigen::VectorXd::Map(&scratch(i, i), n - i)
                          .dot(Eigen::VectorXd::Map(&scratch(i, j), n - i));
    }
  }
}

}  // namespace recald::calibration
