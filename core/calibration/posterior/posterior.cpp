#include "core/calibration/posterior/posterior.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/absent.hpp"
#include "core/design/model_runs.hpp"

namespace recald::calibration {
namespace {

constexpr double kJitter = 1e-10;
constexpr double kMinusInfinity = -std::numeric_limits<double>::infinity();
const double kLogTwoPi = std::log(2.0 * std::numbers::pi);

std::span<const double> as_span(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

Hyperparameters default_reference(const HyperPrior& prior, Eigen::Index dimension) {
  const double beta = beta_from_logit(prior.rho.logit_quantile(0.5));
  return {prior.discrepancy_precision.mean(), prior.error_precision.mean(),
          Eigen::VectorXd::Constant(dimension, beta)};
}

bool any_weight(const PosteriorData& data) {
  return std::any_of(data.weights.begin(), data.weights.end(), [](double w) { return w < 1.0; });
}

/// (1/w - 1) S_t of every output with reduced weight, lower triangle, added to `fixed`.
void add_weights(const PosteriorData& data, const HyperPrior& prior, DiscrepancyKernel kernel,
                 Eigen::MatrixXd& fixed) {
  const Hyperparameters at =
      data.weight_reference.value_or(default_reference(prior, kernel.dimension()));
  Eigen::MatrixXd sigma = fixed;
  Eigen::MatrixXd discrepancy = Eigen::MatrixXd::Zero(fixed.rows(), fixed.cols());
  kernel.covariance(1.0 / at.discrepancy_precision, at.beta, discrepancy);
  sigma += discrepancy;
  sigma.diagonal().array() += 1.0 / at.error_precision;
  for (Eigen::Index j = 0; j < fixed.cols(); ++j) {
    const int output = data.points[static_cast<std::size_t>(j)].output;
    const double weight = data.weights[static_cast<std::size_t>(output)];
    assert(weight > 0.0 && weight <= 1.0);
    for (Eigen::Index i = j; i < fixed.rows(); ++i) {
      if (data.points[static_cast<std::size_t>(i)].output != output) break;
      fixed(i, j) += (1.0 / weight - 1.0) * sigma(i, j);
    }
  }
}

double prior_constant(const HyperPrior& prior, Eigen::Index q, Eigen::Index kernel_dimension) {
  return -0.5 * static_cast<double>(q) * kLogTwoPi + prior.discrepancy_precision.log_constant() +
         prior.error_precision.log_constant() +
         static_cast<double>(kernel_dimension) * prior.rho.log_constant_of_score();
}

}  // namespace

std::unique_ptr<ErrorCovariance> make_covariance(const PosteriorData& data,
                                                 const HyperPrior& prior) {
  DiscrepancyKernel kernel(data.month_inputs, data.points);
  const Eigen::VectorXd& extra = data.extra_variances;
  if (kernel.is_complete() && !any_weight(data)) {
    const auto by_output =
        extra.reshaped(kernel.month_count(), kernel.output_count());  // points are in that order
    if ((by_output.colwise() - by_output.col(0)).isZero(0.0)) {
      const Eigen::VectorXd by_month = by_output.col(0);
      return make_decoupled_covariance(std::move(kernel), by_month, data.common_errors);
    }
  }
  Eigen::MatrixXd fixed(extra.asDiagonal());
  if (data.common_errors.cols() > 0) {
    fixed += data.common_errors * data.common_errors.transpose();
  }
  if (any_weight(data)) add_weights(data, prior, kernel, fixed);
  return make_dense_covariance(std::move(kernel), std::move(fixed));
}

bool factorise(ErrorCovariance& covariance, const Hyperparameters& hyper, bool& jittered) {
  const auto has_factor = [&](double jitter) {
    return covariance.factorise(hyper, jitter) &&
           std::isfinite(covariance.log_determinant());  // Eigen accepts a NaN
  };
  jittered = false;
  if (has_factor(0.0)) return true;
  jittered = true;
  return has_factor(kJitter);
}

Posterior::Posterior(const MonthlyModel& prototype, std::vector<Parameter> parameters,
                     PosteriorData data, HyperPrior prior)
    : model_(prototype.clone()),
      parameters_(std::move(parameters)),
      data_(std::move(data)),
      prior_(std::move(prior)) {
  const DiscrepancyKernel kernel(data_.month_inputs, data_.points);
  kernel_dimension_ = kernel.dimension();
  has_output_dimension_ = kernel.has_output_dimension();
  const Eigen::Index m = point_count();
  const Eigen::Index q = parameter_count();
  assert(data_.extra_variances.size() == m && kernel.point_count() == m);
  assert(parameters_.size() == static_cast<std::size_t>(model_->parameter_count()));
  assert(data_.scales.size() == static_cast<std::size_t>(model_->output_count()));
  assert(data_.weights.size() == data_.scales.size());
  assert(data_.common_errors.rows() == m || data_.common_errors.cols() == 0);
  covariance_ = make_covariance(data_, prior_);
  prior_constant_ = prior_constant(prior_, q, kernel_dimension_);
  hyper_point_.setConstant(2 + kernel_dimension_, kAbsent);
  theta_.setZero(q);
  theta_slope_.setZero(q);
  theta_gradient_.setZero(q);
  hyper_ = {0.0, 0.0, Eigen::VectorXd::Zero(kernel_dimension_)};
  beta_slope_.setZero(kernel_dimension_);
  prior_gradient_.setZero(dimension());
  outputs_.setZero(Eigen::Index{model_->output_count()} * model_->month_count());
  jacobian_.setZero(model_->has_jacobian() ? outputs_.size() : 0, q);
  sensitivity_.setZero(outputs_.size());
  residual_.setZero(m);
  likelihood_gradient_ = {Eigen::VectorXd::Zero(m), 0.0, 0.0,
                          Eigen::VectorXd::Zero(kernel_dimension_)};
}

Posterior::Posterior(const Posterior& other)
    : Posterior(*other.model_, other.parameters_, other.data_, other.prior_) {}

Result<Posterior> Posterior::make(const MonthlyModel& prototype, std::vector<Parameter> parameters,
                                  PosteriorData data, HyperPrior prior) {
  Posterior posterior(prototype, std::move(parameters), std::move(data), std::move(prior));
  if (!posterior.set_hyperparameters(
          default_reference(posterior.prior_, posterior.kernel_dimension_))) {
    return failure(
        ErrorCode::not_positive_definite,
        "the covariance of the measured points has no Cholesky factor at the prior means "
        "of its hyper-parameters; check the extra variances, the common errors and the "
        "hyper-prior for extreme values");
  }
  return posterior;
}

bool Posterior::set_hyperparameters(const Hyperparameters& hyper) {
  hyper_point_(0) = kAbsent;  // equal to no point
  bool jittered = false;
  has_factor_ = factorise(*covariance_, hyper, jittered);
  if (jittered) ++jitter_count_;
  if (has_factor_) {
    log_normaliser_ =
        -0.5 * (covariance_->log_determinant() + static_cast<double>(point_count()) * kLogTwoPi);
  }
  return has_factor_;
}

double Posterior::log_likelihood_of_residual(const Eigen::VectorXd& residual) {
  assert(has_factor_ && residual.size() == point_count());
  return log_normaliser_ - 0.5 * covariance_->squared_norm(residual);  // eq. (7)
}

void Posterior::evaluate_residual(std::span<const double> theta, bool with_jacobian) {
  const std::span<double> outputs(outputs_.data(), static_cast<std::size_t>(outputs_.size()));
  if (with_jacobian) {
    model_->evaluate_with_jacobian(theta, outputs,
                                   {jacobian_.data(), static_cast<std::size_t>(jacobian_.size())});
  } else {
    model_->evaluate(theta, outputs);
  }
  const int months = model_->month_count();
  for (Eigen::Index i = 0; i < point_count(); ++i) {
    const PointIndex& point = data_.points[static_cast<std::size_t>(i)];
    const OutputScale& scale = data_.scales[static_cast<std::size_t>(point.output)];
    residual_(i) = data_.values(i) - scale.normalise(outputs_(point.output * months + point.month));
  }
}

const Eigen::VectorXd& Posterior::residual_at(std::span<const double> theta) {
  evaluate_residual(theta, false);
  return residual_;
}

Result<double> Posterior::finite_or_error(double value, std::span<const double> theta) const {
  if (std::isfinite(value)) return value;
  TRY(design::check_finite(parameters_, theta, as_span(outputs_), model_->month_count()));
  return kMinusInfinity;
}

Result<double> Posterior::log_likelihood(std::span<const double> theta) {
  evaluate_residual(theta, false);
  return finite_or_error(log_likelihood_of_residual(residual_), theta);
}

Result<LogDensityTerms> Posterior::terms(std::span<const double> theta,
                                         const Hyperparameters& hyper) {
  LogDensityTerms terms{kMinusInfinity, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    terms.theta += std::log(parameters_[j].prior.density(theta[j]));
  }
  terms.discrepancy_precision =
      prior_.discrepancy_precision.log_density(hyper.discrepancy_precision);
  terms.error_precision = prior_.error_precision.log_density(hyper.error_precision);
  for (const double beta : hyper.beta) {
    terms.rho += prior_.rho.log_density_at_logit(logit_from_beta(beta));
  }
  if (!set_hyperparameters(hyper)) return terms;
  terms.log_likelihood = TRY(log_likelihood(theta));
  return terms;
}

void Posterior::to_natural(const Eigen::VectorXd& point, Eigen::Ref<Eigen::VectorXd> theta,
                           Hyperparameters& hyper) const {
  const Eigen::Index q = parameter_count();
  for (Eigen::Index j = 0; j < q; ++j) {
    theta(j) = parameters_[static_cast<std::size_t>(j)].prior.at_score(point(j)).value;
  }
  hyper.discrepancy_precision = std::exp(point(q));
  hyper.error_precision = std::exp(point(q + 1));
  for (Eigen::Index s = 0; s < kernel_dimension_; ++s) {
    hyper.beta(s) = prior_.rho.at_score(point(q + 2 + s)).beta;
  }
}

double Posterior::log_prior(const Eigen::VectorXd& point) const {
  const Eigen::Index q = parameter_count();
  double sum = prior_constant_ - 0.5 * point.head(q).squaredNorm();
  // The Jacobian of lambda = exp(l) is lambda: + l.
  sum += prior_.discrepancy_precision.log_kernel(std::exp(point(q)), point(q)) + point(q);
  sum += prior_.error_precision.log_kernel(std::exp(point(q + 1)), point(q + 1)) + point(q + 1);
  for (Eigen::Index s = 0; s < kernel_dimension_; ++s) {
    if (!(std::abs(point(q + 2 + s)) <= kScoreMax)) return kMinusInfinity;
    sum += prior_.rho.at_score(point(q + 2 + s)).log_density;
  }
  return sum;
}

bool Posterior::place(const Eigen::VectorXd& point) {
  assert(point.size() == dimension());
  const Eigen::Index q = parameter_count();
  for (Eigen::Index j = 0; j < q; ++j) {
    if (!(std::abs(point(j)) <= kScoreMax)) return false;
    const auto at = parameters_[static_cast<std::size_t>(j)].prior.at_score(point(j));
    theta_(j) = at.value;
    theta_slope_(j) = at.derivative;
    prior_gradient_(j) = -point(j);
  }
  log_prior_ = prior_constant_ - 0.5 * point.head(q).squaredNorm();

  const auto precision = [&](const GammaPrior& prior, Eigen::Index i, double& lambda) {
    lambda = std::exp(point(i));
    log_prior_ += prior.log_kernel(lambda, point(i)) + point(i);
    prior_gradient_(i) = prior.shape - prior.rate * lambda;
  };
  precision(prior_.discrepancy_precision, q, hyper_.discrepancy_precision);
  precision(prior_.error_precision, q + 1, hyper_.error_precision);
  for (Eigen::Index s = 0; s < kernel_dimension_; ++s) {
    const double score = point(q + 2 + s);
    if (!(std::abs(score) <= kScoreMax)) return false;
    const ScoredBeta at = prior_.rho.at_score(score);
    hyper_.beta(s) = at.beta;
    beta_slope_(s) = at.derivative;
    log_prior_ += at.log_density;
    prior_gradient_(q + 2 + s) = at.density_derivative;
  }
  // exp() may underflow; an infinite variance has no density either.
  return std::isfinite(log_prior_) && hyper_.discrepancy_precision > 0.0 &&
         hyper_.error_precision > 0.0;
}

bool Posterior::factorise_here(const Eigen::VectorXd& point) {
  const auto hyper_point = point.tail(hyper_point_.size());
  if (hyper_point_ != hyper_point) {
    (void)set_hyperparameters(hyper_);
    hyper_point_ = hyper_point;
  }
  return has_factor_;
}

Result<double> Posterior::log_density(const Eigen::VectorXd& point) {
  if (!place(point) || !factorise_here(point)) return kMinusInfinity;
  auto value = log_likelihood(as_span(theta_));
  if (value) *value += log_prior_;
  return value;
}

Result<double> Posterior::log_density_and_gradient(const Eigen::VectorXd& point,
                                                   Eigen::VectorXd& gradient) {
  assert(has_gradient() && gradient.size() == dimension());
  if (!place(point) || !factorise_here(point)) return kMinusInfinity;
  evaluate_residual(as_span(theta_), true);
  const double norm = covariance_->squared_norm_and_gradient(residual_, likelihood_gradient_);

  const int months = model_->month_count();
  for (Eigen::Index i = 0; i < point_count(); ++i) {
    const PointIndex& p = data_.points[static_cast<std::size_t>(i)];
    const OutputScale& scale = data_.scales[static_cast<std::size_t>(p.output)];
    sensitivity_(p.output * months + p.month) =
        likelihood_gradient_.weighted_residual(i) / scale.range();
  }
  const Eigen::Index q = parameter_count();
  gradient = prior_gradient_;
  theta_gradient_.noalias() = jacobian_.transpose() * sensitivity_;
  gradient.head(q).array() += theta_gradient_.array() * theta_slope_.array();
  gradient(q) += likelihood_gradient_.log_discrepancy_precision;
  gradient(q + 1) += likelihood_gradient_.log_error_precision;
  gradient.tail(kernel_dimension_).array() +=
      likelihood_gradient_.beta.array() * beta_slope_.array();

  auto value = finite_or_error(log_normaliser_ - 0.5 * norm, as_span(theta_));
  if (value) *value += log_prior_;
  return value;
}

Eigen::VectorXd Posterior::draw_start(Rng& rng) const {
  const Eigen::Index q = parameter_count();
  Eigen::VectorXd point(dimension());
  for (Eigen::Index j = 0; j < q; ++j) point(j) = rng.normal();
  point(q) = std::log(prior_.discrepancy_precision.quantile(rng.uniform()));
  point(q + 1) = std::log(prior_.error_precision.quantile(rng.uniform()));
  for (Eigen::Index s = 0; s < kernel_dimension_; ++s) {
    point(q + 2 + s) = prior_.rho.score_quantile(rng.uniform());
  }
  return point;
}

Eigen::Index Posterior::dimension() const { return parameter_count() + 2 + kernel_dimension_; }

Eigen::Index Posterior::parameter_count() const {
  return static_cast<Eigen::Index>(parameters_.size());
}

}  // namespace recald::calibration
