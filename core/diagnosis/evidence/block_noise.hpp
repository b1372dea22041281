/// The noise of a meter around the building model: slow structure, recurring pattern, white noise.
///
/// One meter's residual r (n block means, kW) is  r = Z a + u + e  with
///     a ~ N(0, tau^2 I)        recurring pattern: hour of week, spline in outdoor temperature, ...
///     u ~ OU(s, T)             errors in the structure of the model, slowly varying
///     e ~ N(0, diag(E))        E_i = sigma^2, or 25 sigma^2 for a gated point
/// so its covariance is  Sigma = K_u + tau^2 Z Z' + diag(E), which is never formed: a Kalman filter
/// with one state whitens u + e (Sigma_0 = K_u + diag(E), W Sigma_0 W' = I), and Woodbury adds the
/// pattern through C = I + tau^2 Z' Sigma_0^-1 Z.
/// @see Rasmussen, Williams (2006), Gaussian Processes for Machine Learning, eq. (A.9);
///      Durbin, Koopman (2012), Time Series Analysis by State Space Methods, chapter 4.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/random/rng.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// Hyper-parameters of one meter. Units are those of the residual, kW unless it is scaled.
struct NoiseLevel {
  double structure_sd;   ///< s >= 0, of u.
  double correlation_h;  ///< T > 0: u at times t and t' correlates by exp(-|t - t'| / T).
  double white_sd;       ///< sigma > 0, of e.
  double pattern_sd;     ///< tau >= 0, of each element of a.
};

/// Variance of a gated point in units of sigma^2.
inline constexpr double gated_variance_factor = 25.0;

/// The times of one meter's readings and their recurring patterns. Missing blocks are absent.
struct BlockDesign {
  Eigen::VectorXd times_h;   ///< (n) strictly increasing; gaps of any length.
  Eigen::MatrixXd patterns;  ///< Z (n x p), p may be 0; fast if mostly zeros (one-hot, B-splines).
  std::vector<bool> gated;   ///< (n), or empty: no gated points.
  Eigen::Index drifts = 0;   ///< Number of last patterns that depend on dates and do not recur.
};

/// A = sum_i E[(Z a + u)_i^2 | r] and B = sum_i E[e_i^2 | r], unit of the residual squared.
/// V = A / (A + B) is the share of the structural terms in the residual.
struct ResidualShares {
  double structural;  ///< A
  double white;       ///< B
};

/// Z in few bytes, shared by objects built for several levels.
using SparsePatterns = std::shared_ptr<const Eigen::SparseMatrix<double>>;
[[nodiscard]] SparsePatterns sparse_patterns(const BlockDesign& design);

/// Sigma of one meter, factorised once for one `NoiseLevel`.
///
/// Factorising costs O(n p^2) at worst, O(n p) for sparse patterns; everything else is linear in n.
/// Held-out points that must be scored without their neighbours get their own BlockNoise: built on
/// those points alone, it is their marginal, with u not conditioned on anything else.
class BlockNoise {
 public:
  /// @pre sizes agree, times increase, n >= 1, and the level is in the ranges stated there.
  BlockNoise(const BlockDesign& design, const NoiseLevel& level)
      : BlockNoise(design, level, sparse_patterns(design)) {}
  /// @param patterns  `sparse_patterns` of the same design.
  BlockNoise(const BlockDesign& design, const NoiseLevel& level, SparsePatterns patterns);

  [[nodiscard]] Eigen::Index points() const { return weight_.size(); }
  [[nodiscard]] const NoiseLevel& level() const { return level_; }

  /// log|Sigma|
  [[nodiscard]] double log_determinant() const { return log_determinant_; }

  /// X' Sigma^-1 X (k x k), symmetric.
  /// @param columns  X (n x k), kW per unit of the column's quantity.
  /// @note  O(n k (k + nonzeros of Z per row)).
  [[nodiscard]] Eigen::MatrixXd gram(const Eigen::MatrixXd& columns) const;

  /// x' Sigma^-1 x of each column (k): the diagonal of `gram`.
  [[nodiscard]] Eigen::VectorXd squared_norms(const Eigen::MatrixXd& columns) const;

  /// Sigma^-1 X (n x k). Products with further columns then cost one inner product each.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& columns) const;

