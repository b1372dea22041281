#include "daemon/site/calibrate/design_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "adapters/csv/fields.hpp"
#include "adapters/doe/metamodel_file.hpp"
#include "core/absent.hpp"
#include "core/assessment/common_errors.hpp"
#include "core/assessment/given_data.hpp"
#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"
#include "core/model/model_adaptors.hpp"
#include "core/random/streams.hpp"
#include "core/text/nearest.hpp"

namespace recald::daemon {
namespace {

using assessment::MonthRole;
using model::metamodel::MonthInputs;
using model::metamodel::QuadraticModel;

/// What a calibration needs to know of a meta-model, however it was come by.
struct Metamodel {
  std::unique_ptr<MonthlyModel> calibration;  ///< The design's months.
  std::unique_ptr<MonthlyModel> whole;        ///< The design's months, then those that validate.
  Eigen::VectorXd sigma_calibration;          ///< (outputs * months), or empty: free of error.
  std::vector<double> sigma_validation;       ///< (outputs)
  calibration::ModelInputs inputs;            ///< Of all months, for the discrepancy.
  assessment::MetamodelFacts facts;
};

std::unique_ptr<MonthlyModel> on_heap(QuadraticModel model) {
  return std::make_unique<QuadraticModel>(std::move(model));
}

/// Consumption 0, peak 1: the only two types that one given regression tells apart.
Result<void> check_given_outputs(const std::vector<std::string>& outputs) {
  const auto meters = regression::group_by_meter(outputs);
  const bool in_order = meters.size() == 1 && meters.front().consumption <= 0 &&
                        meters.front().existing().size() == outputs.size();
  if (in_order) return {};
  return failure(ErrorCode::unsupported,
                 fmt::format("a given meta-model describes the consumption and the peak of one "
                             "meter, in this order, but the design has {}",
                             fmt::join(outputs, ", ")));
}

Result<std::vector<regression::ColumnScale>> scales_of_priors(
    const std::vector<Parameter>& parameters) {
  for (const Parameter& p : parameters) {
    if (std::isfinite(p.prior.min()) && std::isfinite(p.prior.max())) continue;
    return failure(ErrorCode::unsupported,
                   fmt::format("a given meta-model needs the prior of '{}' to have both ends: they "
                               "are what it calls 0 and 1",
                               p.name));
  }
  return model::metamodel::prior_scales(parameters);
}

Result<Metamodel> given_metamodel(const std::filesystem::path& file,
                                  const doe::DesignFolder& design, const MonthInputs& covered,
                                  const MonthInputs& all) {
  auto terms = TRY(doe::read_metamodel(file));
  TRY(check_given_outputs(design.output_names));
  auto parameter_scales = TRY(scales_of_priors(design.parameters));
  model::metamodel::GivenRegression given;
  given.terms = std::move(terms);
  for (const Parameter& parameter : design.parameters) given.parameters.push_back(parameter.name);
  given.parameter_scales = std::move(parameter_scales);
  given.inputs = covered.names;
  given.input_scales = regression::column_scales(covered.values);
  given.output_scales = regression::output_scales(design_data(design));
  const auto model_over = [&](const MonthInputs& months) -> Result<std::unique_ptr<MonthlyModel>> {
    auto model = model::metamodel::model_of(given, months);
    if (model) return on_heap(std::move(*model));
    return failure(model.error().code,
                   fmt::format("'{}': {}", file.string(), model.error().message));
  };
  auto calibration = TRY(model_over(covered));
  auto whole = TRY(model_over(all));
  Metamodel result;
  result.calibration = std::move(calibration);
  result.whole = std::move(whole);
  result.inputs = {all.names, all.values};
  result.facts = {.form = "given",
                  .why = fmt::format("'{}', taken as it is and as free of error.", file.string())};
  return result;
}

/// The months after the design's, for which only the seed's form has an answer.
MonthInputs after_design(const MonthInputs& all, std::size_t covered) {
  const auto n = static_cast<Eigen::Index>(covered);
  return {all.names,
          {all.months.begin() + static_cast<std::ptrdiff_t>(covered), all.months.end()},
          all.values.bottomRows(all.values.rows() - n)};
}

Result<Metamodel> metamodel_of(const FittedMetamodel& fitted, const MetamodelOptions& options,
                               const MonthInputs& covered, const MonthInputs& all) {
  auto calibration = TRY(model_over(fitted, covered));
  Metamodel result;
  result.whole = calibration->clone();
  result.calibration = std::move(calibration);
  result.sigma_calibration = fitted.error_sd();
  const MonthInputs later = after_design(all, covered.months.size());
  if (!later.months.empty()) {
    auto validation = TRY(model::metamodel::model_of(*fitted.seed_form, later));
    result.whole = std::make_unique<JoinedMonthsModel>(std::move(result.whole),
                                                       on_heap(std::move(validation)));
    result.sigma_validation = fitted.sigma_r(MetamodelForm::seed);
  }
  const auto columns = regression::input_columns(all.names, all.values, options.wind_in_degrees);
  result.inputs = {columns.names, columns.values};
  result.facts = {.form = std::string{to_string(fitted.form)},
                  .why = fitted.why,
                  .r2_left_out = fitted.quality().all.r2_left_out,
                  .sigma_r = fitted.sigma_r(fitted.form)};
  return result;
}

/// Measured months that the design does not cover, ascending.
std::vector<doe::DesignMonth> validation_months(const doe::DesignFolder& design,
                                                const doe::MonthlyTable& measured) {
  std::vector<doe::DesignMonth> months;
  for (const doe::DesignMonth month : measured.months) {
    if (!std::ranges::binary_search(design.months, month)) months.push_back(month);
  }
  return months;
}

/// kWh a day and kW by the names that the contract gives to outputs; nothing for other names.
std::string unit_of(const std::string& output) {
  std::string lower;
  for (const char c : output) lower += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (lower.ends_with("daily_kwh")) return "kWh/day";
  return lower.ends_with("peak_kw") ? "kW" : "";
}

void take_measurements(const doe::DesignFolder& design, const doe::MonthlyTable& measured,
                       const std::vector<doe::DesignMonth>& months, DesignCalibration& result) {
  result.model = ModelKind::metamodel;
  result.months = months;
  for (std::size_t i = 0; i < months.size(); ++i) {
    result.month_names.push_back(months[i].text());
    result.roles.push_back(i < design.months.size() ? MonthRole::calibration
                                                    : MonthRole::validation);
  }
  for (const std::string& name : design.output_names) {
    assessment::OutputCalibration output{.name = name, .meter_id = name, .unit = unit_of(name)};
    // The design may have been narrowed to some of the measured outputs.
    const auto column = std::ranges::find(measured.names, name) - measured.names.begin();
    for (const doe::DesignMonth month : months) {
      const Eigen::Index row = measured.row_of(month);
      output.measured.push_back(row < 0 ? kAbsent : measured.values(row, column));
    }
    output.calibrated = std::ranges::any_of(std::span{output.measured}.first(design.months.size()),
                                            [](double value) { return !std::isnan(value); });
    result.outputs.push_back(std::move(output));
  }
}

/// Without the outputs that no month of the design measures: nothing can be learnt of them, and
/// what moves them alone would be kept for nothing.
doe::DesignFolder measured_outputs_of(doe::DesignFolder design, const doe::MonthlyTable& measured) {
  const auto months = static_cast<Eigen::Index>(design.months.size());
  std::vector<std::string> names;
  std::vector<Eigen::Index> columns;
  for (std::size_t k = 0; k < design.output_names.size(); ++k) {
    const auto is_measured = [&](doe::DesignMonth month) {
      const Eigen::Index row = measured.row_of(month);
      return row >= 0 && !std::isnan(measured.values(row, static_cast<Eigen::Index>(k)));
    };
    if (std::ranges::none_of(design.months, is_measured)) continue;
    names.push_back(design.output_names[k]);
    for (Eigen::Index i = 0; i < months; ++i) {
      columns.push_back(static_cast<Eigen::Index>(k) * months + i);
    }
  }
  design.outputs = design.outputs(Eigen::all, columns).eval();
  design.output_names = std::move(names);
  return design;
}

std::vector<int> without(const std::vector<std::string>& held, const doe::DesignFolder& design,
                         std::vector<int> chosen) {
  std::erase_if(chosen, [&](int j) {
    const std::string& name = design.parameters[static_cast<std::size_t>(j)].name;
    return std::ranges::find(held, name) != held.end();
  });
  return chosen;
}

Result<std::vector<int>> choose_parameters(const doe::DesignFolder& design,
                                           const DesignCalibrationOptions& options,
                                           DesignCalibration& result) {
  std::vector<int> all(design.parameters.size());
  std::iota(all.begin(), all.end(), 0);
  if (!options.given_metamodel.empty() || options.parameters == "all") {
    return without(options.held, design, std::move(all));
  }
  if (options.parameters != "screened") {
    return named_parameters(design.parameters, options.parameters);
  }
  Rng rng{options.metamodel.seed, streams::kScreening.first};
  auto screening = TRY(screening::screen(design_data(design), {}, rng));
  result.screening = std::move(screening);
  std::vector<int> kept;
  for (std::size_t j = 0; j < result.screening->parameters.size(); ++j) {
    const bool matters = result.screening->parameters[j].verdict == screening::Verdict::influential;
    if (matters) kept.push_back(static_cast<int>(j));
  }
  kept = without(options.held, design, std::move(kept));
  if (!kept.empty()) return kept;
  return failure(ErrorCode::not_enough_data,
                 "screening finds no parameter that moves an output; widen the priors, or choose "
                 "with --parameters");
}

/// Parameters outside `free`, and the value at which each is held.
void fix_the_others(const std::vector<Parameter>& parameters, const std::vector<int>& free,
                    DesignCalibration& result) {
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const bool is_free = std::ranges::binary_search(free, static_cast<int>(j));
    (is_free ? result.parameters : result.fixed_parameters).push_back(parameters[j]);
  }
}

/// The meta-model's own error in each output and month.
void add_model_variances(const Metamodel& metamodel, std::size_t calibration_months,
                         DesignCalibration& result) {
  const std::size_t n = result.month_names.size();
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    std::vector<double> variances(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      double sigma = 0.0;
      if (i >= calibration_months && !metamodel.sigma_validation.empty()) {
        sigma = metamodel.sigma_validation[k];
      } else if (i < calibration_months && metamodel.sigma_calibration.size() > 0) {
        sigma = metamodel.sigma_calibration(static_cast<Eigen::Index>(k * calibration_months + i));
      }
      variances[i] = sigma * sigma;
    }
    result.outputs[k].model_variances = std::move(variances);
  }
}

