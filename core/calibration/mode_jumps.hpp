/// Lets the particles of a population jump between the modes of a posterior.
#pragma once

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// Metropolis-Hastings with proposals that do not depend on a particle's position: draws from a
/// mixture of normal densities fitted to the population itself, one component per mode.
///
/// Tempering finds all modes that the prior covers, but the number of particles in each is settled
/// early, by few ancestors, while they can still move between modes. So the weight of a narrow
/// mode far out in the prior has a large variance. A jump between modes is accepted by their
/// densities, so the weights become those of the density, and the correlation between copies of
/// one ancestor disappears.
///
/// The proposals are also an importance sample of the density, and a much better one of its
/// integral than the product of tempering's mean weights: if they cover the density well enough (an
/// effective share of 2 %), their estimate replaces `statistics.log_evidence`.
///
/// A mixture with more than one component is fitted again to the moved particles, twice: a mode
/// that had too few particles is proposed too rarely to fill up at once.
///
/// @param population  As returned by `smc`; draws and log densities are replaced.
/// @param sweeps_max  Jumps tried by each particle in each of these rounds. Fewer are tried once
///                    each has jumped ten times on average, since most jumps land in the mode
///                    where they started.
/// @return the share of accepted jumps; an error of the target; cancelled.
/// @note   The proposal is fitted to the particles that it then moves. That is an adaptation, not a
///         Markov chain with a fixed kernel, and its error falls with the number of particles.
[[nodiscard]] Result<double> jump_between_modes(Target& target, Chain& population, Rng& rng,
                                                int sweeps_max = 60,
                                                const SamplerObserver& observer = {});

}  // namespace recald::calibration
