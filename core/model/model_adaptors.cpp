#include "core/model/model_adaptors.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace recald {

FixedParametersModel::FixedParametersModel(std::unique_ptr<MonthlyModel> model,
                                           std::vector<double> theta, std::vector<int> free)
    : model_{std::move(model)}, theta_{std::move(theta)}, free_{std::move(free)} {
  assert(theta_.size() == static_cast<std::size_t>(model_->parameter_count()));
  assert(std::ranges::is_sorted(free_));
  if (!model_->has_jacobian()) return;
  jacobian_.resize(theta_.size() *
                   static_cast<std::size_t>(model_->output_count() * model_->month_count()));
}

std::unique_ptr<MonthlyModel> FixedParametersModel::clone() const {
  return std::make_unique<FixedParametersModel>(model_->clone(), theta_, free_);
}

void FixedParametersModel::place(std::span<const double> theta) {
  for (std::size_t j = 0; j < free_.size(); ++j) {
    theta_[static_cast<std::size_t>(free_[j])] = theta[j];
  }
}

void FixedParametersModel::evaluate(std::span<const double> theta, std::span<double> outputs) {
  place(theta);
  model_->evaluate(theta_, outputs);
}

void FixedParametersModel::evaluate_with_jacobian(std::span<const double> theta,
                                                  std::span<double> outputs,
                                                  std::span<double> jacobian) {
  place(theta);
  model_->evaluate_with_jacobian(theta_, outputs, jacobian_);
  for (std::size_t j = 0; j < free_.size(); ++j) {
    const std::size_t column = static_cast<std::size_t>(free_[j]) * outputs.size();
    std::copy_n(jacobian_.begin() + static_cast<std::ptrdiff_t>(column), outputs.size(),
                jacobian.begin() + static_cast<std::ptrdiff_t>(j * outputs.size()));
  }
}

JoinedMonthsModel::JoinedMonthsModel(std::unique_ptr<MonthlyModel> first,
                                     std::unique_ptr<MonthlyModel> second)
    : first_{std::move(first)},
      second_{std::move(second)},
      first_outputs_(static_cast<std::size_t>(first_->output_count() * first_->month_count())),
      second_outputs_(static_cast<std::size_t>(second_->output_count() * second_->month_count())) {
  assert(first_->output_count() == second_->output_count());
  assert(first_->parameter_count() == second_->parameter_count());
}

std::unique_ptr<MonthlyModel> JoinedMonthsModel::clone() const {
  return std::make_unique<JoinedMonthsModel>(first_->clone(), second_->clone());
}

void JoinedMonthsModel::evaluate(std::span<const double> theta, std::span<double> outputs) {
  first_->evaluate(theta, first_outputs_);
  second_->evaluate(theta, second_outputs_);
  const auto m1 = static_cast<std::ptrdiff_t>(first_->month_count());
  const auto m2 = static_cast<std::ptrdiff_t>(second_->month_count());
  auto to = outputs.begin();
  for (std::ptrdiff_t k = 0; k < first_->output_count(); ++k) {
    to = std::copy_n(first_outputs_.begin() + k * m1, m1, to);
    to = std::copy_n(second_outputs_.begin() + k * m2, m2, to);
  }
}

}  // namespace recald
