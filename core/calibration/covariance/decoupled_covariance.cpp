#include <Eigen/Cholesky>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/calibration/covariance/cholesky.hpp"
#include "core/calibration/covariance/error_covariance.hpp"

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

/// s R / lambda_delta + diag(noise), for n months.
struct Block {
  double share = 0.0;      ///< s
  double variance = 0.0;   ///< s / lambda_delta
  Eigen::Index first = 0;  ///< Its columns of the rotated residual.
  Eigen::Index count = 0;
  Eigen::MatrixXd factor;   ///< L, lower triangle.
  Eigen::MatrixXd weights;  ///< W summed over its columns, lower triangle.
};

class DecoupledCovariance final : public ErrorCovariance {
 public:
  DecoupledCovariance(DiscrepancyKernel kernel, Eigen::VectorXd month_variances,
                      const Eigen::MatrixXd& common_errors)
      : kernel_(std::move(kernel)),
        month_variances_(std::move(month_variances)),
        months_(kernel_.month_count()),
        outputs_(kernel_.output_count()),
        turn_(helmert(outputs_)),
        turned_errors_(months_ * outputs_, common_errors.cols()) {
    assert(kernel_.is_complete() && month_variances_.size() == months_);
    assert(common_errors.cols() == 0 || common_errors.rows() == months_ * outputs_);
    for (Eigen::Index d = 0; d < common_errors.cols(); ++d) {
      by_output(turned_errors_, d) = by_output(common_errors, d) * turn_;
    }
    white_errors_.setZero(months_ * outputs_, common_errors.cols());
    error_weights_.setZero(months_ * outputs_, common_errors.cols());
    between_errors_.setZero(common_errors.cols(), common_errors.cols());
    error_factor_ = Eigen::LLT<Eigen::MatrixXd>(common_errors.cols());
    explained_.setZero(common_errors.cols());
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
    const double noise = error_variance_ + jitter;
    for (Block& block : blocks_) {
      if (block.count == 0) continue;
      block.variance = block.share / hyper.discrepancy_precision;
      const double* packed = kernel_.month_correlations().data();
      for (Eigen::Index j = 0; j < months_; ++j) {
        double* column = block.factor.col(j).data();
        column[j] = block.variance + noise + month_variances_(j);
        for (Eigen::Index i = j + 1; i < months_; ++i) column[i] = block.variance * *packed++;
      }
      if (!factorise_in_place(block.factor)) return false;
    }
    return factorise_errors();
  }

  [[nodiscard]] double log_determinant() const override {
    double sum = 0.0;
    for (const Block& block : blocks_) {
      if (block.count == 0) continue;
      sum += static_cast<double>(block.count) * log_determinant_of_factor(block.factor);
    }
    for (Eigen::Index d = 0; d < error_count(); ++d) {
      sum += 2.0 * std::log(error_factor_.matrixLLT()(d, d));
    }
    return sum;
  }

  [[nodiscard]] double squared_norm(const Eigen::VectorXd& residual) override {
    whitened_.noalias() = Shaped(residual.data(), months_, outputs_).lazyProduct(turn_);
    whiten(whitened_);
    const double norm = whitened_.squaredNorm();
    if (error_count() == 0) return norm;
    const Eigen::Map<const Eigen::VectorXd> white(whitened_.data(), whitened_.size());
    explained_.noalias() = white_errors_.transpose() * white;
    error_factor_.matrixL().solveInPlace(explained_);
    return norm - explained_.squaredNorm();
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
    weigh_errors();
    for (Eigen::Index d = 0; d < error_count(); ++d) {
      const Eigen::MatrixXd back = by_output(error_weights_, d) * turn_.transpose();
      const Eigen::Map<const Eigen::VectorXd> column(back.data(), back.size());
      inverse.noalias() -= column * column.transpose();
    }
  }

