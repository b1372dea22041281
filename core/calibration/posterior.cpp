#include "core/calibration/posterior.hpp"

#include <Eigen/Cholesky>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/design/model_runs.hpp"

namespace recald::calibration {
namespace {

constexpr double kJitter = 1e-10;
constexpr double kMinusInfinity = -std::numeric_limits<double>::infinity();

std::span<const double> as_span(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

double logistic(double z) { return 1.0 / (1.0 + std::exp(-z)); }

Hyperparameters default_reference(const HyperPrior& prior, Eigen::Index dimension) {
  const double beta = beta_from_logit(prior.rho.logit_quantile(0.5));
  return {prior.discrepancy_precision.mean(), prior.error_precision.mean(),
          Eigen::VectorXd::Constant(dimension, beta)};
}

}  // namespace

Posterior::Posterior(const MonthlyModel& prototype, std::vector<Parameter> parameters,
                     PosteriorData data, HyperPrior prior)
    : model_(prototype.clone()),
      parameters_(std::move(parameters)),
      data_(std::move(data)),
      prior_(std::move(prior)),
      kernel_(data_.month_inputs, data_.points) {
  const Eigen::Index m = point_count();
  assert(data_.values.size() == m && data_.extra_variances.size() == m);
  assert(parameters_.size() == static_cast<std::size_t>(model_->parameter_count()));
  assert(data_.scales.size() == static_cast<std::size_t>(model_->output_count()));
  assert(data_.weights.size() == data_.scales.size());
  assert(data_.common_errors.rows() == m || data_.common_errors.cols() == 0);
  fixed_ = Eigen::MatrixXd(data_.extra_variances.asDiagonal());
  if (data_.common_errors.cols() > 0) {
    fixed_ += data_.common_errors * data_.common_errors.transpose();
  }
  hyper_.beta.setZero(kernel_.dimension());
  next_hyper_.beta.setZero(kernel_.dimension());
  hyper_point_.setConstant(2 + kernel_.dimension(), std::numeric_limits<double>::quiet_NaN());
  prior_constant_ = prior_.discrepancy_precision.log_constant() +
                    prior_.error_precision.log_constant() +
                    static_cast<double>(kernel_.dimension()) * prior_.rho.log_constant();
  factor_.setZero(m, m);
  theta_.resize(parameter_count());
  outputs_.resize(Eigen::Index{model_->output_count()} * model_->month_count());
  residual_.resize(m);
  whitened_.resize(m);
}

Posterior::Posterior(const Posterior& other)
    : Posterior(*other.model_, other.parameters_, other.data_, other.prior_) {
  fixed_ = other.fixed_;  // with the weights' share
}

Result<Posterior> Posterior::make(const MonthlyModel& prototype, std::vector<Parameter> parameters,
                                  PosteriorData data, HyperPrior prior) {
  Posterior posterior(prototype, std::move(parameters), std::move(data), std::move(prior));
  posterior.add_weights();
  const Hyperparameters reference =
      default_reference(posterior.prior_, posterior.kernel_.dimension());
  if (!posterior.set_hyperparameters(reference)) {
    return failure(
        ErrorCode::not_positive_definite,
        "the covariance of the measured points has no Cholesky factor at the prior means "
        "of its hyper-parameters; check the extra variances, the common errors and the "
        "hyper-prior for extreme values");
  }
  return posterior;
}

void Posterior::add_weights() {
  bool any = false;
  for (const double weight : data_.weights) {
    assert(weight > 0.0 && weight <= 1.0);
    any = any || weight < 1.0;
  }
  if (!any) return;
  hyper_ = data_.weight_reference.value_or(default_reference(prior_, kernel_.dimension()));
  assemble(0.0);
  for (Eigen::Index j = 0; j < point_count(); ++j) {
    const int output = data_.points[static_cast<std::size_t>(j)].output;
    const double weight = data_.weights[static_cast<std::size_t>(output)];
    for (Eigen::Index i = j; i < point_count(); ++i) {
      if (data_.points[static_cast<std::size_t>(i)].output != output) break;
      fixed_(i, j) += (1.0 / weight - 1.0) * factor_(i, j);  // (1/w - 1) S_t
    }
  }
}

void Posterior::assemble(double jitter) {
  kernel_.covariance(1.0 / hyper_.discrepancy_precision, hyper_.beta, factor_);
  const double diagonal = 1.0 / hyper_.error_precision + jitter;
  const Eigen::Index m = point_count();
  for (Eigen::Index j = 0; j < m; ++j) {
    factor_.col(j).tail(m - j) += fixed_.col(j).tail(m - j);
    factor_(j, j) += diagonal;
  }
}

bool Posterior::factorise() {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(factor_);
  if (in_place.info() != Eigen::Success) return false;
  whitened_ = factor_.diagonal();
  const double half_log_determinant = whitened_.array().log().sum();
  log_normaliser_ = -half_log_determinant -
                    0.5 * static_cast<double>(point_count()) * std::log(2.0 * std::numbers::pi);
  return std::isfinite(log_normaliser_);  // Eigen lets a NaN through
}

bool Posterior::set_hyperparameters(const Hyperparameters& hyper) {
  hyper_point_(0) = std::numeric_limits<double>::quiet_NaN();  // equal to no point
  hyper_ = hyper;
  assemble(0.0);
  has_factor_ = factorise();
  if (!has_factor_) {
    ++jitter_count_;
    assemble(kJitter);
    has_factor_ = factorise();
  }
  return has_factor_;
}

double Posterior::log_likelihood_of_residual(const Eigen::VectorXd& residual) {
  assert(has_factor_ && residual.size() == point_count());
  whitened_ = residual;
  factor_.triangularView<Eigen::Lower>().solveInPlace(whitened_);
  return log_normaliser_ - 0.5 * whitened_.squaredNorm();  // eq. (7)
}

Result<double> Posterior::log_likelihood(std::span<const double> theta) {
  model_->evaluate(theta, {outputs_.data(), static_cast<std::size_t>(outputs_.size())});
  const int months = model_->month_count();
  for (Eigen::Index i = 0; i < point_count(); ++i) {
    const PointIndex& point = data_.points[static_cast<std::size_t>(i)];
    const OutputScale& scale = data_.scales[static_cast<std::size_t>(point.output)];
    residual_(i) = data_.values(i) - scale.normalise(outputs_(point.output * months + point.month));
  }
  const double value = log_likelihood_of_residual(residual_);
  if (!std::isfinite(value)) {
    const auto finite = design::check_finite(parameters_, theta, as_span(outputs_), months);
    if (!finite) return tl::unexpected(finite.error());
    return kMinusInfinity;
  }
  return value;
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
  const auto likelihood = log_likelihood(theta);
  if (!likelihood) return tl::unexpected(likelihood.error());
  terms.log_likelihood = *likelihood;
  return terms;
}

void Posterior::to_natural(const Eigen::VectorXd& point, Eigen::Ref<Eigen::VectorXd> theta,
                           Hyperparameters& hyper) const {
  const Eigen::Index q = parameter_count();
  for (Eigen::Index j = 0; j < q; ++j) {
    theta(j) = parameters_[static_cast<std::size_t>(j)].prior.quantile(logistic(point(j)));
  }
  hyper.discrepancy_precision = std::exp(point(q));
  hyper.error_precision = std::exp(point(q + 1));
  for (Eigen::Index s = 0; s < kernel_.dimension(); ++s) {
    hyper.beta(s) = beta_from_logit(point(q + 2 + s));
  }
}

double Posterior::log_prior_unconstrained(const Eigen::VectorXd& point) const {
  const Eigen::Index q = parameter_count();
  double sum = prior_constant_;
  for (Eigen::Index j = 0; j < q; ++j) {
    // Standard logistic: -z - 2 log(1 + exp(-z)).
    sum -= softplus(point(j)) + softplus(-point(j));
  }
  // The Jacobian of lambda = exp(l) is lambda: + l.
  sum += prior_.discrepancy_precision.log_kernel(std::exp(point(q)), point(q)) + point(q);
  sum += prior_.error_precision.log_kernel(std::exp(point(q + 1)), point(q + 1)) + point(q + 1);
  for (Eigen::Index s = 0; s < kernel_.dimension(); ++s) {
    // (a - 1) log rho + (b - 1) log(1 - rho) and the Jacobian rho (1 - rho).
    const double z = point(q + 2 + s);
    sum -= prior_.rho.a * softplus(-z) + prior_.rho.b * softplus(z);
  }
  return sum;
}

Result<double> Posterior::log_density(const Eigen::VectorXd& point) {
  assert(point.size() == dimension());
  const double log_prior = log_prior_unconstrained(point);
  if (!std::isfinite(log_prior)) return kMinusInfinity;
  const auto hyper_point = point.tail(hyper_point_.size());
  to_natural(point, theta_, next_hyper_);
  // exp() may underflow; a variance of infinity has no density either.
  if (!(next_hyper_.discrepancy_precision > 0.0 && next_hyper_.error_precision > 0.0)) {
    return kMinusInfinity;
  }
  if (hyper_point_ != hyper_point) {
    (void)set_hyperparameters(next_hyper_);
    hyper_point_ = hyper_point;
  }
  if (!has_factor_) return kMinusInfinity;
  auto value = log_likelihood(as_span(theta_));
  if (value) *value += log_prior;
  return value;
}

Eigen::VectorXd Posterior::draw_start(Rng& rng) const {
  const Eigen::Index q = parameter_count();
  Eigen::VectorXd point(dimension());
  for (Eigen::Index j = 0; j < q; ++j) {
    const double u = rng.uniform();
    point(j) = std::log(u) - std::log1p(-u);  // quantile of the standard logistic
  }
  point(q) = std::log(prior_.discrepancy_precision.quantile(rng.uniform()));
  point(q + 1) = std::log(prior_.error_precision.quantile(rng.uniform()));
  for (Eigen::Index s = 0; s < kernel_.dimension(); ++s) {
    point(q + 2 + s) = prior_.rho.logit_quantile(rng.uniform());
  }
  return point;
}

Eigen::Index Posterior::dimension() const { return parameter_count() + 2 + kernel_.dimension(); }

Eigen::Index Posterior::parameter_count() const {
  return static_cast<Eigen::Index>(parameters_.size());
}

}  // namespace recald::calibration
