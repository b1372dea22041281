/// Tempered sequential Monte Carlo: from the prior to the posterior, with the evidence.
#pragma once

#include "core/calibration/particles.hpp"
#include "core/calibration/sampler.hpp"

namespace recald::calibration {

/// A population drawn from the prior is led to the density through
///
///     p_t(z) = prior(z) * likelihood(z)^t,   0 = t_0 < t_1 < … < t_T = 1,
///
/// each t as large as leaves half of the population effective (bisection). At each the particles
/// are weighted with likelihood^(t_k - t_(k-1)), resampled, and moved by random-walk Metropolis
/// with the population's own covariance until they have forgotten where they were copied from
/// (`ParticleMover`). It begins everywhere the prior has mass, so separate modes keep their
/// weights; the product of the mean weights estimates the evidence.
///
/// `options.iterations` is the number of particles, all of them kept; there is no burn-in and no
/// chain to continue. One call is one population: several, from different generators, are to each
/// other as chains are, and R-hat between them tells whether the particles were enough.
///
/// Rows of `Chain.draws` are in the order of their ancestors, so relatives stand side by side:
/// effective draws counted along the rows count kinship. `Chain.last` holds the covariance of the
/// population, the scale of its last moves and its last particle.
///
/// @return the population; invalid_value for fewer than 16 particles, a burn-in or a state to begin
///         at; not_finite when no draw from the prior has a positive density; out_of_range when the
///         posterior is too narrow to be reached in 200 temperatures; not_positive_definite for a
///         population that has collapsed; an error of the target; cancelled.
/// @see   Del Moral, Doucet, Jasra (2006), J. R. Stat. Soc. B 68(3); Jasra, Stephens, Doucet,
///        Tsagaris (2011), Scand. J. Stat. 38(1) for the choice of t.
/// @note  The observer is told of particles times t after every sweep; early temperatures are
/// small.
[[nodiscard]] Result<Chain> smc(Target& target, const SamplerOptions& options, Rng& rng,
                                const SamplerObserver& observer = {},
                                const ParticleMover::Options& moves = {});

/// The next temperature: the largest at most 1 that leaves `share` of those particles effective
/// that have a positive likelihood at all. Weights are taken as equal.
[[nodiscard]] double next_temperature(const Particles& particles, double temperature,
                                      double share = 0.5);

}  // namespace recald::calibration
