/// A model with some parameters fixed, and two models that split the months between them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/model/monthly_model.hpp"

namespace recald {

/// The model as a function of some of its parameters; the others are fixed.
class FixedParametersModel final : public MonthlyModel {
 public:
  /// @param theta  (parameters of `model`) values of the fixed ones; the others are overwritten.
  /// @param free   Indices of the remaining parameters, ascending.
  FixedParametersModel(std::unique_ptr<MonthlyModel> model, std::vector<double> theta,
                       std::vector<int> free);

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override { return static_cast<int>(free_.size()); }
  [[nodiscard]] int output_count() const override { return model_->output_count(); }
  [[nodiscard]] int month_count() const override { return model_->month_count(); }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override;

  [[nodiscard]] bool has_jacobian() const override { return model_->has_jacobian(); }
  void evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                              std::span<double> jacobian) override;

 private:
  void place(std::span<const double> theta);

  std::unique_ptr<MonthlyModel> model_;
  std::vector<double> theta_;  ///< All parameters.
  std::vector<int> free_;
  std::vector<double> jacobian_;  ///< Of all parameters.
};

/// Two models with the same outputs and parameters: the months of the first, then of the second.
class JoinedMonthsModel final : public MonthlyModel {
 public:
  JoinedMonthsModel(std::unique_ptr<MonthlyModel> first, std::unique_ptr<MonthlyModel> second);

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override { return first_->parameter_count(); }
  [[nodiscard]] int output_count() const override { return first_->output_count(); }
  [[nodiscard]] int month_count() const override {
    return first_->month_count() + second_->month_count();
  }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override;

 private:
  std::unique_ptr<MonthlyModel> first_;
  std::unique_ptr<MonthlyModel> second_;
  std::vector<double> first_outputs_;
  std::vector<double> second_outputs_;
};

}  // namespace recald