  /// W X (n x k): standardised one-step prediction errors of u + e. They are white with unit
  /// variance once the pattern is removed, which is not done here (see `pattern_mean`).
  [[nodiscard]] Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns) const;

  /// E[a | r] (p), kW.
  [[nodiscard]] Eigen::VectorXd pattern_mean(const Eigen::VectorXd& residual) const;

  /// log N(r; 0, Sigma)
  [[nodiscard]] double marginal_log_density(const Eigen::VectorXd& residual) const;

  /// log t_nu(r; 0, Sigma): Sigma is known up to a factor with an inverse gamma distribution, so
  /// that a model with larger errors than assumed does not win or lose by their square.
  /// @param freedom  nu > 0
  [[nodiscard]] double student_log_density(const Eigen::VectorXd& residual, double freedom) const;

  /// A draw of N(0, Sigma) (n) by definition: pattern + OU path + white.
  [[nodiscard]] Eigen::VectorXd draw(Rng& rng) const;

  /// Smoothed squares of the structural terms and of the noise.
  ///
  /// @param residual    (n) at the posterior mean of the parameters: y - f.
  /// @param jacobian    J (n x q) of the meter in the parameters (theta, and eta once added).
  /// @param covariance  (q x q) posterior covariance of these parameters, whose uncertainty enters
  ///                    both sums. q may be 0.
  /// @note  O(n p^2).
  [[nodiscard]] ResidualShares residual_shares(const Eigen::VectorXd& residual,
                                               const Eigen::MatrixXd& jacobian,
                                               const Eigen::MatrixXd& covariance) const;

 private:
  void factor_filter(const BlockDesign& design);
  void factor_patterns();
  struct Whitened;
  /// W X, and the projection of W' W X on the patterns.
  [[nodiscard]] Whitened whiten_and_gather(const Eigen::MatrixXd& columns) const;
  /// W' W X (n x k).
  [[nodiscard]] Eigen::MatrixXd weigh(const Eigen::MatrixXd& columns) const;
  template <class Strip>
  void whiten_strip(Strip& strip) const;
  template <class Strip>
  void whiten_strip_transposed(Strip& strip) const;
  template <class Strip>
  void gather(const Strip& strip, Eigen::Ref<Eigen::MatrixXd> products, Eigen::Index from) const;
  /// Diagonal of Sigma^-1 (n).
  [[nodiscard]] Eigen::VectorXd inverse_diagonal() const;

  NoiseLevel level_;
  Eigen::VectorXd white_variance_;  ///< (n) E_i
  Eigen::VectorXd correlation_;     ///< (n) of u_i and u_{i+1}; the last is 0.
  Eigen::VectorXd weight_;          ///< (n) 1 / sd of the one-step prediction error.
  Eigen::VectorXd keep_;            ///< (n) share of the old prediction in the next one.
  Eigen::VectorXd take_;            ///< (n) share of the reading in the next prediction.
  SparsePatterns patterns_;         ///< Z (n x p), by columns, so Z' X gathers.
  Eigen::LLT<Eigen::MatrixXd> pattern_factor_;  ///< C = I + tau^2 Z' Sigma_0^-1 Z (p x p)
  double log_determinant_ = 0.0;
};

struct LevelFit {
  NoiseLevel level;
  double log_density;  ///< Log marginal likelihood plus log prior density at the maximum.
  int evaluations;     ///< Number of factorised covariances.
};

/// Finds (s, T, sigma) of highest posterior density for a given tau.
///
/// Priors: s half-normal with sd 10 % of the mean, T log-uniform on 12 to 480 h, sigma log-uniform
/// on 0.01 to 100 % of the mean. Nelder-Mead on the logs of the three, from two starts.
/// @param residual  (n) kW.
/// @param mean      Mean of the meter, kW, > 0.
/// @param pattern_share  tau in units of that mean.
/// @param start     A level known to be close; absent: two starts, slow and noisy.
/// @return the maximum, or
///         not_enough_data  fewer than 10 points;
///         not_finite       a NaN or infinity in the residual.
[[nodiscard]] Result<LevelFit> fit_levels(const Eigen::VectorXd& residual,
                                          const BlockDesign& design, double mean,
                                          double pattern_share = 0.02,
                                          const std::optional<NoiseLevel>& start = {});

/// One meter's data for `choose_gates`.
struct GateInput {
  const BlockDesign& design;        ///< Its `gated` is ignored.
  const Eigen::VectorXd& residual;  ///< (n) kW
  NoiseLevel level;                 ///< As fitted without gates.
};

struct GateOptions {
  double limit_sd = 4.0;    ///< Standardised one-step residual above which a point stands out.
  double share_max = 0.02;  ///< Of a meter's points; the largest ones are kept.
  double neighbourhood_h = 4.001;  ///< Points this close are neighbours: one block.
};

/// Which points are outliers: they stand out, alone in their meter's neighbourhood and in no other
/// meter at the same time. Runs and simultaneous deviations are effects, not outliers.
///
/// While passing a point that stands out, the filter gives it the small weight of a gated one;
/// otherwise one wild reading would make its successor stand out too. The filter then also follows
/// a true change of level more slowly, which makes that change visible as a run.
/// @return for each meter (n) flags.
[[nodiscard]] std::vector<std::vector<bool>> choose_gates(std::span<const GateInput> meters,
                                                          const GateOptions& options = {});

}  // namespace recald::diagnosis
