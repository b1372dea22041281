/// The seed's sampler: random-walk Metropolis with uniform proposals.
#pragma once

#include "core/calibration/sampler.hpp"

namespace recald::calibration {

/// Random-walk Metropolis (the seed: uniform proposals, 30 000 iterations, 3 000 dropped).
///
/// One iteration is one proposal of all d coordinates at once:
///
///     z' = z + s L u,   u_j uniform on (-sqrt 3, sqrt 3),
///
/// uniform on a box in the coordinates that L whitens. The scale s and the shape L adapt during the
/// burn-in only, towards an acceptance rate of a quarter: near the optimum 0.234 for many
/// dimensions and still good for few. Both are frozen after it, so the kept draws are those of one
/// fixed reversible chain.
///  - s follows Robbins-Monro steps throughout.
///  - L starts from the spread of starting points. For half of the burn-in it follows robust
///  adaptive
///    Metropolis: from acceptance, not from the chain's own covariance, which would turn a chain
///    that has hardly moved yet into ever shorter steps. At one half and at five sixths it becomes
///    the factor of the covariance of the chain's latest stretch.
///
/// @see Vihola (2012), Stat. Comput. 22, "Robust adaptive Metropolis algorithm with coerced
/// acceptance
///      rate".
[[nodiscard]] Result<Chain> seed_rwm(Target& target, const SamplerOptions& options, Rng& rng,
                                     const SamplerObserver& observer = {});

}  // namespace recald::calibration
