#include "core/calibration/samplers/hamiltonian.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace recald::calibration {

Hamiltonian::Hamiltonian(Target& target)
    : target_(target),
      factor_(Eigen::MatrixXd::Identity(target.dimension(), target.dimension())),
      gradient_(target.dimension()) {}

void Hamiltonian::set_metric_factor(Eigen::MatrixXd factor) { factor_ = std::move(factor); }

Result<void> Hamiltonian::evaluate(PhasePoint& point) {
  ++gradient_evaluations_;
  point.log_density = TRY(target_.log_density_and_gradient(point.position, gradient_));
  point.force.noalias() = factor_.transpose() * gradient_;
  return {};
}

Result<void> Hamiltonian::leapfrog(PhasePoint& point, double step) {
  point.momentum += 0.5 * step * point.force;
  // A full product including the zeros of L: for a dozen dimensions faster than a triangular one.
  point.position.noalias() += step * factor_ * point.momentum;
  if (auto evaluated = evaluate(point); !evaluated) return evaluated;
  point.momentum += 0.5 * step * point.force;
  return {};
}

double Hamiltonian::energy(const PhasePoint& point) {
  const double energy = 0.5 * point.momentum.squaredNorm() - point.log_density;
  return std::isfinite(energy) ? energy : std::numeric_limits<double>::infinity();
}

}  // namespace recald::calibration
