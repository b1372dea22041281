/// Jumps between the hills of a posterior, for a population that knows where they are.
#pragma once

#include "core/calibration/sampler.hpp"

namespace recald::calibration {

/// Metropolis-Hastings with proposals that do not depend on where a particle stands: draws from a
/// mixture of normal densities fitted to the population itself, a hill a component.
///
/// Tempering finds all hills that the prior lets it see, but how many particles stand on each is
/// settled while they can still walk across, by few ancestors; a narrow hill far out in the prior
/// comes out with a weight of great variance. A jump from hill to hill is accepted by what both
/// are worth, so the weights become those of the density, and what was left of kinship goes.
///
/// @param population  As `smc` returns it; draws and log densities are replaced.
/// What was proposed is an importance sample of the density as well, and a much better one of its
/// integral than the product of tempering's mean weights: where the proposals cover the density
/// well enough (an effective share of 2 %), it replaces `statistics.log_evidence`.
///
/// Where the mixture has more than one hill it is fitted again to where the particles went, twice:
/// a hill that had too few particles is proposed too rarely to fill up at once.
///
/// @param sweeps_max  Of each of these rounds. Jumps tried by each particle. Fewer are tried once
/// each has jumped ten times
///                    on average: most jumps land on the hill they started from.
/// @return the share of accepted jumps; an error of the target; cancelled.
/// @note   The proposal is fitted to the particles that it then moves. That is an adaptation, not a
///         Markov chain with a fixed kernel, and its error falls with the number of particles.
[[nodiscard]] Result<double> jump_between_modes(Target& target, Chain& population, Rng& rng,
                                                int sweeps_max = 60,
                                                const SamplerObserver& observer = {});

}  // namespace recald::calibration
