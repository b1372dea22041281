/// Tempered sequential Monte Carlo: from the prior to the posterior, with the evidence.
#pragma once

#include "core/calibration/samplers/particles.hpp"
#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// Moves a population drawn from the prior to the density through
///
///     p_t(z) = prior(z) * likelihood(z)^t,   0 = t_0 < t_1 < … < t_T = 1,
///
/// with each t as large as possible while half of the population stays effective (bisection). At
/// each t the particles are weighted with likelihood^(t_k - t_(k-1)), resampled, and moved by
/// random-walk Metropolis with the population's own covariance until they no longer depend on their
/// origins (`ParticleMover`). The population starts wherever the prior has mass, so separate modes
/// keep their weights; the product of the mean weights estimates the evidence.
///
/// `options.iterations` is the number of particles, all of which are kept; there is no burn-in and
/// no chain to continue. One call makes one population. Several, from different generators, compare
/// like chains, and R-hat between them shows whether there were enough particles.
///
/// Rows of `Chain.draws` are in the order of their ancestors, so that copies of one ancestor are
/// adjacent and an effective size computed along the rows accounts for them. `Chain.last` holds the
/// covariance of the population, the scale of its last moves and its last particle.
///
/// @return the population; invalid_value for fewer than 16 particles, a burn-in or a state to begin
///         at; not_finite when no draw from the prior has a positive density; out_of_range when the
///         posterior is too narrow to be reached in 200 temperatures; not_positive_definite for a
///         collapsed population; an error of the target; cancelled.
/// @see   Del Moral, Doucet, Jasra (2006), J. R. Stat. Soc. B 68(3); Jasra, Stephens, Doucet,
///        Tsagaris (2011), Scand. J. Stat. 38(1) for the choice of t.
/// @note  The observer receives particles times t after every sweep; early temperatures are small.
[[nodiscard]] Result<Chain> smc(Target& target, const SamplerOptions& options, Rng& rng,
                                const SamplerObserver& observer = {},
                                const ParticleMover::Options& moves = {});

/// The next temperature: the largest, at most 1, that leaves `share` of the particles with positive
/// likelihood effective. Assumes equal weights.
[[nodiscard]] double next_temperature(const Particles& particles, double temperature,
                                      double share = 0.5);

}  // namespace recald::calibration