  double squared_norm_and_gradient(const Eigen::VectorXd& residual,
                                   LikelihoodGradient& gradient) override {
    const double norm = squared_norm(residual);
    weigh_errors();
    if (error_count() > 0) {  // Sigma^-1 r is B^-1 of the part not explained by common errors
      error_factor_.matrixU().solveInPlace(explained_);
      Eigen::Map<Eigen::VectorXd>(whitened_.data(), whitened_.size()).noalias() -=
          white_errors_ * explained_;
    }
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
  using Shaped = Eigen::Map<const Eigen::MatrixXd>;

  /// Column `d` as (months x outputs).
  [[nodiscard]] Shaped by_output(const Eigen::MatrixXd& columns, Eigen::Index d) const {
    return {columns.col(d).data(), months_, outputs_};
  }
  [[nodiscard]] Eigen::Map<Eigen::MatrixXd> by_output(Eigen::MatrixXd& columns,
                                                      Eigen::Index d) const {
    return {columns.col(d).data(), months_, outputs_};
  }
  [[nodiscard]] Eigen::Index error_count() const { return turned_errors_.cols(); }

  /// L^-1 of the rotated matrix, (months x outputs), in place.
  template <class Turned>
  void whiten(Turned& turned) const {
    for (const Block& block : blocks_) {
      for (Eigen::Index k = block.first; k < block.first + block.count; ++k) {
        auto column = turned.col(k);
        block.factor.template triangularView<Eigen::Lower>().solveInPlace(column);
      }
    }
  }

  /// L^-1 g, and the factor of I + g' B^-1 g.
  [[nodiscard]] bool factorise_errors() {
    if (error_count() == 0) return true;
    white_errors_ = turned_errors_;
    for (Eigen::Index d = 0; d < error_count(); ++d) {
      auto turned = by_output(white_errors_, d);
      whiten(turned);
    }
    between_errors_.noalias() = white_errors_.transpose() * white_errors_;
    between_errors_.diagonal().array() += 1.0;
    error_factor_.compute(between_errors_);
    return error_factor_.info() == Eigen::Success;
  }

  /// U with  Sigma^-1 = B^-1 - U U',  rotated.
  void weigh_errors() {
    if (error_count() == 0) return;
    // U' = K^-1 (L^-1 g)' L^-1, with K the factor above.
    error_weights_ = white_errors_;
    error_factor_.matrixU().solveInPlace<Eigen::OnTheRight>(error_weights_);
    for (Eigen::Index d = 0; d < error_count(); ++d) {
      auto turned = by_output(error_weights_, d);
      for (const Block& block : blocks_) {
        for (Eigen::Index k = block.first; k < block.first + block.count; ++k) {
          auto column = turned.col(k);
          block.factor.triangularView<Eigen::Lower>().transpose().solveInPlace(column);
        }
      }
    }
  }

  /// W of a block, and Sigma^-1 r in its columns.
  void weigh(Block& block) {
    invert_factor(block.factor, scratch_, block.weights);
    if (block.count > 1) block.weights *= static_cast<double>(block.count);
    for (Eigen::Index k = block.first; k < block.first + block.count; ++k) {
      auto alpha = weighted_.col(k);
      alpha = whitened_.col(k);
      block.factor.triangularView<Eigen::Lower>().transpose().solveInPlace(alpha);
      subtract_square(alpha, block.weights);
      for (Eigen::Index d = 0; d < error_count(); ++d) {
        subtract_square(by_output(error_weights_, d).col(k), block.weights);
      }
    }
  }

  /// v v' from the lower triangle.
  template <class Vector>
  void subtract_square(const Vector& v, Eigen::MatrixXd& weights) const {
    for (Eigen::Index j = 0; j < months_; ++j) {
      weights.col(j).tail(months_ - j) -= v(j) * v.tail(months_ - j);
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
  Eigen::VectorXd month_variances_;
  Eigen::Index months_;
  Eigen::Index outputs_;
  Eigen::MatrixXd turn_;
  std::array<Block, 2> blocks_;  ///< Mean of the outputs, contrasts.
  double error_variance_ = 0.0;
  double between_outputs_ = 1.0;  ///< c
  Eigen::MatrixXd scratch_;
  Eigen::MatrixXd whitened_;  ///< (months x outputs) rotated, then L^-1 of it.
  Eigen::MatrixXd weighted_;  ///< (months x outputs) rotated Sigma^-1 r.
  Eigen::VectorXd by_pair_;

  Eigen::MatrixXd turned_errors_;   ///< (m x d) g, rotated, by months and outputs; next two too.
  Eigen::MatrixXd white_errors_;    ///< L^-1 g
  Eigen::MatrixXd error_weights_;   ///< U
  Eigen::MatrixXd between_errors_;  ///< (d x d) I + g' B^-1 g
  Eigen::LLT<Eigen::MatrixXd> error_factor_;  ///< Of it.
  Eigen::VectorXd explained_;                 ///< (d) Of the last residual, by the common errors.
};

}  // namespace

std::unique_ptr<ErrorCovariance> make_decoupled_covariance(DiscrepancyKernel kernel,
                                                           Eigen::VectorXd month_variances,
                                                           Eigen::MatrixXd common_errors) {
  return std::make_unique<DecoupledCovariance>(std::move(kernel), std::move(month_variances),
                                               common_errors);
}

}  // namespace recald::calibration
