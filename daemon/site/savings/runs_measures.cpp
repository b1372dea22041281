#include "daemon/site/savings/runs_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/design/model_runs.hpp"
#include "core/display/id_words.hpp"
#include "core/model/metamodel/builders.hpp"
#include "core/random/streams.hpp"
#include "daemon/site/calibrate/site_metamodel.hpp"
#include "daemon/site/savings/measure_runs.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using savings::Change;
using savings::Measure;

constexpr std::uint64_t kFoldSeed = 1;  // folds: the same answer whenever it is asked
/// Of the largest use of a month: less is a rounding of the runs' figures, and no change.
constexpr double kNoChange = 1e-6;

/// What one measure, or all of them, take off the outputs.
struct Difference {
  std::vector<Change> uncertain;
  std::vector<Parameter> columns;       ///< The model's parameters, then the uncertain extents.
  std::unique_ptr<MonthlyModel> model;  ///< Of the outputs that move; null: none does.
  std::vector<Index> outputs;           ///< Which those are.
  std::vector<double> error_sd;         ///< (those outputs) In units.
};

/// The rows of both with the same parameters: without minus with. (rows x k * m)
regression::DesignData difference_of(const regression::DesignData& without,
                                     const regression::DesignData& with) {
  const Index q = without.theta.cols();
  std::vector<Index> first;
  std::vector<Index> second;
  for (Index i = 0; i < with.theta.rows(); ++i) {
    for (Index j = 0; j < without.theta.rows(); ++j) {
      if (without.theta.row(j) != with.theta.row(i).head(q)) continue;
      first.push_back(j);
      second.push_back(i);
      break;
    }
  }
  regression::DesignData difference = with;
  difference.theta = with.theta(second, Eigen::all);
  difference.values = without.values(first, Eigen::all) - with.values(second, Eigen::all);
  return difference;
}

/// The outputs that a measure moves.
std::vector<Index> moved_outputs(const regression::DesignData& difference,
                                 const regression::DesignData& without) {
  std::vector<Index> moved;
  for (Index k = 0; k < std::ssize(difference.outputs); ++k) {
    const double least = kNoChange * without.output(k).cwiseAbs().maxCoeff();
    if (difference.output(k).cwiseAbs().maxCoeff() > least) moved.push_back(k);
  }
  return moved;
}

void keep_outputs(const std::vector<Index>& kept, regression::DesignData& data) {
  std::vector<Index> columns;
  std::vector<std::string> names;
  for (const Index k : kept) {
    names.push_back(data.outputs[static_cast<std::size_t>(k)]);
    for (Index i = 0; i < data.month_count(); ++i) columns.push_back(k * data.month_count() + i);
  }
  data.values = data.values(Eigen::all, columns).eval();
  data.outputs = std::move(names);
}

class RunsMeasures final : public MeasuredModel {
 public:
  RunsMeasures(const FinishedCalibration& finished, const std::vector<Measure>& measures,
               const ForEachIndex& executor)
      : result_{finished.calibration}, measures_{measures}, executor_{executor} {
    const auto& all = result_.design->folder.parameters;
    for (std::size_t j = 0; j < all.size(); ++j) {
      const auto place = std::ranges::find(result_.parameters, all[j].name, &Parameter::name);
      (place == result_.parameters.end() ? held_ : free_).push_back(static_cast<Index>(j));
    }
    months_ = result_.with->problem.month_names;
  }

  /// Call it once, before anything else.
  Result<void> fit(const ModelledSite& modelled) {
    auto plain = model::metamodel::model_of(*result_.design->fitted.monthly_form, months_);
    if (!plain) return tl::unexpected(plain.error());
    plain_ = std::make_unique<model::metamodel::QuadraticModel>(std::move(*plain));
    const auto without = data_in_site_months(modelled, result_, result_.design->folder);
    if (!without) return tl::unexpected(without.error());
    for (const std::span<const Measure> some : alone_and_together(measures_)) {
      auto difference = fit_difference(modelled, some, *without);
      if (!difference) return tl::unexpected(difference.error());
      differences_.push_back(std::move(*difference));
    }
    return {};
  }

  [[nodiscard]] MatrixXd buildings(const MatrixXd& theta, Rng& rng) const override {
    MatrixXd columns(theta.rows(), theta.cols() + std::ssize(held_));
    columns.leftCols(theta.cols()) = theta;
    for (std::size_t h = 0; h < held_.size(); ++h) {
      const Prior& prior = parameter(held_[h]).prior;
      for (double& value : columns.col(theta.cols() + static_cast<Index>(h))) {
        value = prior.quantile(rng.uniform());
      }
    }
    return columns;
  }

  [[nodiscard]] Index calibrated() const override { return std::ssize(free_); }

  /// A regression says nothing beyond its runs.
  [[nodiscard]] std::vector<savings::Limits> limits() const override {
    std::vector<savings::Limits> limits;
    for (const Parameter& one : result_.parameters) {
      limits.push_back({one.prior.min(), one.prior.max()});
    }
    return limits;
  }

  /// What is not calibrated stays at its prior's mean, as in the calibration.
  [[nodiscard]] Result<MatrixXd> run(const MatrixXd& buildings) const override {
    MatrixXd all = in_order_of_design(buildings);
    for (const Index j : held_) all.col(j).setConstant(parameter(j).prior.mean());
    return design::run_model(*plain_, result_.design->folder.parameters, all, executor_);
  }

