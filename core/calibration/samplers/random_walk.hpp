/// Shared by random walks: the current point, the adaptive proposal, the counts.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "core/calibration/samplers/adaptive_proposal.hpp"
#include "core/calibration/samplers/chain_loop.hpp"
#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// min(1, exp(log_ratio)); 0 for a NaN, so that a chain never moves to a point of unknown density.
[[nodiscard]] double metropolis_probability(double log_ratio);

/// A proposed point, and the step that led to it.
struct Proposal {
  explicit Proposal(Eigen::Index d) : unit(d), step(d), position(d) {}
  Eigen::VectorXd unit;  ///< u
  Eigen::VectorXd step;  ///< s L u
  Eigen::VectorXd position;
  double log_density = 0.0;
};

/// Random-walk Metropolis without the step itself.
class RandomWalk : public ChainKernel {
 public:
  RandomWalk(Target& target, Rng& rng, StartingPoint start, AdaptiveProposal proposal);

  void begin_keeping() override { accepted_ = iterations_ = 0; }
  [[nodiscard]] Result<void> adapt() override;
  [[nodiscard]] const Eigen::VectorXd& position() const override { return current_.position; }
  [[nodiscard]] double log_density() const override { return current_.log_density; }
  [[nodiscard]] ChainStatistics statistics() const override;
  [[nodiscard]] ChainState state() const override { return proposal_.state(current_.position); }

 protected:
  /// Computes the point at `length` times the step from `proposal.unit`, already drawn,
  /// and its density.
  [[nodiscard]] Result<void> propose(Proposal& proposal, double length = 1.0);
  void move_to(Proposal& proposal);

  Rng& rng_;
  StartingPoint current_;
  Proposal first_;
  double first_acceptance_ = 0.0;  ///< Probability with which `first_` was accepted.
  long iterations_ = 0;

 private:
  Target& target_;
  AdaptiveProposal proposal_;
  long evaluations_;
  long accepted_ = 0;
};

/// Runs a chain of `Walk`, which derives from `RandomWalk` and adds a step.
template <class Walk>
Result<Chain> run_random_walk(Target& target, const SamplerOptions& options, Rng& rng,
                              const SamplerObserver& observer) {
  constexpr int observe_every = 250;
  TRY(check_options(options));
  auto proposal = TRY(AdaptiveProposal::make(target, options, Walk::target_acceptance, rng));
  auto start = TRY(choose_start(target, options, rng));
  Walk walk(target, rng, std::move(start), std::move(proposal));
  return run_chain(walk, options, observe_every, observer);
}

}  // namespace recald::calibration
