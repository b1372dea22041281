#include "core/calibration/samplers/seed_rwm.hpp"

#include <cmath>

#include "core/calibration/samplers/random_walk.hpp"

namespace recald::calibration {
namespace {

class UniformWalk final : public RandomWalk {
 public:
  static constexpr double target_acceptance = 0.25;
  using RandomWalk::RandomWalk;

  [[nodiscard]] Result<void> step() override {
    ++iterations_;
    for (double& u : first_.unit) u = rng_.uniform(-std::sqrt(3.0), std::sqrt(3.0));  // variance 1
    if (auto proposed = propose(first_); !proposed) return proposed;
    first_acceptance_ = metropolis_probability(first_.log_density - current_.log_density);
    if (rng_.uniform() < first_acceptance_) move_to(first_);
    return {};
  }
};

}  // namespace

Result<Chain> seed_rwm(Target& target, const SamplerOptions& options, Rng& rng,
                       const SamplerObserver& observer) {
  return run_random_walk<UniformWalk>(target, options, rng, observer);
}

}  // namespace recald::calibration
