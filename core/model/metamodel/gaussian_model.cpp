#include "core/model/metamodel/gaussian_model.hpp"

#include <algorithm>
#include <cassert>

namespace recald::model::metamodel {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

GaussianModel::GaussianModel(const regression::MonthlyForm& form, std::span<const int> months)
    : outputs_{static_cast<int>(form.outputs.size())},
      months_{static_cast<int>(months.size())},
      caps_{form.caps},
      min_(form.points.cols()),
      inverse_range_(form.points.cols()),
      means_(outputs_ * months_),
      scaled_(form.points.cols()),
      centred_(form.points.cols()),
      rooted_(form.points.cols()),
      slope_(form.points.cols()),
      parts_(form.points.rows()) {
  for (Index j = 0; j < min_.size(); ++j) {
    const regression::ColumnScale& scale = form.parameter_scales[static_cast<std::size_t>(j)];
    min_(j) = scale.min;
    inverse_range_(j) = 1.0 / scale.range();
  }
  const std::vector<int> places{months.begin(), months.end()};
  const MatrixXd c = form.points.array() - 0.5;
  for (int k = 0; k < outputs_; ++k) {
    const regression::MonthlyFormOutput& fit = form.fits[static_cast<std::size_t>(k)];
    const regression::ColumnScale& scale = form.output_scales[static_cast<std::size_t>(k)];
    means_.segment(k * months_, months_) = scale.min + scale.range() * fit.means(places).array();
    for (const regression::MonthPattern& pattern : fit.patterns) {
      const regression::Kernel& kernel = pattern.amount.kernel;
      const VectorXd& weights = pattern.amount.weights;
      Amount amount{.root = kernel.relevance.cwiseSqrt(),
                    .points = {},
                    .half_norms = {},
                    .weights = weights,
                    .constant = (kernel.linear + kernel.quadratic) * weights.sum(),
                    .linear = (kernel.linear + 2.0 * kernel.quadratic) * (c.transpose() * weights),
                    .quadratic = kernel.quadratic * c.transpose() * weights.asDiagonal() * c,
                    .first_row = k * months_,
                    .loadings = scale.range() * pattern.loadings(places)};
      amount.points = form.points * amount.root.asDiagonal();
      amount.half_norms = 0.5 * amount.points.rowwise().squaredNorm();
      amounts_.push_back(std::move(amount));
    }
  }
}

std::unique_ptr<MonthlyModel> GaussianModel::clone() const {
  return std::make_unique<GaussianModel>(*this);
}

void GaussianModel::scale(std::span<const double> theta) {
  assert(static_cast<Index>(theta.size()) == scaled_.size());
  scaled_ = Eigen::Map<const VectorXd>(theta.data(), scaled_.size());
  for (const regression::ParameterCap& cap : caps_) {
    scaled_(cap.parameter) = std::min(scaled_(cap.parameter), scaled_(cap.under) - cap.gap);
  }
  scaled_ = (scaled_ - min_).cwiseProduct(inverse_range_);
  centred_ = scaled_.array() - 0.5;
}

double GaussianModel::amount_at_scaled(const Amount& amount) {
  rooted_ = amount.root.cwiseProduct(scaled_);
  parts_.noalias() = amount.points * rooted_;
  const double half_norm = 0.5 * rooted_.squaredNorm();
  parts_ = amount.weights.array() * (parts_ - amount.half_norms).array().operator-(half_norm).exp();
  slope_.noalias() = amount.quadratic * centred_;
  return parts_.sum() + amount.constant + (amount.linear + slope_).dot(centred_);
}

void GaussianModel::evaluate(std::span<const double> theta, std::span<double> outputs) {
  assert(static_cast<Index>(outputs.size()) == means_.size());
  scale(theta);
  Eigen::Map<VectorXd> values(outputs.data(), means_.size());
  values = means_;
  for (const Amount& amount : amounts_) {
    values.segment(amount.first_row, months_) += amount_at_scaled(amount) * amount.loadings;
  }
}

void GaussianModel::evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                                           std::span<double> jacobian) {
  assert(static_cast<Index>(jacobian.size()) == means_.size() * scaled_.size());
  scale(theta);
  Eigen::Map<VectorXd> values(outputs.data(), means_.size());
  Eigen::Map<MatrixXd> derivatives(jacobian.data(), means_.size(), scaled_.size());
  values = means_;
  derivatives.setZero();
  for (const Amount& amount : amounts_) {
    values.segment(amount.first_row, months_) += amount_at_scaled(amount) * amount.loadings;
    slope_ *= 2.0;
    slope_ += amount.linear;
    // d exp(-|p - r|^2 / 2) / d t = root (p - r) times itself
    const double sum = parts_.sum();
    rooted_ *= -sum;
    rooted_.noalias() += amount.points.transpose() * parts_;
    slope_ += amount.root.cwiseProduct(rooted_);
    slope_ = slope_.cwiseProduct(inverse_range_);
    derivatives.middleRows(amount.first_row, months_).noalias() +=
        amount.loadings * slope_.transpose();
  }
  // A parameter that is capped moves with the other.
  for (const regression::ParameterCap& cap : caps_) {
    const auto parameter = static_cast<std::size_t>(cap.parameter);
    const auto under = static_cast<std::size_t>(cap.under);
    if (theta[parameter] <= theta[under] - cap.gap) continue;
    derivatives.col(cap.under) += derivatives.col(cap.parameter);
    derivatives.col(cap.parameter).setZero();
  }
}

}  // namespace recald::model::metamodel
