#include "core/model/metamodel/quadratic_model.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/statistics/rectified_mean.hpp"

namespace recald::model::metamodel {

using regression::Term;

QuadraticCoefficients::QuadraticCoefficients(std::vector<regression::ColumnScale> parameter_scales,
                                             int outputs, int months)
    : scales_(std::move(parameter_scales)),
      outputs_(outputs),
      months_(months),
      terms_(regression::all_terms(static_cast<int>(scales_.size()), true)),
      constants_(Eigen::VectorXd::Zero(outputs * months)),
      widths_(Eigen::VectorXd::Zero(outputs * months)),
      coefficients_(
          Eigen::MatrixXd::Zero(outputs * months, static_cast<Eigen::Index>(terms_.size()))) {}

Eigen::Index QuadraticCoefficients::row(int output, int month) const {
  assert(output >= 0 && output < outputs_ && month >= 0 && month < months_);
  return output * months_ + month;
}

Eigen::Index QuadraticCoefficients::column(Term term) const {
  if (!term.is_main_effect() && term.second < term.first) std::swap(term.first, term.second);
  const auto found = std::find(terms_.begin(), terms_.end(), term);
  assert(found != terms_.end());
  return found - terms_.begin();
}

void QuadraticCoefficients::add_constant(int output, int month, double value) {
  constants_(row(output, month)) += value;
}

void QuadraticCoefficients::add(int output, int month, Term term, double coefficient) {
  coefficients_(row(output, month), column(term)) += coefficient;
}

void QuadraticCoefficients::set_width(int output, int month, double width) {
  assert(width > 0.0);
  widths_(row(output, month)) = width;
}

QuadraticModel::QuadraticModel(const QuadraticCoefficients& coefficients)
    : outputs_(coefficients.outputs_),
      months_(coefficients.months_),
      caps_(coefficients.caps_),
      constants_(coefficients.constants_) {
  std::vector<Eigen::Index> used;
  for (std::size_t j = 0; j < coefficients.terms_.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    if (coefficients.coefficients_.col(column).isZero(0.0)) continue;
    used.push_back(column);
    terms_.push_back(coefficients.terms_[j]);
  }
  coefficients_ = coefficients.coefficients_(Eigen::all, used);
  basis_.resize(coefficients_.cols());
  for (Eigen::Index row = 0; row < constants_.size(); ++row) {
    if (coefficients.widths_(row) == 0.0) continue;
    bent_.push_back(row);
    widths_.push_back(coefficients.widths_(row));
  }

  const auto q = static_cast<Eigen::Index>(coefficients.scales_.size());
  scaled_.resize(q);
  min_.resize(q);
  inverse_range_.resize(q);
  for (Eigen::Index j = 0; j < q; ++j) {
    const auto& scale = coefficients.scales_[static_cast<std::size_t>(j)];
    assert(scale.range() > 0.0);
    min_(j) = scale.min;
    inverse_range_(j) = 1.0 / scale.range();
  }
}

std::unique_ptr<MonthlyModel> QuadraticModel::clone() const {
  return std::make_unique<QuadraticModel>(*this);
}

void QuadraticModel::evaluate(std::span<const double> theta, std::span<double> outputs) {
  evaluate_straight(theta, outputs);
  for (std::size_t b = 0; b < bent_.size(); ++b) {
    double& value = outputs[static_cast<std::size_t>(bent_[b])];
    value = rectified_mean(value, widths_[b]);
  }
}

void QuadraticModel::evaluate_straight(std::span<const double> theta, std::span<double> outputs) {
  assert(static_cast<Eigen::Index>(theta.size()) == scaled_.size());
  assert(static_cast<Eigen::Index>(outputs.size()) == constants_.size());
  scaled_ = Eigen::Map<const Eigen::VectorXd>(theta.data(), scaled_.size());
  for (const regression::ParameterCap& cap : caps_) {
    scaled_(cap.parameter) = std::min(scaled_(cap.parameter), scaled_(cap.under) - cap.gap);
  }
  scaled_ = (scaled_ - min_).cwiseProduct(inverse_range_);
  for (std::size_t j = 0; j < terms_.size(); ++j) {
    const Term& term = terms_[j];
    const double second = term.is_main_effect() ? 1.0 : scaled_(term.second);
    basis_(static_cast<Eigen::Index>(j)) = scaled_(term.first) * second;
  }
  Eigen::Map<Eigen::VectorXd> values(outputs.data(), constants_.size());
  values = constants_;
  values.noalias() += coefficients_ * basis_;
}

void QuadraticModel::evaluate_with_jacobian(std::span<const double> theta,
                                            std::span<double> outputs, std::span<double> jacobian) {
  evaluate_straight(theta, outputs);
  assert(static_cast<Eigen::Index>(jacobian.size()) == constants_.size() * scaled_.size());
  Eigen::Map<Eigen::MatrixXd> derivatives(jacobian.data(), constants_.size(), scaled_.size());
  derivatives.setZero();
  for (std::size_t j = 0; j < terms_.size(); ++j) {
    const Term& term = terms_[j];
    const auto coefficient = coefficients_.col(static_cast<Eigen::Index>(j));
    const double second = term.is_main_effect() ? 1.0 : scaled_(term.second);
    derivatives.col(term.first) += (second * inverse_range_(term.first)) * coefficient;
    if (term.is_main_effect()) continue;
    // For a square this adds the other half of 2 t.
    derivatives.col(term.second) +=
        (scaled_(term.first) * inverse_range_(term.second)) * coefficient;
  }
  // A parameter that is capped moves with the other.
  for (const regression::ParameterCap& cap : caps_) {
    const auto parameter = static_cast<std::size_t>(cap.parameter);
    const auto under = static_cast<std::size_t>(cap.under);
    if (theta[parameter] <= theta[under] - cap.gap) continue;
    derivatives.col(cap.under) += derivatives.col(cap.parameter);
    derivatives.col(cap.parameter).setZero();
  }
  for (std::size_t b = 0; b < bent_.size(); ++b) {
    double& value = outputs[static_cast<std::size_t>(bent_[b])];
    derivatives.row(bent_[b]) *= rectified_slope(value, widths_[b]);
    value = rectified_mean(value, widths_[b]);
  }
}

}  // namespace recald::model::metamodel
