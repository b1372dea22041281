#include "core/calibration/samplers/smc.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/calibration/samplers/log_sum.hpp"

namespace recald::calibration {
namespace {

constexpr int kParticlesMin = 16;
constexpr int kTemperaturesMax = 200;

Result<void> check_population(const SamplerOptions& options) {
  if (options.iterations < kParticlesMin) {
    return failure(ErrorCode::invalid_value, "smc needs at least " + std::to_string(kParticlesMin) +
                                                 " particles, not " +
                                                 std::to_string(options.iterations));
  }
  if (options.burn_in != 0 || options.begin_at) {
    return failure(ErrorCode::invalid_value,
                   "smc starts from the prior and keeps every particle, so it accepts neither "
                   "burn-in nor an initial state");
  }
  return {};
}

Chain to_chain(const Particles& particles, const ParticleMover& mover, double log_evidence) {
  Chain chain;
  chain.draws = particles.positions.transpose();
  chain.log_density = particles.log_prior + particles.log_likelihood;
  chain.statistics.acceptance_rate = mover.acceptance_rate();
  chain.statistics.density_evaluations = particles.count() + mover.evaluations();
  chain.statistics.log_evidence = log_evidence;
  chain.last = {particles.positions.rightCols<1>(), mover.scale(), covariance(particles)};
  return chain;
}

}  // namespace

double next_temperature(const Particles& particles, double temperature, double share) {
  const Eigen::ArrayXd likelihoods = particles.log_likelihood.array();
  const double alive =
      (likelihoods > -std::numeric_limits<double>::infinity()).cast<double>().sum();
  const auto effective = [&](double rise) {
    // 0 times minus infinity is NaN, but the rise is never exactly 0.
    return effective_count(rise * likelihoods);
  };
  double high = 1.0 - temperature;
  if (effective(high) >= share * alive) return 1.0;
  double low = 0.0;
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (effective(middle) >= share * alive ? low : high) = middle;
  }
  return temperature + high;
}

Result<Chain> smc(Target& target, const SamplerOptions& options, Rng& rng,
                  const SamplerObserver& observer, const ParticleMover::Options& moves) {
  TRY(check_population(options));
  auto drawn = TRY(draw_particles(target, options.iterations, rng));
  Particles particles = std::move(drawn);
  if (!(particles.log_likelihood.maxCoeff() > -std::numeric_limits<double>::infinity())) {
    return failure(ErrorCode::not_finite, "none of " + std::to_string(options.iterations) +
                                              " particles drawn from the prior has a positive "
                                              "posterior density");
  }
  ParticleMover mover(target, rng, particles.count(), moves);
  double temperature = 0.0;
  double log_evidence = 0.0;
  const auto proceed = [&] {
    const int done = static_cast<int>(temperature * options.iterations);
    return !observer || observer(done, options.iterations);
  };
  for (int k = 0; temperature < 1.0; ++k) {
    if (k == kTemperaturesMax) {
      return failure(ErrorCode::out_of_range,
                     "the posterior is too narrow within its prior: after " + std::to_string(k) +
                         " temperatures smc is at " + std::to_string(temperature) +
                         "; tighten the priors or check the units of the measurements");
    }
    const double next = next_temperature(particles, temperature);
    particles.log_weight = (next - temperature) * particles.log_likelihood;
    log_evidence += log_sum(particles.log_weight) - std::log(options.iterations);
    temperature = next;
    TRY(mover.set_shape(covariance(particles)));
    resample(particles, rng);
    TRY(mover.move(particles, temperature, proceed));
  }
  return to_chain(particles, mover, log_evidence);
}

}  // namespace recald::calibration
