/// Evidence of a linear-Gaussian model from inner products: which effect, how certain, how large.
///
/// Near a mode the meters are linear in the base parameters theta and in the amount eta of an
/// effect,  y - f(theta_0) = J theta + s eta + noise,  noise ~ N(0, Sigma),
/// theta ~ N(0, Lambda^-1) as a deviation from its prior mean. After Gauss-Newton at theta_1 the
/// residual column is therefore  r = y - f(theta_1) + J (theta_1 - theta_0).
/// Evidence needs only the Gram matrix of the columns [r | J | s] under Sigma^-1. Integrating out a
/// block of parameters is a Schur complement, which turns Sigma^-1 into
///     M = Sigma^-1 - Sigma^-1 J (J' Sigma^-1 J + Lambda)^-1 J' Sigma^-1
///       = (Sigma + J Lambda^-1 J')^-1.
/// @see Rasmussen, Williams (2006), Gaussian Processes for Machine Learning, section 2.7.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/diagnosis/evidence/block_noise.hpp"
#include "core/random/rng.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// Inner products X' P X of columns X = [r | ...] under a precision P (Sigma^-1, or M once the
/// base parameters are integrated out). Column 0 is always the residual.
struct GramSystem {
  Eigen::MatrixXd gram;          ///< (1 + k) x (1 + k), symmetric.
  double log_determinant = 0.0;  ///< log|P^-1|
  Eigen::Index points = 0;       ///< n, over all meters.

  /// Adds an independent meter: same columns, its own rows.
  void add(const BlockNoise& noise, const Eigen::MatrixXd& columns);
};

/// Mean and covariance of parameters given the data.
struct GaussianPosterior {
  Eigen::VectorXd mean;        ///< (q)
  Eigen::MatrixXd covariance;  ///< (q x q)
};

/// Integrates out columns 1 to q, with priors N(0, .) and joint precision `prior_precision`.
///
/// The effect of one candidate is integrated out like theta: put its column next and extend the
/// precision by 1 / sd^2.
/// @param prior_precision  Lambda (q x q), positive definite; q = 0 returns the system unchanged.
/// @return the system of the columns [r | the rest] under M, or not_positive_definite.
[[nodiscard]] Result<GramSystem> marginalise(const GramSystem& system,
                                             const Eigen::MatrixXd& prior_precision);

/// Posterior of the parameters of columns 1 to q; later columns are left out of the model.
/// @return the posterior, or not_positive_definite.
[[nodiscard]] Result<GaussianPosterior> posterior(const GramSystem& system,
                                                  const Eigen::MatrixXd& prior_precision);

/// The system of the residual and the chosen columns, in the given order. The residual (0)
/// always comes first.
[[nodiscard]] GramSystem select(const GramSystem& system, std::span<const Eigen::Index> columns);

/// log N(r; 0, P^-1): the evidence, once every parameter is integrated out. Other
/// columns are ignored.
[[nodiscard]] double log_evidence(const GramSystem& system);

/// d_j = sqrt(s_j' M s_j) (k) of columns 1 to k: signal of one unit, in sd of the unexplained part.
[[nodiscard]] Eigen::VectorXd detectability(const GramSystem& system);

/// z_j = s_j' M r / d_j (k): N(0, 1) if the model is complete. 0 for an invisible column.
[[nodiscard]] Eigen::VectorXd score(const GramSystem& system);

/// kappa_ij = s_i' M s_j / (d_i d_j) (k x k): correlation of the scores. Invisible columns, those
/// with d_j^2 below 1e-12 of the largest, have a row and column of zeros.
[[nodiscard]] Eigen::MatrixXd confusability(const GramSystem& system);

/// 1 - s' M s / s' Sigma^-1 s (k): the share of each signal that theta can imitate.
/// @param before  System with columns [r | J (q) | s (k)].
/// @param after   The same with J integrated out.
[[nodiscard]] Eigen::VectorXd absorbed_share(const GramSystem& before, const GramSystem& after);

/// Evidence over nodes of a grid:  log sum_i w_i exp(L_i).
/// @param log_evidences  (m) L_i   @param log_weights  (m) prior weights of the nodes, summing
/// to 1.
[[nodiscard]] double combine_nodes(const Eigen::VectorXd& log_evidences,
                                   const Eigen::VectorXd& log_weights);
/// Posterior weights of the nodes (m), summing to 1.
[[nodiscard]] Eigen::VectorXd node_weights(const Eigen::VectorXd& log_evidences,
                                           const Eigen::VectorXd& log_weights);

/// Draws of N(0, correlation), one per column (k x draws).
/// @param correlation  (k x k) positive semi-definite; singular is fine.
[[nodiscard]] Eigen::MatrixXd draw_scores(const Eigen::MatrixXd& correlation, int draws, Rng& rng);

/// max_j |z_j| of each draw, ascending (draws): the null distribution of the largest score.
[[nodiscard]] Eigen::VectorXd null_maxima(const Eigen::MatrixXd& correlation, int draws, Rng& rng);

/// (1 + number of maxima >= statistic) / (1 + number of maxima): p-value by Monte Carlo.
/// @param maxima  Ascending.
[[nodiscard]] double exceedance(const Eigen::VectorXd& maxima, double statistic);

/// Two-sided p-value of a standard normal score.
[[nodiscard]] double normal_p_value(double score);

}  // namespace recald::diagnosis
