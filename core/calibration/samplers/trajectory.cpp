#include "core/calibration/samplers/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/calibration/samplers/log_sum.hpp"

namespace recald::calibration {

TrajectorySampler::TrajectorySampler(Hamiltonian& hamiltonian, Rng& rng, int depth_max,
                                     double divergence_energy)
    : hamiltonian_(hamiltonian),
      rng_(rng),
      depth_max_(depth_max),
      divergence_energy_(divergence_energy),
      front_(hamiltonian.metric_factor().rows()),
      back_(front_),
      whole_(front_.position.size()),
      extension_(whole_),
      second_halves_(static_cast<std::size_t>(depth_max), whole_) {}

Result<Transition> TrajectorySampler::transition(PhasePoint& current, double step) {
  step_ = step;
  begin(current);
  Outcome outcome = Outcome::whole;
  for (int depth = 0; depth < depth_max_ && outcome == Outcome::whole; ++depth) {
    if (rng_.uniform() < 0.5) turn_round();
    outcome = extend(depth);
  }
  if (outcome == Outcome::failed) return tl::unexpected(std::move(*error_));
  current.position = whole_.choice.position;
  current.force = whole_.choice.force;
  current.log_density = whole_.choice.log_density;
  return Transition{.acceptance = acceptance_sum_ / std::max(points_, 1),
                    .energy = whole_.choice.energy,
                    .diverged = outcome == Outcome::diverged,
                    .at_depth_limit = outcome == Outcome::whole};
}

/// A trajectory of one point, with a new momentum.
void TrajectorySampler::begin(const PhasePoint& current) {
  front_ = current;
  for (double& r : front_.momentum) r = rng_.normal();
  back_ = front_;
  energy_0_ = Hamiltonian::energy(front_);
  record(front_, 0.0, whole_);
  whole_.choice.energy = energy_0_;
  acceptance_sum_ = 0.0;
  points_ = 0;
}

/// Doubles the trajectory at its front.
TrajectorySampler::Outcome TrajectorySampler::extend(int depth) {
  const Outcome outcome = walk(depth, extension_);
  if (outcome != Outcome::whole) return outcome;
  // Biased progressive sampling: min(1, new weight over old), not over their sum.
  if (std::log(rng_.uniform()) < extension_.log_weight - whole_.log_weight) {
    std::swap(whole_.choice, extension_.choice);
  }
  const bool turned = turns(whole_, extension_);
  append(whole_, extension_);
  return turned ? Outcome::turned : Outcome::whole;
}

/// 2^depth steps at the front. If any part turns or diverges, the whole is discarded.
TrajectorySampler::Outcome TrajectorySampler::walk(int depth, Stretch& stretch) {
  if (depth == 0) return walk_one_step(stretch);
  Stretch& second = second_halves_[static_cast<std::size_t>(depth - 1)];
  if (const Outcome outcome = walk(depth - 1, stretch); outcome != Outcome::whole) return outcome;
  if (const Outcome outcome = walk(depth - 1, second); outcome != Outcome::whole) return outcome;
  const double log_weight = log_sum(stretch.log_weight, second.log_weight);
  if (std::log(rng_.uniform()) < second.log_weight - log_weight) {
    std::swap(stretch.choice, second.choice);
  }
  const bool turned = turns(stretch, second);
  append(stretch, second);
  return turned ? Outcome::turned : Outcome::whole;
}

TrajectorySampler::Outcome TrajectorySampler::walk_one_step(Stretch& stretch) {
  if (auto moved = hamiltonian_.leapfrog(front_, step_); !moved) {
    error_ = std::move(moved.error());
    return Outcome::failed;
  }
  const double energy = Hamiltonian::energy(front_);
  ++points_;
  if (energy - energy_0_ > divergence_energy_) return Outcome::diverged;
  acceptance_sum_ += std::exp(std::min(0.0, energy_0_ - energy));
  record(front_, energy_0_ - energy, stretch);
  stretch.choice.energy = energy;
  return Outcome::whole;
}

/// Whether `first` followed by `second` turns back on itself, as a whole or where the two meet.
/// Time reversal changes nothing: all momenta keep the sign of time running forward.
bool TrajectorySampler::turns(const Stretch& first, const Stretch& second) {
  const auto& rho_1 = first.momentum_sum;
  const auto& rho_2 = second.momentum_sum;
  const auto opposed = [](const auto& rho, const auto& begin, const auto& end) {
    return rho.dot(begin) <= 0.0 || rho.dot(end) <= 0.0;
  };
  return opposed(rho_1 + rho_2, first.first_momentum, second.last_momentum) ||
         opposed(rho_1 + second.first_momentum, first.first_momentum, second.first_momentum) ||
         opposed(rho_2 + first.last_momentum, first.last_momentum, second.last_momentum);
}

void TrajectorySampler::append(Stretch& first, const Stretch& second) {
  first.last_momentum = second.last_momentum;
  first.momentum_sum += second.momentum_sum;
  first.log_weight = log_sum(first.log_weight, second.log_weight);
}

void TrajectorySampler::record(const PhasePoint& point, double log_weight, Stretch& stretch) {
  stretch.first_momentum = point.momentum;
  stretch.last_momentum = point.momentum;
  stretch.momentum_sum = point.momentum;
  stretch.log_weight = log_weight;
  stretch.choice.position = point.position;
  stretch.choice.force = point.force;
  stretch.choice.log_density = point.log_density;
}

void TrajectorySampler::turn_round() {
  std::swap(front_, back_);
  whole_.first_momentum.swap(whole_.last_momentum);
  step_ = -step_;
}

}  // namespace recald::calibration
