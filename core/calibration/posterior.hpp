/// The posterior density of calibration parameters and hyper-parameters given monthly figures.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/calibration/discrepancy.hpp"
#include "core/calibration/hyper_prior.hpp"
#include "core/calibration/normalisation.hpp"
#include "core/calibration/sampler.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// Everything measured, on the normalised scale. m points: missing months are simply not there.
struct PosteriorData {
  std::vector<PointIndex> points;   ///< (m) ordered by output, then month.
  Eigen::VectorXd values;           ///< (m) measured.
  Eigen::VectorXd extra_variances;  ///< (m) >= 0: sigma_r^2 of the output plus v_i of the point.
  Eigen::MatrixXd month_inputs;     ///< (months x p) scaled to [0, 1].
  Eigen::MatrixXd common_errors;    ///< (m x directions) g: errors common to all points, 1 sd each.
  std::vector<OutputScale> scales;  ///< (outputs) bring model outputs to this scale.
  std::vector<double> weights;      ///< (outputs) in (0, 1].
  /// Where the weights' extra error is fixed; by default the prior means of the precisions and the
  /// prior median of rho.
  std::optional<Hyperparameters> weight_reference;
};

/// The parts of a log density, each with all its constants.
struct LogDensityTerms {
  double log_likelihood;
  double theta;                  ///< Triangular densities.
  double discrepancy_precision;  ///< Gamma density.
  double error_precision;        ///< Gamma density.
  double rho;                    ///< Beta densities with respect to rho.

  [[nodiscard]] double sum() const {
    return log_likelihood + theta + discrepancy_precision + error_precision + rho;
  }
};

/// p(theta, phi | y) of eq. (6) of the seed, up to p(y), with y ~ N(f(theta), Sigma), eqs. (3)-(7):
///
///     Sigma = C(lambda_delta, beta) + diag(1/lambda_epsilon + extra variances) + g g' + W
///
/// W makes an output of weight w < 1 count for less: independent extra error (1/w - 1) S_t for the
/// block of that output, S_t being its block of Sigma at fixed hyper-parameters. A sum of
/// covariances, hence valid for every w, and as w -> 0 the output drops out of the likelihood up to
/// a constant.
///
/// As a `Target` its coordinates are unconstrained, with the Jacobians included:
/// (z_1 … z_q, log lambda_delta, log lambda_epsilon, logit rho_1 … logit rho_S), where
/// theta_j = F_j^-1(1 / (1 + exp(-z_j))), so that z_j is standard logistic under the prior.
///
/// Evaluation does not allocate. Assembly and factorisation depend on the hyper-parameters alone
/// and are kept while those stay the same, which leaves one triangular solve for a change of theta.
class Posterior final : public Target {
 public:
  /// @param prototype   Cloned.
  /// @param parameters  (q) in the model's order.
  /// @return the posterior, or not_positive_definite when the fixed part of Sigma has no factor.
  /// @pre shapes agree; 0 < weight <= 1; at least one point.
  static Result<Posterior> make(const MonthlyModel& prototype, std::vector<Parameter> parameters,
                                PosteriorData data, HyperPrior prior);

  Posterior(const Posterior& other);
  Posterior(Posterior&&) noexcept = default;
  Posterior& operator=(const Posterior&) = delete;
  Posterior& operator=(Posterior&&) noexcept = default;
  ~Posterior() override = default;

  [[nodiscard]] Eigen::Index dimension() const override;
  /// @return the log density in unconstrained coordinates; minus infinity where Sigma has no factor
  ///         even with jitter; not_finite when the model gives a NaN or infinity.
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& point) override;
  [[nodiscard]] Eigen::VectorXd draw_start(Rng& rng) const override;

  /// The density with respect to the natural (theta, lambda_delta, lambda_epsilon, rho), in parts.
  [[nodiscard]] Result<LogDensityTerms> terms(std::span<const double> theta,
                                              const Hyperparameters& hyper);

  /// Assembles and factorises Sigma. Jitter of 1e-10 is added only after a first failure.
  /// @return whether there is a factor; `log_likelihood` may be asked only then.
  [[nodiscard]] bool set_hyperparameters(const Hyperparameters& hyper);
  /// log p(y | theta, phi) of eq. (7), full constant, at the hyper-parameters set last.
  [[nodiscard]] Result<double> log_likelihood(std::span<const double> theta);
  /// The same of given residuals y - f(theta) (m): one triangular solve.
  [[nodiscard]] double log_likelihood_of_residual(const Eigen::VectorXd& residual);

  /// Natural values of a point in unconstrained coordinates; `theta` and `hyper` already sized.
  void to_natural(const Eigen::VectorXd& point, Eigen::Ref<Eigen::VectorXd> theta,
                  Hyperparameters& hyper) const;

  [[nodiscard]] Eigen::Index parameter_count() const;
  [[nodiscard]] Eigen::Index kernel_dimension() const { return kernel_.dimension(); }
  [[nodiscard]] bool has_output_dimension() const { return kernel_.has_output_dimension(); }
  [[nodiscard]] Eigen::Index point_count() const { return kernel_.point_count(); }
  /// Factorisations so far that needed jitter.
  [[nodiscard]] long jitter_count() const { return jitter_count_; }

 private:
  Posterior(const MonthlyModel& prototype, std::vector<Parameter> parameters, PosteriorData data,
            HyperPrior prior);

  void add_weights();
  void assemble(double jitter);
  [[nodiscard]] bool factorise();
  [[nodiscard]] double log_prior_unconstrained(const Eigen::VectorXd& point) const;

  std::unique_ptr<MonthlyModel> model_;
  std::vector<Parameter> parameters_;
  PosteriorData data_;
  HyperPrior prior_;
  double prior_constant_ = 0.0;  ///< Of the hyper-prior densities.
  DiscrepancyKernel kernel_;
  Eigen::MatrixXd fixed_;  ///< (m x m) what of Sigma no hyper-parameter changes; lower triangle.

  Hyperparameters hyper_;  ///< At which `factor_` stands.
  Eigen::VectorXd
      hyper_point_;  ///< The same as unconstrained coordinates, to see whether they moved.
  Hyperparameters next_hyper_;  ///< Room for those of the point being evaluated.
  bool has_factor_ = false;
  long jitter_count_ = 0;
  double log_normaliser_ = 0.0;  ///< -1/2 log|Sigma| - m/2 log 2 pi
  Eigen::MatrixXd factor_;       ///< (m x m) Sigma, then its Cholesky factor; lower triangle.
  Eigen::VectorXd theta_;
  Eigen::VectorXd outputs_;   ///< (outputs * months) in units.
  Eigen::VectorXd residual_;  ///< (m)
  Eigen::VectorXd whitened_;  ///< (m)
};

}  // namespace recald::calibration
