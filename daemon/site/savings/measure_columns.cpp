#include "daemon/site/savings/measure_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/model/parameter_library.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using savings::Change;
using savings::Measure;

/// The library's quantities have physical limits, others have none.
double possible(const std::string& name, double value) {
  const auto library = model::parameter_library();
  const auto known = std::ranges::find(library, name, &model::ParameterDefinition::name);
  return known == library.end() ? value : std::clamp(value, known->least, known->most);
}

ParameterConfig column_of(const Measure& measure, const Change& change) {
  if (change.targets.empty()) return {.name = change.parameter, .prior = {}, .source = {}};
  const double unchanged = change.kind == model::ChangeKind::scale ? 1.0 : 0.0;
  return {.name = measure.name,
          .prior = Prior{UniformPrior{unchanged, unchanged + 1.0}},  // columns are given, not drawn
          .source = {},
          .targets = change.targets,
          .change = change.kind};
}

}  // namespace

std::vector<std::span<const Measure>> alone_and_together(const std::vector<Measure>& measures) {
  std::vector<std::span<const Measure>> all;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    all.push_back(std::span{measures}.subspan(m, 1));
  }
  if (measures.size() > 1) all.emplace_back(measures);
  return all;
}

MeasureColumns::MeasureColumns(const ModelConfig& model, std::span<const Measure> measures)
    : parameters_{std::ssize(model.parameters)} {
  for (const Measure& measure : measures) {
    for (const Change& change : measure.changes) {
      const auto own =
          std::ranges::find(model.parameters, change.parameter, &ParameterConfig::name);
      const auto beside = std::ranges::find(beside_, change.parameter, &ParameterConfig::name);
      Index column = parameters_ + std::ssize(beside_);
      if (change.targets.empty() && own != model.parameters.end()) {
        column = own - model.parameters.begin();
      } else if (change.targets.empty() && beside != beside_.end() && beside->targets.empty()) {
        column = parameters_ + (beside - beside_.begin());
      } else {
        beside_.push_back(column_of(measure, change));
      }
      column_of_.push_back(column);
      changes_.push_back(change);
      if (change.by.is_certain()) continue;
      extents_.push_back({fmt::format("extent {} of {}", extents_.size() + 1, measure.name), "-",
                          Prior{change.by.min, change.by.mode, change.by.max}});
    }
  }
}

Eigen::MatrixXd MeasureColumns::changed(const Eigen::MatrixXd& theta,
                                        std::span<const double> designs) const {
  Eigen::MatrixXd rows(theta.rows(), std::ssize(designs));
  rows.leftCols(parameters_) = theta.leftCols(parameters_);
  for (Index j = parameters_; j < rows.cols(); ++j) {
    rows.col(j).setConstant(designs[static_cast<std::size_t>(j)]);
  }
  Index extent = parameters_;
  for (std::size_t c = 0; c < changes_.size(); ++c) {
    const Change& change = changes_[c];
    const Index drawn = change.by.is_certain() ? -1 : extent++;
    for (Index i = 0; i < rows.rows(); ++i) {
      const double by = drawn < 0 ? change.by.mode : theta(i, drawn);
      double& value = rows(i, column_of_[c]);
      // A column of targets is what is done to them.
      value = change.targets.empty()
                  ? possible(change.parameter, model::changed(change.kind, value, by))
                  : by;
    }
  }
  return rows;
}

}  // namespace recald::daemon
