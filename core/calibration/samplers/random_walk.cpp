#include "core/calibration/samplers/random_walk.hpp"

#include <cmath>

namespace recald::calibration {

double metropolis_probability(double log_ratio) {
  if (log_ratio >= 0.0) return 1.0;
  return log_ratio < 0.0 ? std::exp(log_ratio) : 0.0;
}

RandomWalk::RandomWalk(Target& target, Rng& rng, StartingPoint start, AdaptiveProposal proposal)
    : rng_(rng),
      current_(std::move(start)),
      first_(current_.position.size()),
      target_(target),
      proposal_(std::move(proposal)),
      evaluations_(current_.evaluations) {}

Result<void> RandomWalk::adapt() {
  proposal_.learn(current_.position, first_.unit, first_acceptance_);
  return {};
}

ChainStatistics RandomWalk::statistics() const {
  return {.acceptance_rate = static_cast<double>(accepted_) / static_cast<double>(iterations_),
          .density_evaluations = evaluations_};
}

Result<void> RandomWalk::propose(Proposal& proposal, double length) {
  proposal_.to_step(proposal.unit, proposal.step);
  proposal.position = current_.position + length * proposal.step;
  const auto value = TRY(target_.log_density(proposal.position));
  ++evaluations_;
  proposal.log_density = value;
  return {};
}

void RandomWalk::move_to(Proposal& proposal) {
  current_.position.swap(proposal.position);
  current_.log_density = proposal.log_density;
  ++accepted_;
}

}  // namespace recald::calibration
