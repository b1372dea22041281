#include "core/calibration/posterior/problem.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/text/number_text.hpp"

namespace recald::calibration {
namespace {

tl::unexpected<Error> misfit(const std::string& what, std::size_t given, int expected) {
  return failure(ErrorCode::invalid_value, "the model has " + std::to_string(expected) + " " +
                                               what + ", but " + std::to_string(given) +
                                               " are given");
}

Result<void> check_shapes(const CalibrationProblem& problem, const MonthlyModel& model) {
  const auto differ = [](std::size_t given, int expected) {
    return given != static_cast<std::size_t>(expected);
  };
  if (differ(problem.parameters.size(), model.parameter_count())) {
    return misfit("calibration parameters", problem.parameters.size(), model.parameter_count());
  }
  if (differ(problem.outputs.size(), model.output_count())) {
    return misfit("outputs", problem.outputs.size(), model.output_count());
  }
  if (differ(problem.month_names.size(), model.month_count())) {
    return misfit("months", problem.month_names.size(), model.month_count());
  }
  const auto values_count =
      static_cast<std::size_t>(model.output_count()) * problem.month_names.size();
  for (const auto& direction : problem.common_errors) {
    if (static_cast<std::size_t>(direction.size()) != values_count || !direction.allFinite()) {
      return failure(ErrorCode::invalid_value,
                     "a common error needs a finite value for each of the " +
                         std::to_string(values_count) + " outputs and months of the model");
    }
  }
  return {};
}

Result<void> check_parameters(const CalibrationProblem& problem) {
  if (problem.parameters.empty()) {
    return failure(ErrorCode::invalid_value, "there is no parameter to calibrate");
  }
  return {};
}

Result<void> check_point(const OutputMeasurements& output, std::size_t month,
                         const std::string& month_name) {
  const double value = output.values[month];
  if (std::isnan(value)) return {};
  if (!std::isfinite(value)) {
    return failure(ErrorCode::not_finite,
                   "measured " + output.name + " of " + month_name + " is infinite");
  }
  if (output.extra_variances.empty()) return {};
  const double variance = output.extra_variances[month];
  if (!(variance >= 0.0) || !std::isfinite(variance)) {
    return failure(ErrorCode::invalid_value,
                   "the extra variance of measured " + output.name + " of " + month_name + " is " +
                       number_text(variance) + ", but it must be finite and not negative");
  }
  return {};
}

Result<void> check_output(const OutputMeasurements& output, const CalibrationProblem& problem) {
  const std::size_t months = problem.month_names.size();
  if (output.values.size() != months ||
      (!output.extra_variances.empty() && output.extra_variances.size() != months)) {
    return failure(ErrorCode::invalid_value,
                   output.name +
                       " needs one value, and one extra variance or none, for each of the " +
                       std::to_string(months) + " months");
  }
  if (!(output.weight > 0.0 && output.weight <= 1.0)) {
    return failure(ErrorCode::invalid_value, "the weight of " + output.name + " is " +
                                                 number_text(output.weight) +
                                                 ", but it must be above 0 and at most 1");
  }
  for (std::size_t i = 0; i < months; ++i) {
    if (auto valid = check_point(output, i, problem.month_names[i]); !valid) return valid;
  }
  return {};
}

Result<void> check_model_error(const CalibrationProblem& problem) {
  const auto& sds = problem.model_error_sd;
  const std::size_t points = problem.outputs.size() * problem.month_names.size();
  const bool usable = sds.allFinite() && (sds.array() >= 0.0).all();
  if (usable && (sds.size() == 0 || sds.size() == static_cast<Eigen::Index>(points))) return {};
  return failure(ErrorCode::invalid_value,
                 "the model's own error needs a finite, non-negative standard deviation for each "
                 "output and month, or none at all");
}

Result<void> check_inputs(const CalibrationProblem& problem) {
  const ModelInputs& inputs = problem.inputs;
  const auto months = static_cast<Eigen::Index>(problem.month_names.size());
  if (inputs.names.empty() || inputs.values.rows() != months ||
      inputs.values.cols() != static_cast<Eigen::Index>(inputs.names.size())) {
    return failure(
        ErrorCode::invalid_value,
        "the discrepancy needs at least one model input, such as the mean dry bulb, with a "
        "value for each of the " +
            std::to_string(months) + " months");
  }
  for (Eigen::Index s = 0; s < inputs.values.cols(); ++s) {
    const std::string& name = inputs.names[static_cast<std::size_t>(s)];
    for (Eigen::Index i = 0; i < months; ++i) {
      if (std::isfinite(inputs.values(i, s))) continue;
      return failure(ErrorCode::not_finite, "the model input " + name + " of " +
                                                problem.month_names[static_cast<std::size_t>(i)] +
                                                " is missing or not finite");
    }
    if (inputs.values.col(s).minCoeff() < inputs.values.col(s).maxCoeff()) continue;
    return failure(ErrorCode::invalid_value,
                   "the model input " + name + " is " + number_text(inputs.values(0, s)) +
                       " in every month, so it explains nothing; remove it");
  }
  return {};
}

Result<void> check_point_count(const CalibrationProblem& problem) {
  const int points = measured_points(problem);
  const auto needed = static_cast<int>(problem.parameters.size()) + kPointsBeyondParameters;
  if (points >= needed) return {};
  return failure(ErrorCode::not_enough_data,
                 "a calibration of " + std::to_string(problem.parameters.size()) +
                     " parameters needs at least " + std::to_string(needed) +
                     " usable monthly figures, but there are " + std::to_string(points));
}

}  // namespace

int measured_points(const CalibrationProblem& problem) {
  int points = 0;
  for (const OutputMeasurements& output : problem.outputs) points += output.measured_months();
  return points;
}

Result<void> check_problem(const CalibrationProblem& problem, const MonthlyModel& model) {
  if (auto ok = check_shapes(problem, model); !ok) return ok;
  if (auto ok = check_parameters(problem); !ok) return ok;
  for (const OutputMeasurements& output : problem.outputs) {
    if (auto ok = check_output(output, problem); !ok) return ok;
  }
  if (auto ok = check_model_error(problem); !ok) return ok;
  if (auto ok = check_inputs(problem); !ok) return ok;
  return check_point_count(problem);
}

Eigen::MatrixXd scale_inputs(const Eigen::MatrixXd& values, Eigen::Index reference_months) {
  const auto reference = values.topRows(reference_months).colwise();
  const Eigen::RowVectorXd low = reference.minCoeff();
  const Eigen::RowVectorXd range = reference.maxCoeff() - low;
  assert((range.array() > 0.0).all());
  return (values.rowwise() - low).array().rowwise() / range.array();
}

PosteriorData normalise_problem(const CalibrationProblem& problem,
                                const Normalisation& normalisation, Eigen::Index reference_months) {
  PosteriorData data;
  const Eigen::MatrixXd& inputs = problem.inputs.values;
  data.month_inputs = scale_inputs(inputs, reference_months > 0 ? reference_months : inputs.rows());
  data.scales = normalisation.scales;
  const int months = static_cast<int>(problem.month_names.size());
  std::vector<double> values;
  std::vector<double> variances;
  double weight_max = 0.0;
  for (std::size_t k = 0; k < problem.outputs.size(); ++k) {
    const OutputMeasurements& output = problem.outputs[k];
    const OutputScale& scale = normalisation.scales[k];
    if (output.measured_months() > 0) weight_max = std::max(weight_max, output.weight);
    for (int i = 0; i < months; ++i) {
      const auto month = static_cast<std::size_t>(i);
      if (std::isnan(output.values[month])) continue;
      const double known = output.extra_variances.empty() ? 0.0 : output.extra_variances[month];
      const Eigen::Index place = static_cast<Eigen::Index>(k) * months + i;
      const double model_sd =
          problem.model_error_sd.size() == 0 ? 0.0 : problem.model_error_sd(place);
      data.points.push_back({static_cast<int>(k), i});
      values.push_back(scale.normalise(output.values[month]));
      variances.push_back(scale.normalise_variance(model_sd * model_sd + known));
    }
  }
  for (const auto& output : problem.outputs) {
    data.weights.push_back(std::min(1.0, output.weight / weight_max));
  }
  const auto m = static_cast<Eigen::Index>(values.size());
  data.values = Eigen::Map<const Eigen::VectorXd>(values.data(), m);
  data.extra_variances = Eigen::Map<const Eigen::VectorXd>(variances.data(), m);
  data.common_errors.resize(m, static_cast<Eigen::Index>(problem.common_errors.size()));
  for (Eigen::Index i = 0; i < m; ++i) {
    const PointIndex& point = data.points[static_cast<std::size_t>(i)];
    const double range = data.scales[static_cast<std::size_t>(point.output)].range();
    for (std::size_t g = 0; g < problem.common_errors.size(); ++g) {
      data.common_errors(i, static_cast<Eigen::Index>(g)) =
          problem.common_errors[g](point.output * months + point.month) / range;
    }
  }
  return data;
}

}  // namespace recald::calibration
