/// Shared by all samplers that run one chain: the starting point, and the loop
/// around the iterations.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// How a sampler moves, adapts and reports. `run_chain` drives it.
class ChainKernel {
 public:
  virtual ~ChainKernel() = default;

  /// One iteration from `position()`. Does not allocate.
  [[nodiscard]] virtual Result<void> step() = 0;
  /// Learns from the last iteration. Called after each iteration of the burn-in, never later.
  [[nodiscard]] virtual Result<void> adapt() = 0;
  /// The burn-in is over: resets rates and counts for the kept iterations. Not called
  /// without a burn-in.
  virtual void begin_keeping() = 0;

  [[nodiscard]] virtual const Eigen::VectorXd& position() const = 0;
  [[nodiscard]] virtual double log_density() const = 0;
  [[nodiscard]] virtual ChainStatistics statistics() const = 0;
  /// With the scale and shape used by the kept iterations.
  [[nodiscard]] virtual ChainState state() const = 0;
};

/// Seconds of the processor that this thread has had: a machine that is busy with others changes
/// nothing.
[[nodiscard]] double worked_s();
/// A slow model is asked so often whether it should go on: a stop is to be heard within a second.
inline constexpr double kObserveWithin_s = 0.25;

/// Runs all iterations of one chain.
/// @param observe_every  Iterations between calls of the observer at most, which is also called
///                       after the last, and sooner where they take longer than a moment.
/// @return the chain, an error of the kernel, or cancelled.
/// @pre `check_options(options)` holds.
[[nodiscard]] Result<Chain> run_chain(ChainKernel& kernel, const SamplerOptions& options,
                                      int observe_every, const SamplerObserver& observer);

/// Where a chain starts, and the log density there.
struct StartingPoint {
  Eigen::VectorXd position;
  double log_density;
  long evaluations;  ///< Of the density, until this point was found.
};

/// The state to begin at, if given, else the first draw from the prior with positive density.
/// @return the point; not_finite when 100 draws, or the state, have no positive density;
///         invalid_value when the state has another number of dimensions; an error of the target.
[[nodiscard]] Result<StartingPoint> choose_start(Target& target, const SamplerOptions& options,
                                                 Rng& rng);

/// Variance of each coordinate over 100 draws from the prior. (dimension)
[[nodiscard]] Eigen::VectorXd spread_of_starts(const Target& target, Rng& rng);

/// Cholesky factor of the covariance of a state from outside; also checks its scale.
/// @return the factor; invalid_value when the covariance is not (dimension x dimension) or the
///         scale is not above zero; not_positive_definite.
[[nodiscard]] Result<Eigen::LLT<Eigen::MatrixXd>> factor_of_state(const ChainState& state,
                                                                  Eigen::Index dimension);

}  // namespace recald::calibration
