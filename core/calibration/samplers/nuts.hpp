/// The No-U-Turn sampler: Hamiltonian Monte Carlo that needs no tuning by hand.
#pragma once

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

struct NutsOptions {
  double target_acceptance = 0.8;     ///< In (0, 1); larger means shorter steps.
  int depth_max = 10;                 ///< Longest trajectory: 2^depth_max steps.
  double divergence_energy = 1000.0;  ///< A larger rise of H means that the integrator has failed.
};

/// Multinomial NUTS with a dense metric, for targets with a gradient.
/// One iteration is one trajectory (`TrajectorySampler`). The burn-in finds the step size by dual
/// averaging and the metric in windows (`warm_up.hpp`); both are frozen after it. A chain that
/// begins at a state uses the state's covariance as its metric and its scale as its step size, so a
/// burn-in of a hundred iterations is enough; with a burn-in of 0 it continues unchanged.
///
/// Points of zero or unknown density end a trajectory as a divergence and are never chosen.
///
/// @return the chain; unsupported for a target without gradient; invalid_value for invalid options
///         or state; not_positive_definite for a state's covariance; not_finite when there is no
///         valid starting point; an error of the target; cancelled. The observer is called after
///         every iteration.
[[nodiscard]] Result<Chain> nuts(Target& target, const SamplerOptions& options, Rng& rng,
                                 const SamplerObserver& observer = {},
                                 const NutsOptions& nuts_options = {});

}  // namespace recald::calibration
