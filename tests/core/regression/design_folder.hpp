/// Reads a folder of design runs.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/regression/design_data.hpp"

namespace recald::regression {

/// Header and rows, split at commas.
inline std::vector<std::vector<std::string>> read_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

/// `doe_inputs.csv`, `doe_outputs.csv` (or another prefix) and `inputs.csv` of a folder.
inline DesignData read_design(const std::filesystem::path& folder,
                              const std::string& prefix = "doe_") {
  DesignData design;
  const auto inputs = read_table(folder / (prefix + "inputs.csv"));
  design.parameters.assign(inputs[0].begin() + 1, inputs[0].end());
  design.theta.resize(static_cast<Eigen::Index>(inputs.size()) - 1,
                      static_cast<Eigen::Index>(design.parameters.size()));
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    for (std::size_t j = 1; j < inputs[i].size(); ++j) {
      design.theta(static_cast<Eigen::Index>(i) - 1, static_cast<Eigen::Index>(j) - 1) =
          std::stod(inputs[i][j]);
    }
  }
  const auto outputs = read_table(folder / (prefix + "outputs.csv"));
  design.outputs.assign(outputs[0].begin() + 2, outputs[0].end());
  std::map<std::string, Eigen::Index> month;
  for (std::size_t i = 1; i < outputs.size(); ++i) {
    if (month.try_emplace(outputs[i][1], static_cast<Eigen::Index>(month.size())).second) {
      design.months.push_back(outputs[i][1]);
    }
  }
  const Eigen::Index months = design.month_count();
  design.values.resize(design.runs(), months * static_cast<Eigen::Index>(design.outputs.size()));
  for (std::size_t i = 1; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < design.outputs.size(); ++k) {
      design.values(std::stol(outputs[i][0]) - 1,
                    static_cast<Eigen::Index>(k) * months + month[outputs[i][1]]) =
          std::stod(outputs[i][2 + k]);
    }
  }
  const auto weather = read_table(folder / "inputs.csv");
  design.inputs.assign(weather[0].begin() + 1, weather[0].end());
  design.month_inputs.resize(months, static_cast<Eigen::Index>(design.inputs.size()));
  for (std::size_t i = 1; i < weather.size(); ++i) {
    if (!month.contains(weather[i][0])) continue;
    for (std::size_t s = 1; s < weather[i].size(); ++s) {
      design.month_inputs(month[weather[i][0]], static_cast<Eigen::Index>(s) - 1) =
          std::stod(weather[i][s]);
    }
  }
  return design;
}

}  // namespace recald::regression
