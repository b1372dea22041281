/// Small models whose posterior is known, for tests.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/calibration/posterior/problem.hpp"
#include "core/model/monthly_model.hpp"

namespace recald::calibration {

/// Any function of theta as a model.
class FunctionModel final : public MonthlyModel {
 public:
  using Function = std::function<void(std::span<const double>, std::span<double>)>;

  FunctionModel(int parameters, int outputs, int months, Function function)
      : parameters_(parameters),
        outputs_(outputs),
        months_(months),
        function_(std::move(function)) {}

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<FunctionModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return parameters_; }
  [[nodiscard]] int output_count() const override { return outputs_; }
  [[nodiscard]] int month_count() const override { return months_; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    function_(theta, outputs);
  }

 private:
  int parameters_;
  int outputs_;
  int months_;
  Function function_;
};

/// A year and more of weather-like input: (months x 2), a cycle and something slower.
inline Eigen::MatrixXd toy_inputs(int months) {
  Eigen::MatrixXd inputs(months, 2);
  for (int i = 0; i < months; ++i) {
    inputs(i, 0) = 15.0 - 12.0 * std::cos(2.0 * M_PI * i / 12.0) + 0.3 * std::sin(5.0 * i);
    inputs(i, 1) = 60.0 + 15.0 * std::sin(0.9 * i + 1.0);
  }
  return inputs;
}

/// Cooling-like: output k in month i is base_k + gain_k * theta_0 * max(T_i - theta_1, 0).
inline FunctionModel toy_model(int outputs, int months) {
  const Eigen::MatrixXd inputs = toy_inputs(months);
  return {2, outputs, months, [=](std::span<const double> theta, std::span<double> values) {
            for (int k = 0; k < outputs; ++k) {
              for (int i = 0; i < months; ++i) {
                const double excess_K = std::max(inputs(i, 0) - theta[1], 0.0);
                values[static_cast<std::size_t>(k * months + i)] =
                    500.0 * (k + 1) + 40.0 * (1 + k) * theta[0] * excess_K + 20.0 * theta[0];
              }
            }
          }};
}

inline std::vector<Parameter> toy_parameters() {
  return {{"gain", "kW/K", {0.5, 1.0, 2.0}}, {"balance_point", "degC", {8.0, 12.0, 18.0}}};
}

/// The toy model at (1.3, 11) plus a fixed wiggle of 2 % as measurements.
inline CalibrationProblem toy_problem(int outputs, int months) {
  CalibrationProblem problem;
  problem.parameters = toy_parameters();
  problem.inputs = {{"dry_bulb", "humidity"}, toy_inputs(months)};
  FunctionModel model = toy_model(outputs, months);
  std::vector<double> values(static_cast<std::size_t>(outputs * months));
  const std::vector<double> truth{1.3, 11.0};
  model.evaluate(truth, values);
  for (int i = 0; i < months; ++i) problem.month_names.push_back("month " + std::to_string(i + 1));
  for (int k = 0; k < outputs; ++k) {
    OutputMeasurements measured{"meter_" + std::to_string(k), "kWh/day", {}, {}, 1.0};
    for (int i = 0; i < months; ++i) {
      const double wiggle = 1.0 + 0.02 * std::sin(7.3 * i + 2.1 * k);
      measured.values.push_back(wiggle * values[static_cast<std::size_t>(k * months + i)]);
    }
    problem.outputs.push_back(std::move(measured));
  }
  return problem;
}

}  // namespace recald::calibration
