#include "core/calibration/samplers/particles.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "core/calibration/samplers/log_sum.hpp"
#include "core/calibration/samplers/random_walk.hpp"

namespace recald::calibration {
namespace {

/// Correlation of two rows; 1 if either does not vary, since nothing has moved then.
template <class Row>
double correlation(const Row& a, const Row& b) {
  const double mean_a = a.mean();
  const double mean_b = b.mean();
  const double product = ((a.array() - mean_a) * (b.array() - mean_b)).sum();
  const double squares = (a.array() - mean_a).square().sum() * (b.array() - mean_b).square().sum();
  return squares > 0.0 ? product / std::sqrt(squares) : 1.0;
}

void copy_particle(Particles& particles, Eigen::Index from, Eigen::Index to) {
  particles.positions.col(to) = particles.positions.col(from);
  particles.log_prior(to) = particles.log_prior(from);
  particles.log_likelihood(to) = particles.log_likelihood(from);
}

/// The ancestor of each place, ascending: the comb's tooth i is at (i + u) / n.
std::vector<Eigen::Index> systematic_ancestors(const Eigen::VectorXd& log_weight, Rng& rng) {
  const Eigen::Index n = log_weight.size();
  const double log_total = log_sum(log_weight);
  assert(std::isfinite(log_total));
  const double u = rng.uniform();
  std::vector<Eigen::Index> ancestors(static_cast<std::size_t>(n));
  Eigen::Index ancestor = 0;
  double reached = std::exp(log_weight(0) - log_total) * static_cast<double>(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    while (reached < static_cast<double>(i) + u && ancestor + 1 < n) {
      ++ancestor;
      reached += std::exp(log_weight(ancestor) - log_total) * static_cast<double>(n);
    }
    ancestors[static_cast<std::size_t>(i)] = ancestor;
  }
  // Rounding may leave the last teeth beyond the last weight; their ancestor must have a
  // positive weight.
  while (std::isinf(log_weight(ancestors.back()))) --ancestors.back();
  for (std::size_t i = ancestors.size() - 1; i-- > 0;) {
    ancestors[i] = std::min(ancestors[i], ancestors.back());
  }
  return ancestors;
}

}  // namespace

Result<Particles> draw_particles(Target& target, int count, Rng& rng) {
  assert(count >= 2);
  Particles particles{Eigen::MatrixXd(target.dimension(), count), Eigen::VectorXd(count),
                      Eigen::VectorXd(count), Eigen::VectorXd::Zero(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd position = target.draw_start(rng);
    const auto value = TRY(target.log_density(position));
    particles.positions.col(i) = position;
    particles.log_prior(i) = target.log_prior(position);
    particles.log_likelihood(i) = std::isnan(value) ? -std::numeric_limits<double>::infinity()
                                                    : value - particles.log_prior(i);
  }
  return particles;
}

double effective_count(const Eigen::VectorXd& log_weight) {
  const double log_total = log_sum(log_weight);
  if (std::isinf(log_total)) return 0.0;
  return std::exp(2.0 * log_total - log_sum(2.0 * log_weight.array()));
}

Eigen::MatrixXd covariance(const Particles& particles) {
  const Eigen::VectorXd weights =
      (particles.log_weight.array() - log_sum(particles.log_weight)).exp();
  const Eigen::VectorXd mean = particles.positions * weights;
  const Eigen::MatrixXd centred = particles.positions.colwise() - mean;
  return centred * weights.asDiagonal() * centred.transpose();
}

void resample(Particles& particles, Rng& rng) {
  const std::vector<Eigen::Index> ancestors = systematic_ancestors(particles.log_weight, rng);
  // In place: ancestors ascend, so a source to the right of its place is not yet overwritten when
  // places are filled from the left, and one to the left when they are filled from the right.
  const auto ancestor = [&](Eigen::Index i) { return ancestors[static_cast<std::size_t>(i)]; };
  for (Eigen::Index i = 0; i < particles.count(); ++i) {
    if (ancestor(i) > i) copy_particle(particles, ancestor(i), i);
  }
  for (Eigen::Index i = particles.count(); i-- > 0;) {
    if (ancestor(i) < i) copy_particle(particles, ancestor(i), i);
  }
  particles.log_weight.setZero();
}

ParticleMover::ParticleMover(Target& target, Rng& rng, Eigen::Index count, Options options)
    : target_(target),
      rng_(rng),
      options_(options),
      origins_(target.dimension(), count),
      unit_(target.dimension()),
      proposed_(target.dimension()) {}

Result<void> ParticleMover::set_shape(const Eigen::MatrixXd& covariance) {
  shape_.compute(2.38 * 2.38 / static_cast<double>(covariance.rows()) * covariance);
  if (shape_.info() == Eigen::Success && covariance.allFinite()) return {};
  return failure(ErrorCode::not_positive_definite,
                 "the population has too few distinct points left; use more particles");
}

Result<bool> ParticleMover::move_one(Particles& particles, Eigen::Index i, double temperature) {
  for (double& u : unit_) u = rng_.normal();
  proposed_.noalias() = shape_.matrixL() * unit_;
  proposed_ = particles.positions.col(i) + scale_ * proposed_;
  const auto value = TRY(target_.log_density(proposed_));
  const double log_prior = target_.log_prior(proposed_);
  const double log_likelihood = value - log_prior;
  const double log_ratio = log_prior - particles.log_prior(i) +
                           temperature * (log_likelihood - particles.log_likelihood(i));
  if (!(rng_.uniform() < metropolis_probability(log_ratio))) return false;
  particles.positions.col(i) = proposed_;
  particles.log_prior(i) = log_prior;
  particles.log_likelihood(i) = log_likelihood;
  return true;
}

Result<void> ParticleMover::sweep(Particles& particles, double temperature,
                                  const std::function<bool()>& proceed) {
  constexpr double target_acceptance = 0.27;
  constexpr Eigen::Index asked_every = 8;  // an hourly model takes a while
  Eigen::Index accepted = 0;
  for (Eigen::Index i = 0; i < particles.count(); ++i) {
    if (proceed && i % asked_every == asked_every - 1 && !proceed()) {
      return failure(ErrorCode::cancelled, "cancelled in the middle of a sweep");
    }
    const auto moved = TRY(move_one(particles, i, temperature));
    accepted += moved ? 1 : 0;
  }
  evaluations_ += particles.count();
  acceptance_rate_ = static_cast<double>(accepted) / static_cast<double>(particles.count());
  // The rate is over thousands of proposals, so the step may be bold.
  scale_ *= std::exp(1.5 * (acceptance_rate_ - target_acceptance));
  return {};
}

Result<void> ParticleMover::move(Particles& particles, double temperature,
                                 const std::function<bool()>& proceed) {
  origins_ = particles.positions;
  for (int sweeps = 1; sweeps <= options_.sweeps_max; ++sweeps) {
    if (auto swept = sweep(particles, temperature, proceed); !swept) return swept;
    if (proceed && !proceed()) return failure(ErrorCode::cancelled, "cancelled between two sweeps");
    if (sweeps >= options_.sweeps_min && has_moved_enough(particles)) break;
  }
  return {};
}

bool ParticleMover::has_moved_enough(const Particles& particles) const {
  for (Eigen::Index j = 0; j < origins_.rows(); ++j) {
    const auto before = origins_.row(j);
    const auto now = particles.positions.row(j);
    if (correlation(before, now) > options_.correlation_max) return false;
  }
  return true;
}

}  // namespace recald::calibration
