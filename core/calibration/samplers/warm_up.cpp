#include "core/calibration/samplers/warm_up.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>

namespace recald::calibration {
namespace {

/// Covariance (d x d) of the columns, shrunk towards the unit matrix by the weight of one column.
Eigen::MatrixXd shrunk_covariance(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  constexpr double shrinkage = 1.0;
  const auto n = static_cast<double>(columns.cols());
  const Eigen::MatrixXd centred = columns.colwise() - columns.rowwise().mean();
  const Eigen::Index d = columns.rows();
  return (n / (n - 1.0) * centred * centred.transpose() +
          shrinkage * Eigen::MatrixXd::Identity(d, d)) /
         (n + shrinkage);
}

/// The symmetric positive definite A with A G A = C: G^-1/2 (G^1/2 C G^1/2)^1/2 G^-1/2.
Eigen::MatrixXd geometric_mean_with_inverse(const Eigen::MatrixXd& C, const Eigen::MatrixXd& G) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of_G(G);
  const Eigen::MatrixXd root = of_G.operatorSqrt();
  const Eigen::MatrixXd inverse_root = of_G.operatorInverseSqrt();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> middle(root * C * root);
  return inverse_root * middle.operatorSqrt() * inverse_root;
}

}  // namespace

std::vector<int> window_ends(int burn_in, bool has_metric) {
  if (burn_in < 20) return {};
  int start = 75;
  int window = 25;
  int end = 50;
  if (burn_in < start + window + end) {
    start = burn_in * 15 / 100;
    end = burn_in / 10;
    window = burn_in - start - end;
  }
  if (has_metric) start = std::min(start, 10);
  std::vector<int> ends{start};
  const int last = burn_in - end;
  while (ends.back() < last) {
    // The next window, twice as long, must fit too; otherwise this one takes the rest.
    const bool next_fits = ends.back() + 3 * window <= last;
    ends.push_back(next_fits ? ends.back() + window : last);
    window *= 2;
  }
  return ends;
}

MetricEstimator::MetricEstimator(Eigen::Index dimension, Eigen::Index capacity)
    : positions_(dimension, capacity), forces_(dimension, capacity) {}

void MetricEstimator::add(const Eigen::VectorXd& position, const Eigen::VectorXd& force) {
  assert(count_ < positions_.cols());
  positions_.col(count_) = position;
  forces_.col(count_) = force;
  ++count_;
}

Eigen::MatrixXd MetricEstimator::factor(const Eigen::MatrixXd& factor) const {
  if (count_ < 2) return factor;
  const auto L = factor.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd whitened = L.solve(positions_.leftCols(count_));
  const Eigen::MatrixXd metric = geometric_mean_with_inverse(
      shrunk_covariance(whitened), shrunk_covariance(forces_.leftCols(count_)));
  const Eigen::LLT<Eigen::MatrixXd> root(metric);
  if (root.info() != Eigen::Success || !metric.allFinite()) return factor;
  return L * Eigen::MatrixXd(root.matrixL());  // triangular: the product of two that are
}

}  // namespace recald::calibration
