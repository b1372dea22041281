#include "core/model/metamodel/gaussian_model.hpp"

#include <algorithm>
#include <cassert>

namespace recald::model::metamodel {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kBlock = 64;  // runs

}  // namespace

GaussianModel::GaussianModel(const regression::MonthlyForm& form, std::span<const int> months)
    : outputs_{static_cast<int>(form.outputs.size())},
      months_{static_cast<int>(months.size())},
      caps_{form.caps},
      points_{form.points} {
  Index patterns = 0;
  for (const regression::MonthlyFormOutput& fit : form.fits) patterns += std::ssize(fit.patterns);
  const Index n = points_.rows();
  const Index q = points_.cols();
  const Index block = std::min(kBlock, n);
  for (VectorXd* vector : {&min_, &inverse_range_, &scaled_, &centred_}) vector->resize(q);
  for (MatrixXd* matrix : {&relevance_, &linear_, &slopes_}) matrix->resize(q, patterns);
  for (MatrixXd* matrix : {&differences_, &squares_}) matrix->resize(block, q);
  for (VectorXd* vector : {&constants_, &amounts_}) vector->resize(patterns);
  means_.resize(outputs_ * months_);
  weights_.resize(n, patterns);
  parts_.resize(block, patterns);
  quadratic_.resize(patterns * q, q);
  bent_.resize(patterns * q);
  for (Index j = 0; j < q; ++j) {
    const regression::ColumnScale& scale = form.parameter_scales[static_cast<std::size_t>(j)];
    min_(j) = scale.min;
    inverse_range_(j) = 1.0 / scale.range();
  }

  const std::vector<int> places{months.begin(), months.end()};
  const MatrixXd c = points_.array() - 0.5;
  Index next = 0;
  for (int k = 0; k < outputs_; ++k) {
    const regression::MonthlyFormOutput& fit = form.fits[static_cast<std::size_t>(k)];
    const regression::ColumnScale& scale = form.output_scales[static_cast<std::size_t>(k)];
    means_.segment(k * months_, months_) = scale.min + scale.range() * fit.means(places).array();
    Output output{next, MatrixXd(months_, std::ssize(fit.patterns))};
    for (const regression::MonthPattern& pattern : fit.patterns) {
      const regression::Kernel& kernel = pattern.amount.kernel;
      const VectorXd& weights = pattern.amount.weights;
      output.loadings.col(next - output.first) = scale.range() * pattern.loadings(places);
      relevance_.col(next) = kernel.relevance;
      weights_.col(next) = weights;
      constants_(next) = (kernel.linear + kernel.quadratic) * weights.sum();
      linear_.col(next) = (kernel.linear + 2.0 * kernel.quadratic) * (c.transpose() * weights);
      quadratic_.middleRows(next * q, q) =
          kernel.quadratic * c.transpose() * weights.asDiagonal() * c;
      ++next;
    }
    patterns_.push_back(std::move(output));
  }
}

std::unique_ptr<MonthlyModel> GaussianModel::clone() const {
  return std::make_unique<GaussianModel>(*this);
}

void GaussianModel::find_amounts(std::span<const double> theta, MatrixXd* slopes) {
  const Index q = scaled_.size();
  assert(static_cast<Index>(theta.size()) == q);
  scaled_ = Eigen::Map<const VectorXd>(theta.data(), q);
  for (const regression::ParameterCap& cap : caps_) {
    scaled_(cap.parameter) = std::min(scaled_(cap.parameter), scaled_(cap.under) - cap.gap);
  }
  scaled_ = (scaled_ - min_).cwiseProduct(inverse_range_);
  centred_ = scaled_.array() - 0.5;

  amounts_.setZero();
  if (slopes != nullptr) slopes->setZero();
  for (Index first = 0; first < points_.rows(); first += kBlock) {
    const Index rows = std::min(kBlock, points_.rows() - first);
    auto differences = differences_.topRows(rows);
    auto squares = squares_.topRows(rows);
    auto parts = parts_.topRows(rows);
    differences = points_.middleRows(first, rows).rowwise() - scaled_.transpose();
    squares = differences.cwiseAbs2();
    parts.noalias() = squares * relevance_;
    parts = weights_.middleRows(first, rows).array() * (-0.5 * parts.array()).exp();
    amounts_ += parts.colwise().sum().transpose();
    if (slopes != nullptr) slopes->noalias() += differences.transpose() * parts;
  }
  // d exp(-relevance (x - t)^2 / 2) / d t = relevance (x - t) times itself
  if (slopes != nullptr) *slopes = slopes->cwiseProduct(relevance_) + linear_;
  bent_.noalias() = quadratic_ * centred_;
  amounts_ += constants_;
  amounts_.noalias() += linear_.transpose() * centred_;
  for (Index p = 0; p < amounts_.size(); ++p) {
    const auto bent = bent_.segment(p * q, q);
    amounts_(p) += bent.dot(centred_);
    if (slopes != nullptr) slopes->col(p) += 2.0 * bent;
  }
}

void GaussianModel::evaluate(std::span<const double> theta, std::span<double> outputs) {
  assert(static_cast<Index>(outputs.size()) == means_.size());
  find_amounts(theta, nullptr);
  Eigen::Map<VectorXd> values(outputs.data(), means_.size());
  values = means_;
  for (int k = 0; k < outputs_; ++k) {
    const Output& output = patterns_[static_cast<std::size_t>(k)];
    values.segment(k * months_, months_).noalias() +=
        output.loadings * amounts_.segment(output.first, output.loadings.cols());
  }
}

void GaussianModel::evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                                           std::span<double> jacobian) {
  assert(static_cast<Index>(jacobian.size()) == means_.size() * scaled_.size());
  find_amounts(theta, &slopes_);
  slopes_.array().colwise() *= inverse_range_.array();
  Eigen::Map<VectorXd> values(outputs.data(), means_.size());
  Eigen::Map<MatrixXd> derivatives(jacobian.data(), means_.size(), scaled_.size());
  values = means_;
  derivatives.setZero();
  for (int k = 0; k < outputs_; ++k) {
    const Output& output = patterns_[static_cast<std::size_t>(k)];
    const Index count = output.loadings.cols();
    values.segment(k * months_, months_).noalias() +=
        output.loadings * amounts_.segment(output.first, count);
    derivatives.middleRows(k * months_, months_).noalias() +=
        output.loadings * slopes_.middleCols(output.first, count).transpose();
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
