/// What every sampler takes and gives.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/random/rng.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// A log density on R^d, up to a constant, that a sampler explores.
///
/// An instance owns its scratch memory and serves one chain at a time.
class Target {
 public:
  virtual ~Target() = default;

  [[nodiscard]] virtual Eigen::Index dimension() const = 0;

  /// @param point  (dimension)
  /// @return the log density, minus infinity where the density is zero; or an error that no choice
  /// of
  ///         the sampler can repair, such as not_finite from the model.
  [[nodiscard]] virtual Result<double> log_density(const Eigen::VectorXd& point) = 0;

  /// A point to start from, more spread out than the density itself; a draw from the prior.
  [[nodiscard]] virtual Eigen::VectorXd draw_start(Rng& rng) const = 0;
};

struct SamplerOptions {
  int iterations = 30'000;  ///< All of them, burn-in included.
  int burn_in = 3'000;  ///< Dropped; the only time a sampler may adapt. 0 < burn_in < iterations.
};

/// Draws of one chain after burn-in, in the target's coordinates.
struct Chain {
  Eigen::MatrixXd draws;        ///< (iterations - burn_in x dimension)
  Eigen::VectorXd log_density;  ///< (iterations - burn_in)
  double acceptance_rate;       ///< Of the kept iterations.
};

/// Told from time to time how many iterations are done; returns false to stop.
using SamplerObserver = std::function<bool(int done, int total)>;

/// One chain. The same target, options and generator state give the same bytes.
///
/// @return the chain, or an error of the target, or cancelled.
using Sampler = std::function<Result<Chain>(Target& target, const SamplerOptions& options, Rng& rng,
                                            const SamplerObserver& observer)>;

/// @return invalid_value unless 0 < burn_in < iterations.
[[nodiscard]] Result<void> check_options(const SamplerOptions& options);

}  // namespace recald::calibration
