/// Finds the step size of a Hamiltonian sampler.
#pragma once

#include "core/calibration/samplers/hamiltonian.hpp"
#include "core/random/rng.hpp"

namespace recald::calibration {

/// Nesterov's dual averaging on the log of the step, towards a mean acceptance.
///
///     log eps_t+1 = mu - sqrt(t) / gamma * H_t,   H_t = running mean of (target - acceptance)
///
/// with gamma = 0.05, t_0 = 10, kappa = 0.75; the final step is the weighted mean of log eps.
/// @see Hoffman, Gelman (2014), J. Mach. Learn. Res. 15, eq. (6) and algorithm 5.
class DualAveraging {
 public:
  explicit DualAveraging(double target_acceptance) : target_acceptance_(target_acceptance) {}

  /// Restarts around `step`; mu = log(10 step), because long steps are cheap to try.
  void restart(double step);
  /// @param acceptance  In [0, 1]. @return the step to try next.
  double update(double acceptance);
  /// The final step. @pre `update` was called since `restart`
  [[nodiscard]] double mean_step() const;

 private:
  double target_acceptance_;
  double mu_ = 0.0;
  double shortfall_ = 0.0;      // H_t
  double log_step_mean_ = 0.0;  // weighted mean of log eps
  double updates_ = 0.0;        // t
};

/// The step whose first acceptance crosses 0.8, found by doubling or halving from `step`, as a
/// start for dual averaging (ibid., algorithm 4, with Stan's threshold). `point` has its density
/// and force, and keeps them.
[[nodiscard]] Result<double> reasonable_step(Hamiltonian& hamiltonian, const PhasePoint& point,
                                             double step, Rng& rng);

}  // namespace recald::calibration
