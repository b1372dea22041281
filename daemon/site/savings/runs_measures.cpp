#include "daemon/site/savings/runs_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "core/design/model_runs.hpp"
#include "core/display/id_words.hpp"
#include "core/model/metamodel/builders.hpp"
#include "daemon/site/calibrate/design_outliers.hpp"
#include "daemon/site/calibrate/site_on_runs.hpp"
#include "daemon/site/savings/measure_columns.hpp"
#include "daemon/site/savings/measure_runs.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using savings::Change;
using savings::Measure;

/// Of the largest use of a month: less is a rounding of the runs' figures, and no change.
constexpr double kNoChange = 1e-6;

/// What one measure, or all of them, take off the outputs.
struct Difference {
  std::vector<Parameter> columns;  ///< The model's parameters, then the extents that are not known.
  std::unique_ptr<MonthlyModel> model;  ///< Of the outputs that move; null: none does.
  std::vector<Index> outputs;           ///< Which those are.
  std::vector<double> error_sd;         ///< (those outputs) In units.
};

/// Runs with a measure and the same runs without.
struct PairedRuns {
  doe::DesignFolder without;
  doe::DesignFolder with;
  std::vector<Index> rows_without;
  std::vector<Index> rows_with;
};

Result<PairedRuns> pair_runs(const ModelConfig& model, std::span<const Measure> measures) {
  auto without = TRY(doe::read_design_folder(model.energyplus->design));
  auto with = TRY(doe::read_design_folder(measure_folder(model, measures)));
  set_aside_outliers(without);
  set_aside_outliers(with);
  PairedRuns pairs{std::move(without), std::move(with), {}, {}};
  const Index q = pairs.without.theta.cols();
  for (Index i = 0; i < pairs.with.theta.rows(); ++i) {
    for (Index j = 0; j < pairs.without.theta.rows(); ++j) {
      if (pairs.without.theta.row(j) != pairs.with.theta.row(i).head(q)) continue;
      pairs.rows_without.push_back(j);
      pairs.rows_with.push_back(i);
      break;
    }
  }
  const Index least = pairs.with.theta.cols() + 2;
  if (std::ssize(pairs.rows_with) >= least) return pairs;
  return failure(ErrorCode::not_enough_data,
                 fmt::format("{} runs with '{}' can be compared with those without, and {} are "
                             "needed; make more runs of fewer parameters, or see why they failed "
                             "in {}",
                             pairs.rows_with.size(), measures.front().name, least,
                             (pairs.with.folder / "failed.csv").string()));
}

MatrixXd stacked(const MatrixXd& above, const MatrixXd& below) {
  MatrixXd both(above.rows() + below.rows(), above.cols());
  both << above, below;
  return both;
}

/// Both as one design, those without first: months that were not simulated are then predicted in
/// one way, and what it is wrong by cancels.
doe::DesignFolder as_one(const PairedRuns& pairs) {
  doe::DesignFolder both = pairs.with;
  const MatrixXd theta = pairs.with.theta(pairs.rows_with, Eigen::all);
  both.theta = stacked(theta, theta);
  both.outputs = stacked(pairs.without.outputs(pairs.rows_without, Eigen::all),
                         pairs.with.outputs(pairs.rows_with, Eigen::all));
  both.runs.resize(static_cast<std::size_t>(both.theta.rows()));
  std::iota(both.runs.begin(), both.runs.end(), 1);
  return both;
}

Result<doe::DesignDays> days_as_one(const PairedRuns& pairs) {
  auto without = doe::read_design_days(pairs.without);
  if (!without) return without;
  const auto with = TRY(doe::read_design_days(pairs.with));
  without->values = stacked(without->values(pairs.rows_without, Eigen::all),
                            with.values(pairs.rows_with, Eigen::all));
  return without;
}

/// Takes the outputs out that a measure does not move. @return those that it does
std::vector<Index> keep_moved(const regression::DesignData& both,
                              regression::DesignData& difference) {
  std::vector<Index> moved;
  std::vector<Index> columns;
  std::vector<std::string> names;
  for (Index k = 0; k < std::ssize(difference.outputs); ++k) {
    const double least = kNoChange * both.output(k).cwiseAbs().maxCoeff();
    if (difference.output(k).cwiseAbs().maxCoeff() <= least) continue;
    moved.push_back(k);
    names.push_back(difference.outputs[static_cast<std::size_t>(k)]);
    for (Index i = 0; i < both.month_count(); ++i) columns.push_back(k * both.month_count() + i);
  }
  difference.values = difference.values(Eigen::all, columns).eval();
  difference.outputs = std::move(names);
  return moved;
}

constexpr auto kMeasuresRun = calibration::Progress::Stage::predicting;