void report_form(const FittedMetamodel& fitted, const DesignCalibration& result,
                 std::size_t calibration_months, display::Warnings& warnings) {
  if (fitted.form == MetamodelForm::seed || result.month_names.size() == calibration_months) return;
  const std::string& first = result.month_names[calibration_months];
  const std::string& last = result.month_names.back();
  const std::size_t months = result.month_names.size() - calibration_months;
  warnings.push_back(
      {.sentence = fmt::format("{} not in the design: the bands there are too narrow.",
                               first == last ? display::month_words(first) + " is"
                                             : display::month_words(first) + " to " +
                                                   display::month_words(last) + " are"),
       .details =
           fmt::format("The monthly form says nothing of these months, so the seed's form is "
                       "used (form seed), with a left-out R2 of {:.4f} in the design's own months.",
                       fitted.quality(MetamodelForm::seed).all.r2_left_out),
       .share = static_cast<double>(months) / static_cast<double>(result.month_names.size())});
}

/// The months to be calibrated and those to validate, in this order.
std::vector<doe::DesignMonth> all_months(const doe::DesignFolder& design,
                                         const doe::MonthlyTable& measured, bool can_validate,
                                         display::Warnings& warnings) {
  std::vector<doe::DesignMonth> months = design.months;
  const auto later = validation_months(design, measured);
  if (can_validate) {
    months.insert(months.end(), later.begin(), later.end());
  } else if (!later.empty()) {
    warnings.push_back(
        {.sentence = fmt::format("{} to {} are measured but not in the design: they cannot "
                                 "validate.",
                                 display::month_words(later.front().text()),
                                 display::month_words(later.back().text())),
         .details = "The monthly form says nothing of them, and the seed's form cannot be "
                    "fitted.",
         .share = static_cast<double>(later.size()) /
                  static_cast<double>(months.size() + later.size())});
  }
  return months;
}

