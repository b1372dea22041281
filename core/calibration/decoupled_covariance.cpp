#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/calibration/cholesky.hpp"
#include "core/calibration/error_covariance.hpp"

namespace recald::calibration {
namespace {

/// Orthogonal (K x K): the first column is the mean over outputs, the others are Helmert's
/// contrasts.
Eigen::MatrixXd helmert(Eigen::Index outputs) {
  Eigen::MatrixXd turn = Eigen::MatrixXd::Zero(outputs, outputs);
  turn.col(0).setConstant(1.0 / std::sqrt(static_cast<double>(outputs)));
  for (Eigen::Index k = 1; k < outputs; ++k) {
    const auto before = static_cast<double>(k);
    const double length = std::sqrt(before * (before + 1.0));
    turn.col(k).head(k).setConstant(1.0 / length);
    turn(k, k) = -before / length;
  }
  return turn;
}

/// s R / lambda_delta + noise I, of n months.
struct Block {
  double share = 0.0;      ///< s
  double variance = 0.0;   ///< s / lambda_delta
  Eigen::Index first = 0;  ///< Columns of the turned residual that belong to it.
  Eigen::Index count = 0;
  Eigen::MatrixXd factor;   ///< L, lower triangle.
  Eigen::MatrixXd weights;  ///< W summed over its columns, lower triangle.
};

class DecoupledCovariance final : public ErrorCovariance {
 public:
  DecoupledCovariance(DiscrepancyKernel kernel, double extra_variance)
      : kernel_(std::move(kernel)),
        extra_variance_(extra_variance),
        months_(kernel_.month_count()),
        outputs_(kernel_.output_count()),
        turn_(helmert(outputs_)) {
    assert(kernel_.is_complete());
    blocks_[0].count = 1;
    blocks_[1].first = 1;
    blocks_[1].count = outputs_ - 1;
    for (Block& block : blocks_) {
      if (block.count == 0) continue;
      block.factor.setZero(months_, months_);
      block.weights.setZero(months_, months_);
    }
    scratch_.setZero(months_, months_);
    whitened_.setZero(months_, outputs_);
    weighted_.setZero(months_, outputs_);
    by_pair_.setZero(kernel_.distances().rows());
  }

  [[nodiscard]] std::unique_ptr<ErrorCovariance> clone() const override {
    return std::make_unique<DecoupledCovariance>(*this);
  }

  [[nodiscard]] bool factorise(const Hyperparameters& hyper, double jitter) override {
    kernel_.correlate_months(hyper.beta);
    error_variance_ = 1.0 / hyper.error_precision;
    between_outputs_ =
        kernel_.has_output_dimension() ? std::exp(-hyper.beta(kernel_.input_count())) : 1.0;
    blocks_[0].share = 1.0 + static_cast<double>(outputs_ - 1) * between_outputs_;
    blocks_[1].share = 1.0 - between_outputs_;
    const double noise = error_variance_ + extra_variance_ + jitter;
    for (Block& block : blocks_) {
      if (block.count == 0) continue;
      block.variance = block.share / hyper.discrepancy_precision;
      const double* packed = kernel_.month_correlations().data();
      for (Eigen::Index j = 0; j < months_; ++j) {
        double* column = block.factor.col(j).data();
        column[j] = block.variance + noise;
        for (Eigen::Index i = j + 1; i < months_; ++i) column[i] = block.variance * *packed++;
      }
      if (!factorise_in_place(block.factor)) return false;
    }
    return true;
  }

  [[nodiscard]] double log_determinant() const override {
    double sum = 0.0;
    for (const Block& block : blocks_) {
      if (block.count == 0) continue;
      sum += static_cast<double>(block.count) * log_determinant_of_factor(block.factor);
    }
    return sum;
  }

  [[nodiscard]] double squared_norm(const Eigen::VectorXd& residual) override {
    const Eigen::Map<const Eigen::MatrixXd> by_output(residual.data(), months_, outputs_);
    whitened_.noalias() = by_output.lazyProduct(turn_);
    for (Block& block : blocks_) {
      for (Eigen::Index k = block.first; k < block.first + block.count; ++k) {
        auto column = whitened_.col(k);
        block.factor.triangularView<Eigen::Lower>().solveInPlace(column);
      }
    }
    return whitened_.squaredNorm();
  }

