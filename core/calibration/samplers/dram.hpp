/// Delayed-rejection adaptive Metropolis: a random walk that tries a shorter step
/// after a rejection.
#pragma once

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// Adaptive Metropolis with one stage of delayed rejection; needs no gradient.
///
/// One iteration proposes y1 = z + s L u1, u1 standard normal, and accepts it with a(z, y1) =
/// min(1, p(y1) / p(z)). If y1 is rejected it proposes y2 = z + g s L u2, shorter by the factor g,
/// and accepts that with
///
///     min(1, p(y2) q(y2, y1) (1 - a(y2, y1)) / (p(z) q(z, y1) (1 - a(z, y1)))),
///
/// where q(x, y1) is the density of y1 as a first proposal from x; the proposal of y2 is symmetric
/// and cancels. In units of L that ratio of q is exp(-(|u1 - g u2|^2 - |u1|^2) / 2), so no system
/// has to be solved. The long first step works where the density is wide, the second where it is
/// narrow: in tails, bends and at hard bounds fewer iterations get stuck than with a single scale.
///
/// s and L adapt during the burn-in only (`AdaptiveProposal`). An iteration costs one or two
/// evaluations of the density.
///
/// @see Haario, Laine, Mira, Saksman (2006), Stat. Comput. 16, "DRAM: Efficient adaptive MCMC",
///      eq. (3) for the second stage.
[[nodiscard]] Result<Chain> dram(Target& target, const SamplerOptions& options, Rng& rng,
                                 const SamplerObserver& observer = {});

}  // namespace recald::calibration