class RunsMeasures final : public MeasuredModel {
 public:
  RunsMeasures(const FinishedCalibration& finished, const std::vector<Measure>& measures,
               const calibration::RunContext& context)
      : result_{finished.calibration}, measures_{measures}, context_{context} {
    const auto& all = result_.design->folder.parameters;
    for (std::size_t j = 0; j < all.size(); ++j) {
      const auto place = std::ranges::find(result_.parameters, all[j].name, &Parameter::name);
      (place == result_.parameters.end() ? held_ : free_).push_back(static_cast<Index>(j));
    }
    months_ = result_.with->problem.month_names;
  }

  /// Call it once, before anything else.
  Result<void> fit(const ModelledSite& modelled) {
    auto plain = TRY(model::metamodel::model_of(*result_.design->fitted.monthly_form, months_));
    plain_ = plain.clone();
    for (const std::span<const Measure> some : alone_and_together(measures_)) {
      auto difference = TRY(fit_difference(modelled, some));
      differences_.push_back(std::move(difference));
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

  /// A meta-model says nothing beyond its runs.
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
    return design::run_model(*plain_, result_.design->folder.parameters, all, context_.executor,
                             calibration::of_runs(context_, kMeasuresRun));
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
    const auto saved =
        TRY(design::run_model(*difference.model, difference.columns, columns, context_.executor,
                              calibration::of_runs(context_, kMeasuresRun)));
    MatrixXd after = before;
    const auto months = std::ssize(months_);
    for (std::size_t k = 0; k < difference.outputs.size(); ++k) {
      auto of_output = after.middleCols(difference.outputs[k] * months, months);
      of_output -= saved.middleCols(static_cast<Index>(k) * months, months);
      for (Index d = 0; d < after.rows(); ++d) {
        of_output.row(d).array() += difference.error_sd[k] * rng.normal();
      }
    }
    return after;
  }

  [[nodiscard]] std::vector<std::string> unknowns(const Measure& measure) const override {
    std::set<std::string> sentences;
    for (const Change& change : measure.changes) sentences.insert(unknown_of(change));
    sentences.erase("");
    return {sentences.begin(), sentences.end()};
  }

 private:
  [[nodiscard]] const Parameter& parameter(Index j) const {
    return result_.design->folder.parameters[static_cast<std::size_t>(j)];
  }

  /// What is not known of what a change begins with; empty: the meters tell it.
  [[nodiscard]] std::string unknown_of(const Change& change) const {
    if (!change.targets.empty()) return "";
    const std::string label = display::capitalised(display::parameter_words(change.parameter));
    const auto free = std::ranges::find(result_.parameters, change.parameter, &Parameter::name);
    if (free != result_.parameters.end()) {
      const auto j = static_cast<std::size_t>(free - result_.parameters.begin());
      return assessment::is_identified(result_, j) ? "" : prior_stands(label);
    }
    const auto& all = result_.design->folder.parameters;
    const auto held = std::ranges::find(all, change.parameter, &Parameter::name);
    return held == all.end()
               ? fmt::format(
                     "{} is no parameter of the site file: it is taken as the model has it.", label)
               : drawn_from(label, held->prior);
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
                                                  std::span<const Measure> measures) const {
    const auto pairs = TRY(pair_runs(*modelled.site.config.model, measures));
    const auto both = TRY(
        data_in_site_months(modelled, result_, as_one(pairs),
                            [&](const doe::DesignFolder& /*both*/) { return days_as_one(pairs); }));
    regression::DesignData data = both;
    const Index runs = both.runs() / 2;
    data.theta = both.theta.topRows(runs);
    data.values = both.values.topRows(runs) - both.values.bottomRows(runs);
    Difference difference{.columns = pairs.with.parameters, .model = nullptr};
    difference.outputs = keep_moved(both, data);
    if (difference.outputs.empty()) return difference;
    const auto form = TRY(regression::fit_monthly_form(data));
    auto model = TRY(model::metamodel::model_of(form, months_));
    difference.model = model.clone();
    for (const auto& output : form.quality.outputs) difference.error_sd.push_back(output.sigma_r);
    return difference;
  }

  const SiteCalibration& result_;
  const std::vector<Measure>& measures_;
  const calibration::RunContext& context_;
  std::vector<std::string> months_;  ///< Of the calibration.
  std::vector<Index> free_;          ///< Calibrated parameters, by their place in the design …
  std::vector<Index> held_;          ///< … and the others.
  std::unique_ptr<MonthlyModel> plain_;
  std::vector<Difference> differences_;  ///< As `alone_and_together`.
};

}  // namespace

Result<std::unique_ptr<MeasuredModel>> make_runs_measures(const FinishedCalibration& finished,
                                                          const std::vector<Measure>& measures,
                                                          const calibration::RunContext& context) {
  auto model = std::make_unique<RunsMeasures>(finished, measures, context);
  TRY(model->fit(finished.modelled));
  return model;
}

}  // namespace recald::daemon
