#include <cassert>
#include <cmath>
#include <utility>

#include "core/calibration/covariance/cholesky.hpp"
#include "core/calibration/covariance/error_covariance.hpp"

namespace recald::calibration {
namespace {

class DenseCovariance final : public ErrorCovariance {
 public:
  DenseCovariance(DiscrepancyKernel kernel, Eigen::MatrixXd fixed)
      : kernel_(std::move(kernel)), fixed_(std::move(fixed)) {
    const Eigen::Index m = kernel_.point_count();
    assert(fixed_.rows() == m && fixed_.cols() == m);
    discrepancy_.setZero(m, m);
    factor_.setZero(m, m);
    scratch_.setZero(m, m);
    weights_.setZero(m, m);
    whitened_.setZero(m);
    by_pair_.setZero(kernel_.distances().rows());
  }

  [[nodiscard]] std::unique_ptr<ErrorCovariance> clone() const override {
    return std::make_unique<DenseCovariance>(*this);
  }

  [[nodiscard]] bool factorise(const Hyperparameters& hyper, double jitter) override {
    kernel_.covariance(1.0 / hyper.discrepancy_precision, hyper.beta, discrepancy_);
    error_variance_ = 1.0 / hyper.error_precision;
    cross_factor_ = kernel_.has_output_dimension();
    const Eigen::Index m = kernel_.point_count();
    for (Eigen::Index j = 0; j < m; ++j) {
      factor_.col(j).tail(m - j) = discrepancy_.col(j).tail(m - j) + fixed_.col(j).tail(m - j);
      factor_(j, j) += error_variance_ + jitter;
    }
    return factorise_in_place(factor_);
  }

  [[nodiscard]] double log_determinant() const override {
    return log_determinant_of_factor(factor_);
  }

  [[nodiscard]] double squared_norm(const Eigen::VectorXd& residual) override {
    whitened_ = residual;
    factor_.triangularView<Eigen::Lower>().solveInPlace(whitened_);
    return whitened_.squaredNorm();
  }

  void precision(Eigen::MatrixXd& inverse) override {
    invert_factor(factor_, scratch_, weights_);
    inverse = weights_.selfadjointView<Eigen::Lower>();
  }

  double squared_norm_and_gradient(const Eigen::VectorXd& residual,
                                   LikelihoodGradient& gradient) override {
    const double norm = squared_norm(residual);
    Eigen::VectorXd& alpha = gradient.weighted_residual;
    alpha = whitened_;
    factor_.triangularView<Eigen::Lower>().transpose().solveInPlace(alpha);

    invert_factor(factor_, scratch_, weights_);
    const Eigen::Index m = alpha.size();
    for (Eigen::Index j = 0; j < m; ++j) {
      weights_.col(j).tail(m - j) -= alpha(j) * alpha.tail(m - j);
    }
    const auto sums = kernel_.sum_products(weights_, discrepancy_, by_pair_);
    gradient.log_discrepancy_precision = sums.same_output + sums.cross_output;
    gradient.log_error_precision = 0.5 * error_variance_ * weights_.diagonal().sum();
    gradient.beta.head(kernel_.input_count()).noalias() =
        kernel_.distances().transpose() * by_pair_;
    if (cross_factor_) gradient.beta(kernel_.input_count()) = sums.cross_output;
    return norm;
  }

 private:
  DiscrepancyKernel kernel_;
  Eigen::MatrixXd fixed_;        ///< F, lower triangle.
  Eigen::MatrixXd discrepancy_;  ///< C, lower triangle.
  Eigen::MatrixXd factor_;       ///< L, lower triangle.
  Eigen::MatrixXd scratch_;
  Eigen::MatrixXd weights_;  ///< W, lower triangle.
  Eigen::VectorXd whitened_;
  Eigen::VectorXd by_pair_;
  double error_variance_ = 0.0;
  bool cross_factor_ = false;
};

}  // namespace

std::unique_ptr<ErrorCovariance> make_dense_covariance(DiscrepancyKernel kernel,
                                                       Eigen::MatrixXd fixed) {
  return std::make_unique<DenseCovariance>(std::move(kernel), std::move(fixed));
}

}  // namespace recald::calibration
