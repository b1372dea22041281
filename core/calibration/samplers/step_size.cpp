#include "core/calibration/samplers/step_size.hpp"

#include <cmath>

namespace recald::calibration {

void DualAveraging::restart(double step) {
  mu_ = std::log(10.0 * step);
  shortfall_ = 0.0;
  log_step_mean_ = 0.0;
  updates_ = 0.0;
}

double DualAveraging::update(double acceptance) {
  constexpr double gamma = 0.05;
  constexpr double t_0 = 10.0;
  constexpr double kappa = 0.75;
  updates_ += 1.0;
  const double eta = 1.0 / (updates_ + t_0);
  shortfall_ += eta * (target_acceptance_ - acceptance - shortfall_);
  const double log_step = mu_ - shortfall_ * std::sqrt(updates_) / gamma;
  log_step_mean_ += std::pow(updates_, -kappa) * (log_step - log_step_mean_);
  return std::exp(log_step);
}

double DualAveraging::mean_step() const { return std::exp(log_step_mean_); }

Result<double> reasonable_step(Hamiltonian& hamiltonian, const PhasePoint& point, double step,
                               Rng& rng) {
  constexpr int doublings_max = 40;  // a flat density would go on forever
  const double log_threshold = std::log(0.8);
  PhasePoint trial = point;
  int direction = 0;
  for (int i = 0; i < doublings_max; ++i) {
    trial = point;
    for (double& r : trial.momentum) r = rng.normal();
    const double energy = Hamiltonian::energy(trial);
    TRY(hamiltonian.leapfrog(trial, step));
    const bool accepted = energy - Hamiltonian::energy(trial) > log_threshold;
    const int wanted = accepted ? 1 : -1;
    if (direction == 0) direction = wanted;
    if (wanted != direction) return step;
    step *= direction > 0 ? 2.0 : 0.5;
  }
  return step;
}

}  // namespace recald::calibration
