/// What all samplers that run one chain share: where it starts, and the loop around its iterations.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/calibration/sampler.hpp"

namespace recald::calibration {

/// How one sampler moves, adapts and reports. `run_chain` drives it.
class ChainKernel {
 public:
  virtual ~ChainKernel() = default;

  /// One iteration from `position()`. Does not allocate.
  [[nodiscard]] virtual Result<void> step() = 0;
  /// Learns from the iteration just done. Called after each of the burn-in and never later.
  [[nodiscard]] virtual Result<void> adapt() = 0;
  /// The burn-in is over: rates and counts of kept iterations begin at zero. Not called without
  /// one.
  virtual void begin_keeping() = 0;

  [[nodiscard]] virtual const Eigen::VectorXd& position() const = 0;
  [[nodiscard]] virtual double log_density() const = 0;
  [[nodiscard]] virtual ChainStatistics statistics() const = 0;
  /// With the scale and shape that the kept iterations used.
  [[nodiscard]] virtual ChainState state() const = 0;
};

/// All iterations of one chain.
/// @param observe_every  Iterations between calls of the observer; it is told of the last one too.
/// @return the chain, an error of the kernel, or cancelled.
/// @pre `check_options(options)` holds.
[[nodiscard]] Result<Chain> run_chain(ChainKernel& kernel, const SamplerOptions& options,
                                      int observe_every, const SamplerObserver& observer);

/// Where a chain starts, and the log density there.
struct StartingPoint {
  Eigen::VectorXd position;
  double log_density;
  long evaluations;  ///< Of the density, until such a point was found.
};

/// The state to begin at, if there is one, else the first draw from the prior of positive density.
/// @return not_finite when 100 draws, or the state, have no positive density; invalid_value when
///         the state belongs to another number of dimensions; an error of the target.
[[nodiscard]] Result<StartingPoint> choose_start(Target& target, const SamplerOptions& options,
                                                 Rng& rng);

/// Variance of each coordinate over 100 draws from the prior: how far apart things are before
/// anything is known. (dimension)
[[nodiscard]] Eigen::VectorXd spread_of_starts(const Target& target, Rng& rng);

/// Cholesky factor of the covariance of a state, which comes from outside; its scale is checked
/// too.
/// @return invalid_value when the covariance is not (dimension x dimension) or the scale not above
///         zero; not_positive_definite.
[[nodiscard]] Result<Eigen::LLT<Eigen::MatrixXd>> factor_of_state(const ChainState& state,
                                                                  Eigen::Index dimension);

}  // namespace recald::calibration
