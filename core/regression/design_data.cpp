#include "core/regression/design_data.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <span>
#include <string_view>

#include "core/regression/cross_products.hpp"
#include "core/regression/sweep.hpp"
#include "core/text/number_text.hpp"

namespace recald::regression {
namespace {

// Share of a parameter's variance that the others leave; below it nobody can tell them apart.
constexpr double kCollinear = 1e-8;

std::string quoted(const std::string& name) { return "'" + name + "'"; }

Result<void> check_names(const std::vector<std::string>& names, std::string_view kind) {
  std::set<std::string_view> seen;
  for (const auto& name : names) {
    if (!seen.insert(name).second) {
      return failure(ErrorCode::invalid_value,
                     std::string(kind) + " " + quoted(name) + " comes twice; rename one of them");
    }
  }
  return {};
}

Result<void> check_sizes(const DesignData& design) {
  if (design.parameters.empty() || design.outputs.empty() || design.months.empty()) {
    return failure(ErrorCode::not_enough_data,
                   "a design needs at least one parameter, one output and one month");
  }
  const auto needed = static_cast<Eigen::Index>(design.parameters.size()) + 2;
  if (design.runs() < needed) {
    return failure(ErrorCode::not_enough_data,
                   "the design has " + std::to_string(design.runs()) + " runs and " +
                       std::to_string(design.parameters.size()) + " parameters; at least " +
                       std::to_string(needed) + " runs are needed");
  }
  return {};
}

std::string missing_sentence(const std::string& what, const std::string& where, double value) {
  return what + " is " + (std::isnan(value) ? "missing" : "infinite") + " in " + where +
         "; complete the design or leave that run out";
}

Result<void> check_finite(const DesignData& design) {
  for (Eigen::Index r = 0; r < design.runs(); ++r) {
    const std::string run = "run " + std::to_string(r + 1);
    for (Eigen::Index j = 0; j < design.theta.cols(); ++j) {
      if (std::isfinite(design.theta(r, j))) continue;
      return failure(
          ErrorCode::not_finite,
          missing_sentence("parameter " + quoted(design.parameters[j]), run, design.theta(r, j)));
    }
    for (Eigen::Index c = 0; c < design.values.cols(); ++c) {
      if (std::isfinite(design.values(r, c))) continue;
      const Eigen::Index months = design.month_count();
      return failure(
          ErrorCode::not_finite,
          missing_sentence("output " + quoted(design.outputs[c / months]),
                           run + ", month " + design.months[c % months], design.values(r, c)));
    }
  }
  for (Eigen::Index i = 0; i < design.month_inputs.rows(); ++i) {
    for (Eigen::Index s = 0; s < design.month_inputs.cols(); ++s) {
      if (std::isfinite(design.month_inputs(i, s))) continue;
      return failure(ErrorCode::not_finite, "month input " + quoted(design.inputs[s]) +
                                                " has no number in month " + design.months[i] +
                                                "; fill it in or leave that input out");
    }
  }
  return {};
}

Result<void> check_spread(const Eigen::MatrixXd& columns, const std::vector<std::string>& names,
                          std::string_view kind, std::string_view remedy) {
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const double first = columns(0, j);
    if ((columns.col(j).array() != first).any()) continue;
    return failure(ErrorCode::invalid_value, std::string(kind) + " " + quoted(names[j]) + " is " +
                                                 number_text(first) + " throughout; " +
                                                 std::string(remedy));
  }
  return {};
}

Result<void> check_outputs(const DesignData& design) {
  for (std::size_t k = 0; k < design.outputs.size(); ++k) {
    const auto output = design.output(static_cast<Eigen::Index>(k));
    const double first = output(0, 0);
    if ((output.array() != first).any()) continue;
    return failure(ErrorCode::invalid_value, "output " + quoted(design.outputs[k]) + " is " +
                                                 number_text(first) +
                                                 " in all runs and months; leave it out");
  }
  return {};
}

Result<void> check_collinear(const DesignData& design) {
  const Eigen::MatrixXd theta = scale_columns(design.theta, column_scales(design.theta));
  SweptProducts swept(centre(cross_products(theta, Eigen::MatrixXd(theta.rows(), 0))));
  for (Eigen::Index j = 0; j < theta.cols(); ++j) {
    if (swept.free_share(j) < kCollinear) {
      return failure(ErrorCode::invalid_value,
                     "parameter " + quoted(design.parameters[j]) +
                         " is determined by the parameters before it in all runs, so their "
                         "effects cannot be told apart; leave one of them out or vary them "
                         "independently");
    }
    swept.toggle(j);
  }
  return {};
}

}  // namespace

Result<void> check_design(const DesignData& design) {
  assert(design.theta.cols() == static_cast<Eigen::Index>(design.parameters.size()));
  assert(design.values.rows() == design.runs());
  assert(design.values.cols() ==
         static_cast<Eigen::Index>(design.outputs.size()) * design.month_count());
  assert(design.inputs.empty() || design.month_inputs.rows() == design.month_count());
  assert(design.month_inputs.cols() == static_cast<Eigen::Index>(design.inputs.size()));
  for (auto check : {check_sizes, check_finite}) {
    if (auto good = check(design); !good) return good;
  }
  if (auto good = check_names(design.parameters, "parameter"); !good) return good;
  if (auto good = check_names(design.outputs, "output"); !good) return good;
  if (auto good = check_names(design.inputs, "month input"); !good) return good;
  if (auto good =
          check_spread(design.theta, design.parameters, "parameter", "vary it or leave it out");
      !good) {
    return good;
  }
  if (auto good = check_spread(design.month_inputs, design.inputs, "month input",
                               "it explains nothing, leave it out");
      !good) {
    return good;
  }
  if (auto good = check_outputs(design); !good) return good;
  return check_collinear(design);
}

Eigen::MatrixXd capped(Eigen::MatrixXd theta, std::span<const ParameterCap> caps) {
  for (const ParameterCap& cap : caps) {
    theta.col(cap.parameter) =
        theta.col(cap.parameter).array().min(theta.col(cap.under).array() - cap.gap);
  }
  return theta;
}

std::vector<ColumnScale> column_scales(const Eigen::MatrixXd& columns) {
  std::vector<ColumnScale> scales;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    scales.push_back({columns.col(j).minCoeff(), columns.col(j).maxCoeff()});
  }
  return scales;
}

Eigen::MatrixXd scale_columns(const Eigen::MatrixXd& columns,
                              const std::vector<ColumnScale>& scales) {
  assert(columns.cols() == static_cast<Eigen::Index>(scales.size()));
  Eigen::MatrixXd scaled(columns.rows(), columns.cols());
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const ColumnScale& scale = scales[static_cast<std::size_t>(j)];
    scaled.col(j) = (columns.col(j).array() - scale.min) / scale.range();
  }
  return scaled;
}

std::vector<ColumnScale> output_scales(const DesignData& design) {
  std::vector<ColumnScale> scales;
  for (std::size_t k = 0; k < design.outputs.size(); ++k) {
    const auto output = design.output(static_cast<Eigen::Index>(k));
    scales.push_back({output.minCoeff(), output.maxCoeff()});
  }
  return scales;
}

}  // namespace recald::regression
