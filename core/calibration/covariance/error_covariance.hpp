/// Covariance of all differences between measured points and the model's outputs.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/calibration/covariance/discrepancy.hpp"
#include "core/calibration/covariance/hyper_prior.hpp"

namespace recald::calibration {

/// Derivatives of the log-likelihood, eq. (7) of the seed.
struct LikelihoodGradient {
  /// (m) Sigma^-1 r: the derivative with respect to the model's outputs.
  Eigen::VectorXd weighted_residual;
  double log_discrepancy_precision;  ///< With respect to log lambda_delta.
  double log_error_precision;        ///< With respect to log lambda_epsilon.
  Eigen::VectorXd beta;              ///< (dimension) with respect to each beta.
};

/// Sigma(lambda_delta, lambda_epsilon, beta) of eq. (5) of the seed plus additional terms, for
/// fixed points. An instance owns its scratch memory; nothing allocates after construction.
///
/// Derivatives are those of  -1/2 r' Sigma^-1 r - 1/2 log|Sigma|: with a = Sigma^-1 r and
/// W = Sigma^-1 - a a',  d/dphi = -1/2 sum_ij W_ij (d Sigma / d phi)_ij.
class ErrorCovariance {
 public:
  virtual ~ErrorCovariance() = default;
  [[nodiscard]] virtual std::unique_ptr<ErrorCovariance> clone() const = 0;

  /// Assembles and factorises Sigma + jitter I. @return whether there is a factor.
  [[nodiscard]] virtual bool factorise(const Hyperparameters& hyper, double jitter) = 0;

  // All functions below use the last factor.
  [[nodiscard]] virtual double log_determinant() const = 0;
  /// r' Sigma^-1 r: one triangular solve.
  [[nodiscard]] virtual double squared_norm(const Eigen::VectorXd& residual) = 0;
  /// As above, with the derivatives of the log-likelihood at this residual.
  virtual double squared_norm_and_gradient(const Eigen::VectorXd& residual,
                                           LikelihoodGradient& gradient) = 0;
  /// The full Sigma^-1 (m x m). For assessments, not for samplers: it may allocate.
  virtual void precision(Eigen::MatrixXd& inverse) = 0;
};

/// Any points, any known extra covariance:  Sigma = C + F + I / lambda_epsilon.
///
/// @param fixed  F (m x m), lower triangle.
/// @note  m^3 / 6 multiplications to factorise, m^3 / 3 more for a gradient.
[[nodiscard]] std::unique_ptr<ErrorCovariance> make_dense_covariance(DiscrepancyKernel kernel,
                                                                     Eigen::MatrixXd fixed);

/// Every output measured in every month, with known extra variances v that differ between months
/// but not between outputs, and d errors g common to all points:
///
///     Sigma = B + g g',
///     B = (c 1 1' + (1 - c) I) (x) R / lambda_delta + I (x) (I / lambda_epsilon + diag v)
///
/// with R the correlation of months and c = exp(-beta_out) that of outputs. In B the mean over
/// outputs and the contrasts decouple: an orthogonal rotation over outputs leaves one block with
/// s = 1 + (K - 1) c and K - 1 equal ones with s = 1 - c, each  s R / lambda_delta + diag(…)  of
/// the size of one output. Two factors of n x n replace one of K n x K n: for two outputs a quarter
/// of the multiplications, for three a thirteenth, and exact. The common errors take one triangular
/// solve each (Woodbury).
///
/// @param month_variances  (months) v
/// @param common_errors    (m x d) g; without columns: there are none.
/// @pre kernel.is_complete()
[[nodiscard]] std::unique_ptr<ErrorCovariance> make_decoupled_covariance(
    DiscrepancyKernel kernel, Eigen::VectorXd month_variances, Eigen::MatrixXd common_errors);

}  // namespace recald::calibration