  [[nodiscard]] Result<MatrixXd> run_with(const MatrixXd& buildings, const MatrixXd& before,
                                          const AchievedDraws& achieved,
                                          std::optional<std::size_t> measure,
                                          Rng& rng) const override {
    const Difference& difference = measure ? differences_[*measure] : differences_.back();
    if (!difference.model) return before;
    const Index q = std::ssize(result_.design->folder.parameters);
    MatrixXd columns(buildings.rows(), std::ssize(difference.columns));
    columns.leftCols(q) = in_order_of_design(buildings);
    Index next = q;
    for (std::size_t m = 0; m < measures_.size(); ++m) {
      if (measure && m != *measure) continue;
      for (std::size_t c = 0; c < measures_[m].changes.size(); ++c) {
        if (!measures_[m].changes[c].by.is_certain()) columns.col(next++) = achieved[m][c];
      }
    }
    const auto saved = design::run_model(*difference.model, difference.columns, columns, executor_);
    if (!saved) return tl::unexpected(saved.error());
    MatrixXd after = before;
    const auto months = std::ssize(months_);
    for (std::size_t k = 0; k < difference.outputs.size(); ++k) {
      auto of_output = after.middleCols(difference.outputs[k] * months, months);
      of_output -= saved->middleCols(static_cast<Index>(k) * months, months);
      for (Index d = 0; d < after.rows(); ++d) {
        of_output.row(d).array() += difference.error_sd[k] * rng.normal();
      }
    }
    return after;
  }

  [[nodiscard]] std::vector<std::string> unknowns(const Measure& measure) const override {
    std::vector<std::string> sentences;
    for (const Change& change : measure.changes) {
      const auto place = std::ranges::find(result_.parameters, change.parameter, &Parameter::name);
      if (change.parameter.empty() || place == result_.parameters.end()) continue;
      const auto j = static_cast<std::size_t>(place - result_.parameters.begin());
      if (assessment::is_identified(result_, j)) continue;
      sentences.push_back(
          fmt::format("{}: the meters do not settle what it is today, so its prior stands.",
                      display::capitalised(display::parameter_words(change.parameter))));
    }
    return sentences;
  }

 private:
  [[nodiscard]] const Parameter& parameter(Index j) const {
    return result_.design->folder.parameters[static_cast<std::size_t>(j)];
  }

  /// From `buildings`, which has what is held behind what is calibrated.
  [[nodiscard]] MatrixXd in_order_of_design(const MatrixXd& buildings) const {
    MatrixXd all(buildings.rows(), buildings.cols());
    for (std::size_t j = 0; j < free_.size(); ++j) {
      all.col(free_[j]) = buildings.col(static_cast<Index>(j));
    }
    for (std::size_t h = 0; h < held_.size(); ++h) {
      all.col(held_[h]) = buildings.col(static_cast<Index>(free_.size() + h));
    }
    return all;
  }

  [[nodiscard]] Result<Difference> fit_difference(const ModelledSite& modelled,
                                                  std::span<const Measure> measures,
                                                  const regression::DesignData& without) const {
    auto design = doe::read_design_folder(measure_folder(*modelled.site.config.model, measures));
    if (!design) return tl::unexpected(design.error());
    Difference difference{.uncertain = uncertain(changes_of(measures)),
                          .columns = design->parameters,
                          .model = nullptr,
                          .outputs = {},
                          .error_sd = {}};
    const auto with = data_in_site_months(modelled, result_, std::move(*design));
    if (!with) return tl::unexpected(with.error());
    regression::DesignData data = difference_of(without, *with);
    difference.outputs = moved_outputs(data, without);
    if (difference.outputs.empty()) return difference;
    keep_outputs(difference.outputs, data);
    Rng rng{kFoldSeed, streams::kFolds.first};
    const auto form = regression::fit_monthly_form(data, {}, rng);
    if (!form) return tl::unexpected(form.error());
    auto model = model::metamodel::model_of(*form, months_);
    if (!model) return tl::unexpected(model.error());
    difference.model = std::make_unique<model::metamodel::QuadraticModel>(std::move(*model));
    for (const auto& output : form->quality.outputs) difference.error_sd.push_back(output.sigma_r);
    return difference;
  }

  const SiteCalibration& result_;
  const std::vector<Measure>& measures_;
  const ForEachIndex& executor_;
  std::vector<std::string> months_;  ///< Of the calibration.
  std::vector<Index> free_;          ///< Calibrated parameters, by their place in the design …
  std::vector<Index> held_;          ///< … and the others.
  std::unique_ptr<MonthlyModel> plain_;
  std::vector<Difference> differences_;  ///< As `alone_and_together`.
};

}  // namespace

Result<std::unique_ptr<MeasuredModel>> make_runs_measures(const FinishedCalibration& finished,
                                                          const std::vector<Measure>& measures,
                                                          const ForEachIndex& executor) {
  auto model = std::make_unique<RunsMeasures>(finished, measures, executor);
  if (auto fitted = model->fit(finished.modelled); !fitted) return tl::unexpected(fitted.error());
  return model;
}

}  // namespace recald::daemon
