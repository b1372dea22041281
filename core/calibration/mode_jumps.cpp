#include "core/calibration/mode_jumps.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/calibration/gaussian_mixture.hpp"

namespace recald::calibration {
namespace {

constexpr int kHillsMax = 6;
constexpr int kRounds = 3;
constexpr long kJumpsEnough = 10;  // per particle, on average
constexpr double kEffectiveShareMin = 0.02;

/// Running sums of importance weights, relative to the largest so far.
class WeightSums {
 public:
  void add(double log_weight) {
    ++count_;
    if (std::isinf(log_weight) && log_weight < 0.0) return;
    if (log_weight > largest_) {
      const double shrink = std::exp(largest_ - log_weight);
      sum_ *= shrink;
      squares_ *= shrink * shrink;
      largest_ = log_weight;
    }
    const double weight = std::exp(log_weight - largest_);
    sum_ += weight;
    squares_ += weight * weight;
  }

  [[nodiscard]] double log_mean() const {
    return largest_ + std::log(sum_ / static_cast<double>(count_));
  }
  [[nodiscard]] double effective_share() const {
    return count_ == 0 ? 0.0 : sum_ * sum_ / (squares_ * static_cast<double>(count_));
  }

 private:
  long count_ = 0;
  double largest_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0.0;
  double squares_ = 0.0;
};

/// One proposal density, and the results of its jumps.
class Round {
 public:
  Round(Target& target, Chain& population, Rng& rng)
      : target_(target),
        population_(population),
        rng_(rng),
        fitted_(fit_mixture(population.draws, kHillsMax, rng)),
        proposal_(widen(fitted_)),
        at_particle_(population.draws.rows()),
        point_(population.draws.cols()) {
    for (Eigen::Index i = 0; i < at_particle_.size(); ++i) {
      point_ = population.draws.row(i);
      at_particle_(i) = proposal_.log_density(point_);
    }
  }

  /// Each particle tries one jump.
  Result<void> sweep() {
    for (Eigen::Index i = 0; i < at_particle_.size(); ++i) {
      proposal_.draw(rng_, point_);
      const auto density = TRY(target_.log_density(point_));
      const double at_point = proposal_.log_density(point_);
      ++tried_;
      weights_.add(density - at_point);
      const double log_ratio = density - population_.log_density(i) + at_particle_(i) - at_point;
      if (!(std::log(rng_.uniform()) < log_ratio)) continue;
      population_.draws.row(i) = point_;
      population_.log_density(i) = density;
      at_particle_(i) = at_point;
      ++accepted_;
    }
    return {};
  }

  [[nodiscard]] bool has_jumped_enough() const {
    return accepted_ >= kJumpsEnough * at_particle_.size();
  }
  [[nodiscard]] bool has_one_hill() const { return fitted_.components().size() == 1; }
  [[nodiscard]] const WeightSums& weights() const { return weights_; }
  [[nodiscard]] long tried() const { return tried_; }
  [[nodiscard]] double acceptance() const {
    return static_cast<double>(accepted_) / static_cast<double>(tried_);
  }

 private:
  Target& target_;
  Chain& population_;
  Rng& rng_;
  GaussianMixture fitted_;
  GaussianMixture proposal_;
  Eigen::VectorXd at_particle_;  ///< (n) log density of the proposal at each particle.
  Eigen::VectorXd point_;        ///< (d)
  WeightSums weights_;
  long accepted_ = 0;
  long tried_ = 0;
};

}  // namespace

Result<double> jump_between_modes(Target& target, Chain& population, Rng& rng, int sweeps_max,
                                  const SamplerObserver& observer) {
  double acceptance = 0.0;
  for (int r = 0; r < kRounds; ++r) {
    Round round(target, population, rng);
    for (int sweep = 1; sweep <= sweeps_max && !round.has_jumped_enough(); ++sweep) {
      TRY(round.sweep());
      if (observer && !observer(r * sweeps_max + sweep, kRounds * sweeps_max)) {
        return failure(ErrorCode::cancelled, "cancelled while jumping between modes, sweep " +
                                                 std::to_string(sweep) + " of round " +
                                                 std::to_string(r + 1));
      }
    }
    population.statistics.density_evaluations += round.tried();
    if (round.weights().effective_share() >= kEffectiveShareMin) {
      population.statistics.log_evidence = round.weights().log_mean();
    }
    acceptance = round.acceptance();
    if (round.has_one_hill()) break;
  }
  return acceptance;
}

}  // namespace recald::calibration
