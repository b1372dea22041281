/// The seed's sampler: random-walk Metropolis with uniform proposals.
#pragma once

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// Random-walk Metropolis (the seed: uniform proposals, 30 000 iterations, 3 000 dropped).
///
/// One iteration is one proposal of all d coordinates at once:
///
///     z' = z + s L u,   u_j uniform on (-sqrt 3, sqrt 3),
///
/// uniform on a box in the coordinates that L whitens. s and L adapt during the burn-in only
/// (`AdaptiveProposal`), towards an acceptance rate of a quarter: close to the optimum of 0.234 for
/// many dimensions and still good for few.
[[nodiscard]] Result<Chain> seed_rwm(Target& target, const SamplerOptions& options, Rng& rng,
                                     const SamplerObserver& observer = {});

}  // namespace recald::calibration
