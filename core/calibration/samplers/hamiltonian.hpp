/// Motion of a point through a log density, as a particle through a potential.
#pragma once

#include <Eigen/Core>

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// A point with its momentum, and the density there.
struct PhasePoint {
  explicit PhasePoint(Eigen::Index d) : position(d), momentum(d), force(d) {}

  Eigen::VectorXd position;  ///< (d) in the target's coordinates.
  Eigen::VectorXd momentum;  ///< (d) whitened: standard normal.
  Eigen::VectorXd force;     ///< (d) whitened: L' times the gradient of the log density.
  double log_density = 0.0;
};

/// H = -log p(x) + |r|^2 / 2, with the dense inverse metric L L' absorbed into the momentum.
///
/// The usual momentum is p = L^-T r with energy p' (L L') p / 2 and velocity L L' p. In terms of r
/// the energy is |r|^2 / 2 and the velocity L r, so the inner products that decide on U-turns, p'
/// (L L') p', are plain ones.
class Hamiltonian {
 public:
  explicit Hamiltonian(Target& target);

  /// L, lower triangular. Existing points keep their old force: call `evaluate` again.
  void set_metric_factor(Eigen::MatrixXd factor);
  [[nodiscard]] const Eigen::MatrixXd& metric_factor() const { return factor_; }

  /// Computes log density and force at `point.position`. An error is the target's.
  [[nodiscard]] Result<void> evaluate(PhasePoint& point);

  /// One step of the Störmer-Verlet integrator; a negative step goes back in time. Does not
  /// allocate. Evaluates the gradient once.
  [[nodiscard]] Result<void> leapfrog(PhasePoint& point, double step);

  /// Infinite if the density is zero or unknown.
  [[nodiscard]] static double energy(const PhasePoint& point);

  [[nodiscard]] long gradient_evaluations() const { return gradient_evaluations_; }

 private:
  Target& target_;
  Eigen::MatrixXd factor_;    // L
  Eigen::VectorXd gradient_;  // in the target's coordinates
  long gradient_evaluations_ = 0;
};

}  // namespace recald::calibration
