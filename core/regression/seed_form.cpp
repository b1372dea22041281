#include "core/regression/seed_form.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/regression/folds.hpp"
#include "core/regression/long_form.hpp"

namespace recald::regression {
namespace {

constexpr const char* kWindDirection = "winddir";
constexpr const char* kOutputType = "out";
// BIC replaces the seed's AIC where it leaves less than this of AIC's left-out squared error.
constexpr double kClearlyBetter = 0.95;

/// Everything the meters of one design share.
struct Shared {
  const DesignData& design;
  const SeedFormOptions& options;
  Eigen::MatrixXd inputs;   ///< (months x columns) scaled.
  Eigen::MatrixXd theta;    ///< (runs x q) scaled.
  Eigen::MatrixXd outputs;  ///< (runs x k * months) normalised.
  RunFolds folds;
};

/// The columns of a meter that vary over its cells: inputs, and the type where there are two.
Eigen::MatrixXd cell_variables(const Eigen::MatrixXd& inputs, int types) {
  Eigen::MatrixXd cells(types * inputs.rows(), inputs.cols() + (types > 1 ? 1 : 0));
  for (int type = 0; type < types; ++type) {
    auto block = cells.middleRows(type * inputs.rows(), inputs.rows());
    block.leftCols(inputs.cols()) = inputs;
    if (types > 1) block.rightCols<1>().setConstant(type);
  }
  return cells;
}

/// All terms, or, where the runs cannot carry them, all but the products of parameters alone: these
/// vary over runs only, so the many rows of a run do not help to tell them apart.
std::vector<int> start_terms(const Shared& shared, std::span<const Term> terms,
                             int cell_variables) {
  const Eigen::Index q = shared.theta.cols();
  const bool all = 2 * (q + q * (q - 1) / 2) <= shared.theta.rows();
  std::vector<int> start;
  for (std::size_t j = 0; j < terms.size(); ++j) {
    const bool of_runs = !terms[j].is_main_effect() && terms[j].first >= cell_variables &&
                         terms[j].second >= cell_variables;
    if (all || !of_runs) start.push_back(static_cast<int>(j));
  }
  return start;
}

/// One meter's rows and the terms to choose from.
struct MeterProblem {
  MeterOutputs outputs;
  std::vector<std::string> variables;
  std::vector<Term> terms;
  std::vector<Parents> parents;
  std::vector<int> start;
  Eigen::MatrixXd responses;  ///< (runs x cells)
  LongForm rows;
};

MeterProblem make_problem(const Shared& shared, const MeterOutputs& outputs,
                          std::vector<std::string> variables) {
  const std::vector<int> types = outputs.existing();
  const Eigen::Index months = shared.design.month_count();
  Eigen::MatrixXd responses(shared.theta.rows(), static_cast<Eigen::Index>(types.size()) * months);
  for (std::size_t i = 0; i < types.size(); ++i) {
    responses.middleCols(static_cast<Eigen::Index>(i) * months, months) =
        shared.outputs.middleCols(types[i] * months, months);
  }
  const Eigen::MatrixXd cells = cell_variables(shared.inputs, static_cast<int>(types.size()));
  std::vector<Term> terms = all_terms(static_cast<int>(variables.size()), false);
  std::vector<Parents> parents = parents_of(terms);
  std::vector<int> start = start_terms(shared, terms, static_cast<int>(cells.cols()));
  LongForm rows(cells, shared.theta, terms, responses);
  return {outputs,          std::move(variables), std::move(terms), std::move(parents),
          std::move(start), std::move(responses), std::move(rows)};
}

/// A choice of terms and its predictions, (runs x cells) each.
struct MeterFit {
  Criterion criterion;
  StepwiseFit fit;
  Eigen::MatrixXd fitted;
  Eigen::MatrixXd left_out;
  double left_out_squares;
};

Result<MeterFit> fit_by(Criterion criterion, const MeterProblem& problem, const RunFolds& folds) {
  StepwiseOptions options;
  options.criterion = criterion;
  options.start = StepwiseOptions::Start::given;
  options.given_columns = problem.start;
  const CrossProducts total = problem.rows.products();
  auto fit = TRY(stepwise(centre(total), problem.parents, options));
  MeterFit result{criterion, std::move(fit), problem.responses, problem.responses, 0.0};
  for (int f = 0; f < folds.count(); ++f) {
    const std::vector<int> out(folds.left_out(f).begin(), folds.left_out(f).end());
    CrossProducts kept = total;
    kept -= problem.rows.products(out);
    const auto fold_fit = TRY(stepwise(centre(kept), problem.parents, options));
    result.left_out(out, Eigen::all) = problem.rows.predict(fold_fit, out);
    result.fitted(out, Eigen::all) = problem.rows.predict(result.fit, out);
  }
  result.left_out_squares = (problem.responses - result.left_out).squaredNorm();
  return result;
}

Result<MeterFit> fit_meter(const Shared& shared, const MeterProblem& problem) {
  auto fit = fit_by(shared.options.criterion.value_or(Criterion::aic), problem, shared.folds);
  if (!fit || shared.options.criterion) return fit;
  auto sparer = fit_by(Criterion::bic, problem, shared.folds);
  if (!sparer) return sparer;
  return sparer->left_out_squares < kClearlyBetter * fit->left_out_squares ? sparer : fit;
}

SeedFormMeter describe(const MeterProblem& problem, const MeterFit& chosen) {
  const StepwiseFit& fit = chosen.fit;
  const double aic = information_criterion(Criterion::aic, fit.residual_squares(0),
                                           static_cast<double>(problem.responses.size()), 1.0,
                                           static_cast<int>(fit.columns.size()));
  SeedFormMeter meter{problem.outputs,
                      problem.variables,
                      {},
                      fit.intercepts(0),
                      fit.coefficients.col(0),
                      chosen.criterion,
                      aic,
                      0,
                      {}};
  meter.candidates = static_cast<int>(problem.terms.size());
  for (const int column : fit.columns) {
    meter.terms.push_back(problem.terms[static_cast<std::size_t>(column)]);
  }
  for (const int column : fit.aliased) {
    meter.aliased.push_back(
        term_name(problem.terms[static_cast<std::size_t>(column)], problem.variables));
  }
  return meter;
}

/// A meter's cells to the columns of its outputs.
void scatter(const Eigen::MatrixXd& cells, const std::vector<int>& outputs, Eigen::Index months,
             Eigen::MatrixXd& all) {
  for (std::size_t type = 0; type < outputs.size(); ++type) {
    all.middleCols(outputs[type] * months, months) =
        cells.middleCols(static_cast<Eigen::Index>(type) * months, months);
  }
}

Result<void> check_inputs(const DesignData& design, const NamedColumns& columns) {
  if (design.inputs.empty()) {
    return failure(ErrorCode::not_enough_data,
                   "the seed's form of the meta-model needs month inputs such as the mean dry "
                   "bulb; provide inputs.csv or use the monthly form");
  }
  for (const auto& name : columns.names) {
    if (name != kOutputType) continue;
    return failure(ErrorCode::invalid_value,
                   "a month input cannot be called 'out', because the meta-model uses that name "
                   "for the output type");
  }
  const auto needed = static_cast<Eigen::Index>(columns.names.size()) + 2;
  if (design.month_count() < needed) {
    return failure(
        ErrorCode::not_enough_data,
        "the design covers " + std::to_string(design.month_count()) + " months; with " +
            std::to_string(columns.names.size()) +
            " columns of month inputs the seed's form of the meta-model needs at least " +
            std::to_string(needed) + "; remove inputs or use the monthly form");
  }
  return {};
}

}  // namespace

NamedColumns input_columns(const std::vector<std::string>& inputs,
                           const Eigen::MatrixXd& month_inputs, bool wind_in_degrees) {
  assert(month_inputs.cols() == static_cast<Eigen::Index>(inputs.size()));
  NamedColumns columns;
  columns.values.resize(month_inputs.rows(), 0);
  const auto add = [&columns](std::string name, const Eigen::VectorXd& values) {
    columns.names.push_back(std::move(name));
    columns.values.conservativeResize(values.size(), columns.values.cols() + 1);
    columns.values.rightCols<1>() = values;
  };
  for (std::size_t s = 0; s < inputs.size(); ++s) {
    const Eigen::VectorXd values = month_inputs.col(static_cast<Eigen::Index>(s));
    if (inputs[s] == kWindDirection && !wind_in_degrees) {
      const Eigen::ArrayXd radians = values.array() * (std::numbers::pi / 180.0);
      add(inputs[s] + "_sin", radians.sin());
      add(inputs[s] + "_cos", radians.cos());
    } else {
      add(inputs[s], values);
    }
  }
  return columns;
}

Result<SeedForm> fit_seed_form(const DesignData& design, const SeedFormOptions& options, Rng& rng) {
  TRY(check_design(design));
  NamedColumns columns = input_columns(design.inputs, design.month_inputs, options.wind_in_degrees);
  TRY(check_inputs(design, columns));
  SeedForm form;
  form.parameters = design.parameters;
  form.parameter_scales = column_scales(design.theta);
  form.inputs = design.inputs;
  form.wind_in_degrees = options.wind_in_degrees;
  form.input_columns = {columns.names, column_scales(columns.values)};
  form.outputs = design.outputs;
  form.output_scales = output_scales(design);

  const Shared shared{design,
                      options,
                      scale_columns(columns.values, form.input_columns.scales),
                      scale_columns(design.theta, form.parameter_scales),
                      normalise_outputs(design, form.output_scales),
                      RunFolds(static_cast<int>(design.runs()), options.folds, rng)};
  Eigen::MatrixXd fitted = shared.outputs;
  Eigen::MatrixXd left_out = shared.outputs;
  for (const MeterOutputs& outputs : group_by_meter(design.outputs)) {
    std::vector<std::string> variables = columns.names;
    if (outputs.existing().size() > 1) variables.emplace_back(kOutputType);
    variables.insert(variables.end(), design.parameters.begin(), design.parameters.end());
    const MeterProblem problem = make_problem(shared, outputs, std::move(variables));
    const auto fit = TRY(fit_meter(shared, problem));
    form.meters.push_back(describe(problem, fit));
    scatter(fit.fitted, outputs.existing(), design.month_count(), fitted);
    scatter(fit.left_out, outputs.existing(), design.month_count(), left_out);
  }
  form.quality = assess_fit(design, form.output_scales, fitted, left_out);
  return form;
}

}  // namespace recald::regression
