/// The posterior density of calibration parameters and hyper-parameters given monthly figures.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/calibration/covariance/discrepancy.hpp"
#include "core/calibration/covariance/error_covariance.hpp"
#include "core/calibration/covariance/hyper_prior.hpp"
#include "core/calibration/posterior/normalisation.hpp"
#include "core/calibration/samplers/sampler.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// All measurements, on the normalised scale. m points: missing months have no point.
struct PosteriorData {
  std::vector<PointIndex> points;   ///< (m) ordered by output, then month.
  Eigen::VectorXd values;           ///< (m) measured.
  Eigen::VectorXd extra_variances;  ///< (m) >= 0: sigma_r^2 of the output plus v_i of the point.
  Eigen::MatrixXd month_inputs;     ///< (months x p) scaled to [0, 1].
  Eigen::MatrixXd common_errors;    ///< (m x directions) g: errors common to all points, 1 sd each.
  std::vector<OutputScale> scales;  ///< (outputs) convert model outputs to this scale.
  std::vector<double> weights;      ///< (outputs) in (0, 1].
  /// Where the weights' extra error is fixed; by default the prior means of the precisions and the
  /// prior median of rho.
  std::optional<Hyperparameters> weight_reference;
};

/// Sigma of the points, as described at `Posterior`, in the cheapest form that fits them.
[[nodiscard]] std::unique_ptr<ErrorCovariance> make_covariance(const PosteriorData& data,
                                                               const HyperPrior& prior);

/// Assembles and factorises Sigma, with a jitter of 1e-10 only after a first failure.
/// @param jittered  Whether jitter was needed.
/// @return whether there is a factor.
[[nodiscard]] bool factorise(ErrorCovariance& covariance, const Hyperparameters& hyper,
                             bool& jittered);

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
/// W reduces the influence of an output with weight w < 1: it adds independent error (1/w - 1)
/// S_t to the block of that output, where S_t is its block of Sigma at fixed hyper-parameters. A
/// sum of covariances is valid for every w, and as w -> 0 the output drops out of the likelihood
/// up to a constant.
///
/// As a `Target` its coordinates are unconstrained, with the Jacobians included:
/// (z_1 … z_q, log lambda_delta, log lambda_epsilon, s_1 … s_S), where theta_j = F_j^-1(Phi(z_j)),
/// so that z_j is standard normal under the prior, and s is the score of rho
/// (`BetaPrior::at_score`). Without information in the data the density is a standard normal, which
/// suits both gradients and random walks best; a logistic coordinate would have exponential tails.
///
/// Evaluation does not allocate. Assembly and factorisation depend only on the hyper-parameters and
/// are reused while those stay the same, which leaves one triangular solve for a change of theta.
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
  /// @return the log density in unconstrained coordinates; minus infinity if Sigma has no factor
  ///         even with jitter; not_finite when the model gives a NaN or infinity.
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& point) override;
  [[nodiscard]] bool has_gradient() const override { return model_->has_jacobian(); }
  /// The gradient by eq. (7)'s derivatives and the chain rule through the coordinates.
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& point,
                                                        Eigen::VectorXd& gradient) override;
  [[nodiscard]] double log_prior(const Eigen::VectorXd& point) const override;
  [[nodiscard]] Eigen::VectorXd draw_start(Rng& rng) const override;

  /// The density with respect to the natural (theta, lambda_delta, lambda_epsilon, rho), in parts.
  [[nodiscard]] Result<LogDensityTerms> terms(std::span<const double> theta,
                                              const Hyperparameters& hyper);

  /// Assembles and factorises Sigma. Jitter of 1e-10 is added only after a first failure.
  /// @return whether there is a factor; call `log_likelihood` only then.
  [[nodiscard]] bool set_hyperparameters(const Hyperparameters& hyper);
  /// log p(y | theta, phi) of eq. (7), with all constants, at the current hyper-parameters.
  [[nodiscard]] Result<double> log_likelihood(std::span<const double> theta);
  /// As above, for given residuals y - f(theta) (m): one triangular solve.
  [[nodiscard]] double log_likelihood_of_residual(const Eigen::VectorXd& residual);
  /// y - f(theta) on the normalised scale (m), valid until the next call.
  [[nodiscard]] const Eigen::VectorXd& residual_at(std::span<const double> theta);
  /// Sigma^-1 at the current hyper-parameters. @param inverse  (m x m), already of that size.
  void precision(Eigen::MatrixXd& inverse) { covariance_->precision(inverse); }

  /// Natural values of a point in unconstrained coordinates; `theta` and `hyper` already sized.
  void to_natural(const Eigen::VectorXd& point, Eigen::Ref<Eigen::VectorXd> theta,
                  Hyperparameters& hyper) const;

  [[nodiscard]] Eigen::Index parameter_count() const;
  [[nodiscard]] Eigen::Index kernel_dimension() const { return kernel_dimension_; }
  [[nodiscard]] bool has_output_dimension() const { return has_output_dimension_; }
  [[nodiscard]] Eigen::Index point_count() const { return data_.values.size(); }
  [[nodiscard]] const PosteriorData& data() const { return data_; }
  [[nodiscard]] const std::vector<Parameter>& parameters() const { return parameters_; }
  [[nodiscard]] const HyperPrior& prior() const { return prior_; }
  /// Number of factorisations so far that needed jitter.
  [[nodiscard]] long jitter_count() const { return jitter_count_; }

 private:
  Posterior(const MonthlyModel& prototype, std::vector<Parameter> parameters, PosteriorData data,
            HyperPrior prior);

  /// Computes the natural values of the point in unconstrained coordinates, and the slopes of
  /// the coordinates.
  /// @return false if they cannot be represented as doubles; the density there is zero.
  [[nodiscard]] bool place(const Eigen::VectorXd& point);
  [[nodiscard]] bool factorise_here(const Eigen::VectorXd& point);
  void evaluate_residual(std::span<const double> theta, bool with_jacobian);
  [[nodiscard]] Result<double> finite_or_error(double value, std::span<const double> theta) const;

  std::unique_ptr<MonthlyModel> model_;
  std::vector<Parameter> parameters_;
  PosteriorData data_;
  HyperPrior prior_;
  double prior_constant_ = 0.0;  ///< Of all prior densities, in these coordinates.
  Eigen::Index kernel_dimension_;
  bool has_output_dimension_;
  std::unique_ptr<ErrorCovariance> covariance_;

  Eigen::VectorXd hyper_point_;  ///< Coordinates of the current factor.
  bool has_factor_ = false;
  long jitter_count_ = 0;
  double log_normaliser_ = 0.0;  ///< -1/2 log|Sigma| - m/2 log 2 pi

  Eigen::VectorXd theta_;           ///< Of the current point, as are the six below.
  Eigen::VectorXd theta_slope_;     ///< d theta_j / d z_j
  Eigen::VectorXd theta_gradient_;  ///< d log L / d theta_j
  Hyperparameters hyper_;
  Eigen::VectorXd beta_slope_;      ///< d beta_s / d score_s
  Eigen::VectorXd prior_gradient_;  ///< (dimension)
  double log_prior_ = 0.0;
  Eigen::VectorXd outputs_;      ///< (outputs * months) in units.
  Eigen::MatrixXd jacobian_;     ///< (outputs * months x q) in units.
  Eigen::VectorXd sensitivity_;  ///< (outputs * months) d log L / d outputs
  Eigen::VectorXd residual_;     ///< (m)
  LikelihoodGradient likelihood_gradient_;
};

}  // namespace recald::calibration
