#include "core/calibration/samplers/dram.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "core/calibration/samplers/random_walk.hpp"

namespace recald::calibration {
namespace {

constexpr double kSecondStage = 0.5;  // g

class DelayedRejectionWalk final : public RandomWalk {
 public:
  static constexpr double target_acceptance = 0.25;  // of the first stage

  DelayedRejectionWalk(Target& target, Rng& rng, StartingPoint start, AdaptiveProposal proposal)
      : RandomWalk(target, rng, std::move(start), std::move(proposal)),
        second_(current_.position.size()) {}

  [[nodiscard]] Result<void> step() override {
    ++iterations_;
    for (double& u : first_.unit) u = rng_.normal();
    if (auto proposed = propose(first_); !proposed) return proposed;
    first_acceptance_ = metropolis_probability(first_.log_density - current_.log_density);
    if (rng_.uniform() < first_acceptance_) {
      move_to(first_);
      return {};
    }
    for (double& u : second_.unit) u = rng_.normal();
    if (auto proposed = propose(second_, kSecondStage); !proposed) return proposed;
    if (rng_.uniform() < metropolis_probability(second_log_ratio())) move_to(second_);
    return {};
  }

 private:
  /// Log of the ratio of the second stage. The first proposal was rejected, so a(z, y1) < 1.
  [[nodiscard]] double second_log_ratio() const {
    // From y2 the first proposal would certainly have been accepted, so there is no way back.
    if (!(second_.log_density > first_.log_density)) {
      return -std::numeric_limits<double>::infinity();
    }
    const double back = std::exp(first_.log_density - second_.log_density);  // a(y2, y1)
    const double detour = (first_.unit - kSecondStage * second_.unit).squaredNorm();
    return second_.log_density - current_.log_density - 0.5 * (detour - first_.unit.squaredNorm()) +
           std::log1p(-back) - std::log1p(-first_acceptance_);
  }

  Proposal second_;  // y2
};

}  // namespace

Result<Chain> dram(Target& target, const SamplerOptions& options, Rng& rng,
                   const SamplerObserver& observer) {
  return run_random_walk<DelayedRejectionWalk>(target, options, rng, observer);
}

}  // namespace recald::calibration