  void precision(Eigen::MatrixXd& inverse) override {
    inverse.setZero();
    for (Block& block : blocks_) {
      if (block.count == 0) continue;
      invert_factor(block.factor, scratch_, block.weights);
      const Eigen::MatrixXd months = block.weights.selfadjointView<Eigen::Lower>();
      const auto columns = turn_.middleCols(block.first, block.count);
      const Eigen::MatrixXd between = columns * columns.transpose();
      for (Eigen::Index a = 0; a < outputs_; ++a) {
        for (Eigen::Index b = 0; b < outputs_; ++b) {
          inverse.block(a * months_, b * months_, months_, months_) += between(a, b) * months;
        }
      }
    }
  }

  double squared_norm_and_gradient(const Eigen::VectorXd& residual,
                                   LikelihoodGradient& gradient) override {
    const double norm = squared_norm(residual);
    double trace = 0.0;
    by_pair_.setZero();
    std::array<double, 2> products{};  // sum_ij W_ij R_ij / 2 of each block
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (blocks_[b].count == 0) continue;
      weigh(blocks_[b]);
      products[b] = add_products(blocks_[b]);
      trace += blocks_[b].weights.diagonal().sum();
    }
    Eigen::Map<Eigen::MatrixXd>(gradient.weighted_residual.data(), months_, outputs_).noalias() =
        weighted_.lazyProduct(turn_.transpose());
    gradient.log_discrepancy_precision =
        blocks_[0].variance * products[0] + blocks_[1].variance * products[1];
    gradient.log_error_precision = 0.5 * error_variance_ * trace;
    gradient.beta.head(kernel_.input_count()).noalias() =
        kernel_.distances().transpose() * by_pair_;
    if (kernel_.has_output_dimension()) {
      // ds/dbeta_out is -(K - 1) c for the mean and +c for the contrasts.
      const double variance = blocks_[0].variance / blocks_[0].share;
      const double others = static_cast<double>(outputs_ - 1);
      gradient.beta(kernel_.input_count()) =
          between_outputs_ * variance * (others * products[0] - products[1]);
    }
    return norm;
  }

 private:
  /// W of a block, and Sigma^-1 r in its columns.
  void weigh(Block& block) {
    invert_factor(block.factor, scratch_, block.weights);
    if (block.count > 1) block.weights *= static_cast<double>(block.count);
    for (Eigen::Index k = block.first; k < block.first + block.count; ++k) {
      auto alpha = weighted_.col(k);
      alpha = whitened_.col(k);
      block.factor.triangularView<Eigen::Lower>().transpose().solveInPlace(alpha);
      for (Eigen::Index j = 0; j < months_; ++j) {
        block.weights.col(j).tail(months_ - j) -= alpha(j) * alpha.tail(months_ - j);
      }
    }
  }

  /// Adds W_ij R_ij times the block's variance to the pairs; @return sum_ij W_ij R_ij / 2.
  double add_products(const Block& block) {
    const double* correlation = kernel_.month_correlations().data();
    double* by_pair = by_pair_.data();
    double below = 0.0;
    for (Eigen::Index j = 0; j < months_; ++j) {
      const double* weights = block.weights.col(j).data();
      for (Eigen::Index i = j + 1; i < months_; ++i) {
        const double product = weights[i] * *correlation++;
        below += product;
        *by_pair++ += block.variance * product;
      }
    }
    return below + 0.5 * block.weights.diagonal().sum();
  }

  DiscrepancyKernel kernel_;
  double extra_variance_;
  Eigen::Index months_;
  Eigen::Index outputs_;
  Eigen::MatrixXd turn_;
  std::array<Block, 2> blocks_;  ///< Mean of the outputs, contrasts.
  double error_variance_ = 0.0;
  double between_outputs_ = 1.0;  ///< c
  Eigen::MatrixXd scratch_;
  Eigen::MatrixXd whitened_;  ///< (months x outputs) turned, then L^-1 of it.
  Eigen::MatrixXd weighted_;  ///< (months x outputs) turned Sigma^-1 r.
  Eigen::VectorXd by_pair_;
};

}  // namespace

std::unique_ptr<ErrorCovariance> make_decoupled_covariance(DiscrepancyKernel kernel,
                                                           double extra_variance) {
  return std::make_unique<DecoupledCovariance>(std::move(kernel), extra_variance);
}

}  // namespace recald::calibration
