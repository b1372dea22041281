#include "core/calibration/samplers/nuts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/calibration/samplers/chain_loop.hpp"
#include "core/calibration/samplers/hamiltonian.hpp"
#include "core/calibration/samplers/step_size.hpp"
#include "core/calibration/samplers/trajectory.hpp"
#include "core/calibration/samplers/warm_up.hpp"

namespace recald::calibration {
namespace {

/// Energy Bayesian fraction of missing information: how far a new momentum changes the energy,
/// compared with the range of the energy. Betancourt (2016), arXiv:1604.00695, eq. (4.1).
class EnergyFraction {
 public:
  void add(double energy) {
    if (count_ > 0) moves_ += (energy - previous_) * (energy - previous_);
    previous_ = energy;
    count_ += 1.0;
    const double from_mean = energy - mean_;  // Welford's running sum of squares
    mean_ += from_mean / count_;
    squares_ += from_mean * (energy - mean_);
  }
  [[nodiscard]] double value() const { return moves_ / squares_; }

 private:
  double count_ = 0.0;
  double previous_ = 0.0;
  double moves_ = 0.0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

/// Iterations of the longest window, for which the estimator allocates room.
int longest_window(const std::vector<int>& ends) {
  int longest = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) longest = std::max(longest, ends[i] - ends[i - 1]);
  return longest;
}

class NutsKernel final : public ChainKernel {
 public:
  NutsKernel(Target& target, const SamplerOptions& options, const NutsOptions& nuts_options,
             Rng& rng)
      : target_(target),
        rng_(rng),
        hamiltonian_(target),
        trajectories_(hamiltonian_, rng, nuts_options.depth_max, nuts_options.divergence_energy),
        current_(target.dimension()),
        averaging_(nuts_options.target_acceptance),
        window_ends_(window_ends(options.burn_in, options.begin_at.has_value())),
        estimator_(target.dimension(), longest_window(window_ends_)) {}

  /// Finds a start, the first metric and the first step.
  Result<void> start(const SamplerOptions& options) {
    if (auto found = begin_metric(options); !found) return found;
    auto start = TRY(choose_start(target_, options, rng_));
    density_evaluations_ = start.evaluations;
    current_.position = std::move(start.position);
    if (auto evaluated = hamiltonian_.evaluate(current_); !evaluated) return evaluated;
    return options.burn_in == 0 ? Result<void>{} : begin_averaging();
  }

  [[nodiscard]] Result<void> step() override {
    auto transition = TRY(trajectories_.transition(current_, step_));
    acceptance_ = transition.acceptance;
    acceptance_sum_ += acceptance_;
    iterations_ += 1.0;
    divergences_ += transition.diverged ? 1 : 0;
    depth_limit_hits_ += transition.at_depth_limit ? 1 : 0;
    energies_.add(transition.energy);
    return {};
  }

  [[nodiscard]] Result<void> adapt() override {
    ++adapted_;
    step_ = averaging_.update(acceptance_);
    if (window_ends_.empty() || adapted_ <= window_ends_.front()) return {};
    if (adapted_ > window_ends_.back()) return {};
    estimator_.add(current_.position, current_.force);
    if (std::ranges::find(window_ends_, adapted_) == window_ends_.end()) return {};
    hamiltonian_.set_metric_factor(estimator_.factor(hamiltonian_.metric_factor()));
    estimator_.restart();
    if (auto evaluated = hamiltonian_.evaluate(current_); !evaluated) return evaluated;
    return begin_averaging();
  }

  void begin_keeping() override {
    step_ = averaging_.mean_step();
    acceptance_sum_ = iterations_ = 0.0;
    divergences_ = depth_limit_hits_ = 0;
    energies_ = {};
  }

  [[nodiscard]] const Eigen::VectorXd& position() const override { return current_.position; }
  [[nodiscard]] double log_density() const override { return current_.log_density; }
  [[nodiscard]] ChainStatistics statistics() const override {
    return {.acceptance_rate = acceptance_sum_ / iterations_,
            .divergences = divergences_,
            .depth_limit_hits = depth_limit_hits_,
            .e_bfmi = energies_.value(),
            .density_evaluations = density_evaluations_,
            .gradient_evaluations = hamiltonian_.gradient_evaluations()};
  }
  [[nodiscard]] ChainState state() const override {
    const Eigen::MatrixXd& factor = hamiltonian_.metric_factor();
    return {current_.position, step_, factor * factor.transpose()};
  }

 private:
  Result<void> begin_metric(const SamplerOptions& options) {
    if (!options.begin_at) {
      const Eigen::VectorXd sd = spread_of_starts(target_, rng_).cwiseSqrt();
      hamiltonian_.set_metric_factor(sd.asDiagonal());
      return {};
    }
    auto factor = TRY(factor_of_state(*options.begin_at, target_.dimension()));
    hamiltonian_.set_metric_factor(factor.matrixL());
    step_ = options.begin_at->scale;
    return {};
  }

  /// Searches for a new step size, because the metric has changed.
  Result<void> begin_averaging() {
    step_ = TRY(reasonable_step(hamiltonian_, current_, step_, rng_));
    averaging_.restart(step_);
    return {};
  }

  Target& target_;
  Rng& rng_;
  Hamiltonian hamiltonian_;
  TrajectorySampler trajectories_;
  PhasePoint current_;
  double step_ = 1.0;
  DualAveraging averaging_;
  std::vector<int> window_ends_;
  MetricEstimator estimator_;
  int adapted_ = 0;  ///< Finished iterations of the burn-in.

  double acceptance_ = 0.0;  ///< Of the last iteration.
  double acceptance_sum_ = 0.0;
  double iterations_ = 0.0;
  long divergences_ = 0;
  long depth_limit_hits_ = 0;
  long density_evaluations_ = 0;
  EnergyFraction energies_;
};

Result<void> check_nuts(const Target& target, const NutsOptions& options) {
  if (!target.has_gradient()) {
    return failure(ErrorCode::unsupported,
                   "nuts needs a gradient and this model has none; choose dram or smc");
  }
  if (!(options.target_acceptance > 0.0 && options.target_acceptance < 1.0)) {
    return failure(ErrorCode::invalid_value,
                   "the target acceptance of nuts must be above 0 and below 1");
  }
  if (options.depth_max < 1 || options.depth_max > 20 || !(options.divergence_energy > 0.0)) {
    return failure(ErrorCode::invalid_value,
                   "nuts needs a maximum depth of 1 to 20 and a divergence energy above 0");
  }
  return {};
}

}  // namespace

Result<Chain> nuts(Target& target, const SamplerOptions& options, Rng& rng,
                   const SamplerObserver& observer, const NutsOptions& nuts_options) {
  TRY(check_options(options));
  TRY(check_nuts(target, nuts_options));
  NutsKernel kernel(target, options, nuts_options, rng);
  TRY(kernel.start(options));
  return run_chain(kernel, options, 1, observer);
}

}  // namespace recald::calibration