Result<Metamodel> make_metamodel(const doe::DesignFolder& design, const doe::MonthlyTable& measured,
                                 const DesignCalibrationOptions& options,
                                 DesignCalibration& result) {
  const MonthInputs covered = month_inputs(design.inputs, design.months);
  if (!options.given_metamodel.empty()) {
    const auto months = all_months(design, measured, true, result.warnings);
    take_measurements(design, measured, months, result);
    return given_metamodel(options.given_metamodel, design, covered,
                           month_inputs(design.inputs, months));
  }
  result.fitted = TRY(fit_metamodel(design_data(design), options.metamodel));
  const FittedMetamodel& fitted = *result.fitted;
  display::add_notes(fitted.notes, result.warnings);
  const auto months = all_months(design, measured, fitted.seed_form.has_value(), result.warnings);
  take_measurements(design, measured, months, result);
  report_form(fitted, result, design.months.size(), result.warnings);
  return metamodel_of(fitted, options.metamodel, covered, month_inputs(design.inputs, months));
}

}  // namespace

std::vector<std::size_t> in_order_of_time(const std::vector<doe::DesignMonth>& months) {
  std::vector<std::size_t> order(months.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return months[i]; });
  return order;
}

Result<std::vector<int>> named_parameters(const std::vector<Parameter>& parameters,
                                          const std::string& names) {
  std::vector<int> chosen;
  std::vector<std::string_view> known{parameters.size()};
  std::ranges::transform(parameters, known.begin(), &Parameter::name);
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    const std::string_view name = csv::trimmed(std::string_view{names}.substr(begin, end - begin));
    const auto place = std::ranges::find(known, name);
    if (place == known.end()) {
      const std::string_view nearest = nearest_name(name, known);
      return failure(
          ErrorCode::not_found,
          fmt::format("the design has no parameter '{}'{}", name,
                      nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
    }
    chosen.push_back(static_cast<int>(place - known.begin()));
    begin = end + 1;
  }
  std::ranges::sort(chosen);
  if (std::ranges::adjacent_find(chosen) == chosen.end()) return chosen;
  return failure(ErrorCode::invalid_value, fmt::format("'{}' names a parameter twice", names));
}

Result<DesignCalibration> calibrate_design(const doe::DesignFolder& whole_design,
                                           const doe::Measurements& measured,
                                           const DesignCalibrationOptions& options,
                                           const calibration::RunContext& context) {
  // A given meta-model speaks of all outputs; one that is not measured stays without figures.
  const doe::DesignFolder design = options.given_metamodel.empty()
                                       ? measured_outputs_of(whole_design, measured.table)
                                       : whole_design;
  DesignCalibration result;
  display::add_notes(design.notes, result.warnings);
  display::add_notes(measured.notes, result.warnings);
  const auto free = TRY(choose_parameters(design, options, result));
  fix_the_others(design.parameters, free, result);
  auto metamodel = TRY(make_metamodel(design, measured.table, options, result));

  const std::size_t calibration_months = design.months.size();
  auto problem = assessment::problem_of(result, calibration_months);
  const assessment::WholePeriod whole_period{
      metamodel.inputs,
      assessment::held_parameter_errors(*metamodel.whole, design.parameters, free)};
  problem.inputs = {metamodel.inputs.names,
                    metamodel.inputs.values.topRows(static_cast<Eigen::Index>(calibration_months))};
  problem.model_error_sd = metamodel.sigma_calibration;
  problem.common_errors =
      assessment::held_parameter_errors(*metamodel.calibration, design.parameters, free);
  add_model_variances(metamodel, calibration_months, result);
  const std::vector<double> means = prior_means(design.parameters);
  const FixedParametersModel model{std::move(metamodel.calibration), means, free};
  FixedParametersModel whole{std::move(metamodel.whole), means, free};
  result.metamodel = std::move(metamodel.facts);

  calibration::DesignRuns runs{design.theta(Eigen::all, free), design.outputs};
  if (options.given_metamodel.empty()) assessment::set_aside_unresponsive(runs, result, problem);
  TRY(assessment::calibrate_into(model, problem, options.calibration, options.prior_sensitivity,
                                 std::move(runs), context, result));
  TRY(assessment::assess(whole, whole_period, {}, context, result));
  return result;
}

}  // namespace recald::daemon
