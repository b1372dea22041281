/// Reader of the seedcase folder: a synthetic case of the seed's size with a given meta-model.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/calibration/normalisation.hpp"
#include "core/calibration/posterior.hpp"
#include "core/calibration/problem.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"

namespace recald::calibration {

inline std::filesystem::path seedcase_folder() {
  const char* data = std::getenv("RECALD_DATA");
  return std::filesystem::path(data != nullptr ? data : RECALD_DATA_DEFAULT) / "seedcase";
}

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

/// Given regression on scaled inputs: columns drybulb, rh, winddir, windspeed, out, then theta.
class RegressionModel final : public MonthlyModel {
 public:
  RegressionModel(const std::vector<std::vector<std::string>>& terms, Eigen::MatrixXd weather)
      : weather_(std::move(weather)) {
    for (const auto& row : terms) {
      const auto colon = row[0].find(':');
      const double coefficient = std::stod(row[1]);
      if (row[0] == "(Intercept)") {
        terms_.push_back({-1, -1, coefficient});
      } else if (colon == std::string::npos) {
        terms_.push_back({column(row[0]), -1, coefficient});
      } else {
        terms_.push_back(
            {column(row[0].substr(0, colon)), column(row[0].substr(colon + 1)), coefficient});
      }
    }
  }

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<RegressionModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 6; }
  [[nodiscard]] int output_count() const override { return 2; }
  [[nodiscard]] int month_count() const override { return static_cast<int>(weather_.rows()); }

  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    std::copy(theta.begin(), theta.end(), d_.begin() + 5);
    for (int out = 0; out < 2; ++out) {
      d_[4] = out;
      for (Eigen::Index i = 0; i < weather_.rows(); ++i) {
        for (std::size_t s = 0; s < 4; ++s) d_[s] = weather_(i, static_cast<Eigen::Index>(s));
        double sum = 0.0;
        for (const auto& [a, b, coefficient] : terms_) {
          sum += coefficient * (a < 0 ? 1.0 : at(a)) * (b < 0 ? 1.0 : at(b));
        }
        outputs[static_cast<std::size_t>(out * weather_.rows() + i)] = sum;
      }
    }
  }

 private:
  struct Term {
    int a;
    int b;
    double coefficient;
  };

  [[nodiscard]] double at(int column) const { return d_[static_cast<std::size_t>(column)]; }

  static int column(const std::string& name) {
    static const std::map<std::string, int> columns{
        {"drybulb", 0},   {"rh", 1},       {"winddir", 2},    {"windspeed", 3},
        {"out", 4},       {"t_cool", 5},   {"occ_office", 6}, {"occ_class", 7},
        {"oa_office", 8}, {"oa_class", 9}, {"oa_lab", 10}};
    return columns.at(name);
  }

  Eigen::MatrixXd weather_;
  std::vector<Term> terms_;
  std::array<double, 11> d_{};
};

/// Everything on the scaled axes of the case's own statement: theta in (0, 1), outputs normalised.
struct Seedcase {
  std::vector<Parameter> parameters;
  std::unique_ptr<RegressionModel> model;
  PosteriorData data;
  double pooled_variance;
};

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
  c.model =
      std::make_unique<RegressionModel>(read_rows(folder / "metamodel.csv"), c.data.month_inputs);
  return c;
}

}  // namespace recald::calibration
