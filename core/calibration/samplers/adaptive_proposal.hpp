/// The step size and shape of a random walk, and how they adapt during the burn-in.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// Steps s L u of a random walk, where u is d independent numbers of unit variance that the sampler
/// draws. The scale s and the shape L adapt during the burn-in and are frozen after it, so that the
/// kept draws come from one fixed reversible chain.
///
///  - s follows Robbins-Monro steps towards an acceptance rate throughout.
///  - L starts from the spread of draws from the prior. For the first half of the burn-in it
///    follows robust adaptive Metropolis: it learns from acceptance, not from the chain's own
///    covariance, which would shorten the steps of a chain that has hardly moved. At one half and
///    at five sixths it becomes the factor of the covariance of the chain's latest stretch.
///  - A chain that begins at a state already has a shape, so it skips the first half.
///
/// @see Haario, Saksman, Tamminen (2001), Bernoulli 7(2), "An adaptive Metropolis algorithm";
///      Vihola (2012), Stat. Comput. 22, "Robust adaptive Metropolis algorithm with coerced
///      acceptance rate".
class AdaptiveProposal {
 public:
  /// @return invalid_value or not_positive_definite when the initial shape is not a covariance.
  static Result<AdaptiveProposal> make(const Target& target, const SamplerOptions& options,
                                       double target_acceptance, Rng& rng);

  /// step = s L unit. Does not allocate.
  void to_step(const Eigen::VectorXd& unit, Eigen::VectorXd& step) const;

  /// @param position    Position of the chain after the iteration.
  /// @param unit        u of the proposal.
  /// @param acceptance  Probability with which the proposal was accepted.
  void learn(const Eigen::VectorXd& position, const Eigen::VectorXd& unit, double acceptance);

  /// `position`, with the current s and the covariance of which L L' is 2.38^2 / d times:
  /// about that of the density, which other samplers also store, so that one can begin
  /// where another ended.
  [[nodiscard]] ChainState state(const Eigen::VectorXd& position) const;

 private:
  AdaptiveProposal(const SamplerOptions& options, double target_acceptance, Eigen::Index dimension);

  void tune_scale(double acceptance);
  void tune_shape(const Eigen::VectorXd& unit, double acceptance);
  void learn_shape(const Eigen::Ref<const Eigen::MatrixXd>& positions);

  double target_acceptance_;
  Eigen::LLT<Eigen::MatrixXd> shape_;  // L
  double log_scale_ = 0.0;             // log s
  int tuned_ = 0;
  Eigen::VectorXd scratch_;    ///< (d)
  Eigen::MatrixXd positions_;  ///< (burn-in x d)
  Eigen::Index seen_ = 0;
  Eigen::Index rough_end_;
  Eigen::Index end_;
};

}  // namespace recald::calibration
