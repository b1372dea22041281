/// A population of points that represents a density, and follows it as it changes.
///
/// The parts of sequential Monte Carlo. Tempering (`smc.hpp`) is one way to combine them; adding
/// the data month by month (IBIS, Chopin 2002) is another.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <functional>

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// n weighted points. Columns are in the order of their ancestors.
struct Particles {
  Eigen::MatrixXd positions;       ///< (d x n) one column per particle.
  Eigen::VectorXd log_prior;       ///< (n)
  Eigen::VectorXd log_likelihood;  ///< (n) log density minus log prior.
  Eigen::VectorXd log_weight;      ///< (n) up to a constant common to all.

  [[nodiscard]] Eigen::Index count() const { return positions.cols(); }
};

/// `count` draws from the prior with equal weights. One evaluation each.
/// @return an error of the target. @pre count >= 2
[[nodiscard]] Result<Particles> draw_particles(Target& target, int count, Rng& rng);

/// (sum w)^2 / sum w^2: the number of equally weighted points that the weighted ones are worth; 0
/// when no weight is positive.
[[nodiscard]] double effective_count(const Eigen::VectorXd& log_weight);

/// Weighted covariance (d x d).
[[nodiscard]] Eigen::MatrixXd covariance(const Particles& particles);

/// Systematic resampling (one random number, comb of n teeth); weights are equal afterwards.
///
/// Keeps the order, so that copies of one ancestor stay adjacent. An effective size computed from
/// the autocorrelation along the columns then accounts for them.
/// @pre some weight is positive
void resample(Particles& particles, Rng& rng);

/// Metropolis moves of all particles at once.
class ParticleMover {
 public:
  struct Options {
    int sweeps_min = 3;
    int sweeps_max = 20;
    /// Particles have moved enough when no coordinate's correlation with its origin is larger.
    double correlation_max = 0.3;
  };

  ParticleMover(Target& target, Rng& rng, Eigen::Index count, Options options);

  /// The random walk's shape: 2.38^2 / d times `covariance`. @return not_positive_definite
  [[nodiscard]] Result<void> set_shape(const Eigen::MatrixXd& covariance);

  /// One sweep: every particle proposes one normal step and accepts it with respect to log prior
  /// + temperature * log likelihood. Then the scale is adapted towards an acceptance of 0.27.
  /// Does not allocate.
  /// @return an error of the target.
  [[nodiscard]] Result<void> sweep(Particles& particles, double temperature,
                                   const std::function<bool()>& proceed = {});

  /// Sweeps until the particles have moved enough.
  /// @param proceed  Called within and after each sweep; false gives `cancelled`.
  [[nodiscard]] Result<void> move(Particles& particles, double temperature,
                                  const std::function<bool()>& proceed = {});

  [[nodiscard]] double acceptance_rate() const { return acceptance_rate_; }  ///< In the last sweep.
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] long evaluations() const { return evaluations_; }

 private:
  [[nodiscard]] Result<bool> move_one(Particles& particles, Eigen::Index i, double temperature);
  [[nodiscard]] bool has_moved_enough(const Particles& particles) const;

  Target& target_;
  Rng& rng_;
  Options options_;
  Eigen::LLT<Eigen::MatrixXd> shape_;
  double scale_ = 1.0;
  double acceptance_rate_ = 0.0;
  long evaluations_ = 0;
  Eigen::MatrixXd origins_;  ///< (d x n) positions of the particles before the first sweep.
  Eigen::VectorXd unit_;
  Eigen::VectorXd proposed_;
};

}  // namespace recald::calibration
