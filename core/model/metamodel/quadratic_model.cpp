#include "core/model/metamodel/quadratic_model.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace recald::model::metamodel {

using regression::Term;

QuadraticCoefficients::QuadraticCoefficients(std::vector<regression::ColumnScale> parameter_scales,
                                             int outputs, int months)
    : scales_(std::move(parameter_scales)),
      outputs_(outputs),
      months_(months),
      terms_(regression::all_terms(static_cast<int>(scales_.size()), true)),
      constants_(Eigen::VectorXd::Zero(outputs * months)),
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

QuadraticModel::QuadraticModel(const QuadraticCoefficients& coefficients)
    : outputs_(coefficients.outputs_),
      months_(coefficients.months_),
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
  assert(static_cast<Eigen::Index>(theta.size()) == scaled_.size());
  assert(static_cast<Eigen::Index>(outputs.size()) == constants_.size());
  scaled_ = Eigen::Map<const Eigen::VectorXd>(theta.data(), scaled_.size());
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
  evaluate(theta, outputs);
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
}

}  // namespace recald::model::metamodel
