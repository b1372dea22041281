/// Reader of the seedcase folder: a synthetic case of the seed's size with a given meta-model.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/calibration/posterior/normalisation.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/posterior/problem.hpp"
#include "core/model/metamodel/builders.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "tests/support/data_folders.hpp"

namespace recald::calibration {

inline std::filesystem::path seedcase_folder() { return testing::own_data("seedcase"); }

/// Rows of a CSV below its header, split at commas.
inline std::vector<std::vector<std::string>> read_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

/// Everything on the scaled axes of the case's own statement: theta in (0, 1), outputs normalised.
struct Seedcase {
  std::vector<Parameter> parameters;
  std::unique_ptr<MonthlyModel> model;
  PosteriorData data;
  double pooled_variance;
};

/// The case's coefficients on axes that are scaled already: every scale is {0, 1}.
inline std::unique_ptr<MonthlyModel> given_model(const Seedcase& c) {
  model::metamodel::GivenRegression given;
  for (const auto& row : read_rows(seedcase_folder() / "metamodel.csv")) {
    given.terms.push_back({row[0], std::stod(row[1])});
  }
  for (const Parameter& parameter : c.parameters) given.parameters.push_back(parameter.name);
  given.parameter_scales.assign(given.parameters.size(), {0.0, 1.0});
  given.inputs = {"drybulb", "rh", "winddir", "windspeed"};
  given.input_scales.assign(4, {0.0, 1.0});
  given.output_scales.assign(2, {0.0, 1.0});
  model::metamodel::MonthInputs inputs{given.inputs, {}, c.data.month_inputs};
  for (Eigen::Index i = 0; i < c.data.month_inputs.rows(); ++i) {
    inputs.months.push_back(std::to_string(i + 1));
  }
  return model::metamodel::model_of(given, inputs).value().clone();
}

inline Seedcase read_seedcase() {
  const auto folder = seedcase_folder();
  Seedcase c;
  for (const auto& row : read_rows(folder / "priors.csv")) {
    const double min = std::stod(row[2]);
    const double range = std::stod(row[4]) - min;
    c.parameters.push_back({row[0], "-", {0.0, (std::stod(row[3]) - min) / range, 1.0}});
  }
  const auto measured = read_rows(folder / "measurements.csv");
  const auto design = read_rows(folder / "doe_outputs.csv");
  const auto months = static_cast<Eigen::Index>(measured.size());
  Eigen::MatrixXd weather(months, 4);
  std::vector<OutputMeasurements> outputs{{"daily_kwh", "kWh/day", {}, {}, 1.0},
                                          {"peak_kw", "kW", {}, {}, 1.0}};
  for (Eigen::Index i = 0; i < months; ++i) {
    const auto& row = measured[static_cast<std::size_t>(i)];
    for (std::size_t s = 0; s < 4; ++s) {
      weather(i, static_cast<Eigen::Index>(s)) = std::stod(row[3 + s]);
    }
    outputs[0].values.push_back(std::stod(row[7]));
    outputs[1].values.push_back(std::stod(row[8]));
  }
  Eigen::MatrixXd design_outputs(static_cast<Eigen::Index>(design.size()) / months, 2 * months);
  for (const auto& row : design) {
    const Eigen::Index run = std::stol(row[0]) - 1;
    const Eigen::Index month = std::stol(row[1]) - 1;
    design_outputs(run, month) = std::stod(row[2]);
    design_outputs(run, months + month) = std::stod(row[3]);
  }
  const Normalisation normalisation =
      normalise_design(design_outputs, outputs, static_cast<int>(months)).value();
  c.pooled_variance = normalisation.pooled_variance;
  CalibrationProblem problem;
  problem.parameters = c.parameters;
  problem.month_names.resize(measured.size());
  problem.outputs = outputs;
  problem.inputs = {{"drybulb", "rh", "winddir", "windspeed"}, weather};
  c.data = normalise_problem(problem, normalisation);
  c.data.scales = {{0.0, 1.0}, {0.0, 1.0}};  // the meta-model speaks in normalised outputs
  c.model = given_model(c);
  return c;
}

}  // namespace recald::calibration
