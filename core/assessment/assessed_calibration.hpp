/// A calibration held against the meters, whichever way its model came: from a site or from a
/// design of experiments. What tables and files are made from.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/absent.hpp"
#include "core/assessment/output_assessment.hpp"
#include "core/calibration/calibration.hpp"
#include "core/calibration/sensitivity.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "core/model/model_kind.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::assessment {

/// How an output that is not fitted is forecast.
enum class Following {
  level,   ///< By its meter's level against what the model has of it.
  errors,  ///< By the model's errors, given its own months and those of the fitted outputs.
};

/// One modelled output over all months of calibration and validation.
struct OutputCalibration {
  std::string name;      ///< As files write it: "steam_daily_kWh".
  std::string meter_id;  ///< "steam"; of a design of experiments, the output's name.
  std::string unit;      ///< "kWh/day"
  metering::Utility utility = metering::Utility::electricity;
  std::size_t meter = 0;  ///< Of a site: index into the recording.
  double weight = 1.0;
  bool calibrated = true;          ///< False: not fitted …
  std::string not_fitted_because;  ///< … and why, as a sentence.
  Following following = Following::level;
  std::vector<double> measured;         ///< (months) NaN where there is no usable figure.
  std::vector<double> extra_variances;  ///< (months) unit squared, known: estimated slots.
  /// (months) unit squared: what the model itself does not know of this output, besides the
  /// discrepancy: the error of a meta-model, the parameters that it holds fixed. Empty: nothing.
  std::vector<double> model_variances;
  OutputAssessment assessment;
};

/// What stood in for the simulation of a design of experiments.
struct MetamodelFacts {
  std::string form;              ///< "seed", "monthly" or "given".
  std::string why;               ///< Why this form, in words.
  double r2_left_out = kAbsent;  ///< Of the form that was calibrated; NaN for a given one.
  std::vector<double> sigma_r;   ///< (outputs) in their units; empty for a given one.
};

struct AssessedCalibration {
  display::UnitSystem units = display::UnitSystem::si;  ///< Of its words and tables.
  ModelKind model = ModelKind::epc;
  std::vector<std::string> month_names;  ///< "2016-03", or a number for a design without years.
  std::vector<double> month_days;        ///< (months) Empty: all months count alike.
  std::vector<MonthRole> roles;          ///< (months) calibration months come first.
  std::vector<Parameter> parameters;
  std::vector<Parameter> fixed_parameters;  ///< In the model at their prior means, not calibrated.
  /// (parameters) sd of what each means in the model, in prior sds (model_errors.hpp); empty: none.
  std::vector<double> parameter_errors;
  std::optional<MetamodelFacts> metamodel;
  calibration::Calibration calibration;
  std::vector<OutputCalibration> outputs;
  std::optional<calibration::PriorSensitivity> sensitivity;
  /// Parameters that ran to an end of their prior, or to where no building lies: said first.
  display::Warnings alarms;
  display::Warnings warnings;  ///< In order of discovery.
  /// A sentence; not empty: no model was calibrated, and the outputs' forecasts are all there is.
  std::string not_calibrated_because;
};

/// Whether this may be used as it is: its chains have converged, or it needed none.
[[nodiscard]] inline bool is_sound(const AssessedCalibration& result) {
  return result.calibration.converged || !result.not_calibrated_because.empty();
}

/// The problem of `result`'s outputs over its first `calibration_months` months, without
/// parameters' errors; inputs are to be filled in.
[[nodiscard]] calibration::CalibrationProblem problem_of(const AssessedCalibration& result,
                                                         std::size_t calibration_months);

/// A finding as a warning.
[[nodiscard]] inline display::Warning warning_of(const calibration::Finding& finding) {
  return {finding.sentence, finding.details, finding.share};
}

/// Takes an output out of the fit. @param because  A sentence.
void set_aside(std::size_t output, std::string because, Following following,
               AssessedCalibration& result, calibration::CalibrationProblem& problem);

/// Outputs that the parameters hardly move are set aside: normalised by a range of two per cent,
/// their harmless misfit would set the size of the discrepancy for all outputs.
void set_aside_unresponsive(const calibration::DesignRuns& design, AssessedCalibration& result,
                            calibration::CalibrationProblem& problem);

/// Calibrates on the design, repeats it for other beliefs where asked, and puts what was found into
/// `result.warnings`.
[[nodiscard]] Result<void> calibrate_into(const MonthlyModel& model,
                                          const calibration::CalibrationProblem& problem,
                                          const calibration::CalibrationOptions& options,
                                          bool prior_sensitivity, calibration::DesignRuns design,
                                          const calibration::RunContext& context,
                                          AssessedCalibration& result);

/// The most that the variance of parameter `j` could shrink, were everything else known: the
/// model's own error in it stays.
[[nodiscard]] inline double contraction_max(const AssessedCalibration& result, std::size_t j) {
  if (result.parameter_errors.empty()) return 1.0;
  return 1.0 / (1.0 + result.parameter_errors[j] * result.parameter_errors[j]);
}

/// Whether the data have settled at least half of what they could settle of parameter `j`.
[[nodiscard]] inline bool is_identified(const AssessedCalibration& result, std::size_t j) {
  return result.calibration.parameters[j].contraction >= 0.5 * contraction_max(result, j);
}

/// What the errors of all months have in common.
struct WholePeriod {
  calibration::ModelInputs inputs;             ///< As the problem's, of all months.
  std::vector<Eigen::VectorXd> common_errors;  ///< Likewise.
};

/// (months) known variances of meter and model together.
[[nodiscard]] std::vector<double> known_variances(const OutputCalibration& output);

/// Fills the outputs' assessments.
/// @param whole_model  Covers all months of `result`.
/// @param yardsticks   (outputs) What regressions of the meters' days forecast, to be pooled with
///                     the model's; empty: there are none.
/// @return or an error of the model, or what `forecast_given_data` finds.
[[nodiscard]] Result<void> assess(MonthlyModel& whole_model, const WholePeriod& whole,
                                  std::span<const std::optional<OutputForecasts>> yardsticks,
                                  const calibration::RunContext& context,
                                  AssessedCalibration& result);

}  // namespace recald::assessment
