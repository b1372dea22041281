/// The interface of samplers: targets, options, results.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string_view>

#include "core/absent.hpp"
#include "core/random/rng.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// A log density on R^d that a sampler explores. An instance owns its scratch memory and serves one
/// chain at a time.
class Target {
 public:
  virtual ~Target() = default;

  [[nodiscard]] virtual Eigen::Index dimension() const = 0;

  /// @param point  (dimension)
  /// @return the log density, minus infinity where the density is zero; or an error that the
  ///         sampler cannot avoid, such as not_finite from the model.
  [[nodiscard]] virtual Result<double> log_density(const Eigen::VectorXd& point) = 0;

  /// Whether `log_density_and_gradient` may be called.
  [[nodiscard]] virtual bool has_gradient() const { return false; }

  /// As above, with its gradient. Where the density is zero the gradient is undefined.
  /// @param gradient  (dimension), already of that size.
  [[nodiscard]] virtual Result<double> log_density_and_gradient(const Eigen::VectorXd& point,
                                                                Eigen::VectorXd& gradient);

  /// The log of the part of the density that can be sampled directly by `draw_start`: the prior,
  /// with its constants. Tempering raises the rest, `log_density - log_prior`, to a power, so that
  /// the evidence comes out as the integral of the rest over the prior.
  [[nodiscard]] virtual double log_prior(const Eigen::VectorXd& point) const = 0;

  /// A draw from the prior: a starting point, more dispersed than the density itself.
  [[nodiscard]] virtual Eigen::VectorXd draw_start(Rng& rng) const = 0;
};

/// Position of a chain and its learnt step; enough to continue it.
struct ChainState {
  Eigen::VectorXd position;    ///< (d)
  double scale = 1.0;          ///< Step size or scale of the proposal.
  Eigen::MatrixXd covariance;  ///< (d x d) shape of the proposal, or inverse metric.
};

struct SamplerOptions {
  int iterations = 30'000;  ///< Including burn-in. For `smc`: particles.
  int burn_in = 3'000;      ///< Dropped; a sampler may adapt only during it.
  /// Where to begin, instead of a draw from the prior. With burn_in = 0 the chain with this final
  /// state is continued: its scale and covariance do not change.
  std::optional<ChainState> begin_at = {};
};

/// Statistics of a chain besides its draws. Absent figures are NaN.
struct ChainStatistics {
  double acceptance_rate = kAbsent;  ///< Of the kept iterations.
  long divergences = 0;              ///< Kept trajectories whose energy error exceeded the limit.
  long depth_limit_hits = 0;         ///< Kept trajectories cut at the largest tree depth.
  double e_bfmi = kAbsent;           ///< Betancourt (2016); below 0.3 is bad.
  long density_evaluations = 0;      ///< Including burn-in.
  long gradient_evaluations = 0;     ///< Including burn-in.
  /// log of the integral of (density / prior) times prior; only `smc` computes it.
  double log_evidence = kAbsent;
};

/// Draws of one chain after burn-in, in the target's coordinates.
struct Chain {
  Eigen::MatrixXd draws;        ///< (kept x dimension)
  Eigen::VectorXd log_density;  ///< (kept)
  ChainStatistics statistics;
  ChainState last;  ///< To continue from.
};

/// Called from time to time with the number of finished iterations; returns false to stop.
using SamplerObserver = std::function<bool(int done, int total)>;

/// Runs one chain. The same target, options and generator state give the same bytes.
///
/// @return the chain, or an error of the target, or invalid_value for invalid
///         options, or cancelled.
using SampleFunction = std::function<Result<Chain>(Target& target, const SamplerOptions& options,
                                                   Rng& rng, const SamplerObserver& observer)>;

/// @return invalid_value unless 0 < burn_in < iterations, or burn_in = 0 and there is a state
///         to continue from.
[[nodiscard]] Result<void> check_options(const SamplerOptions& options);

}  // namespace recald::calibration
