/// A calibration from a design of experiments alone: screening, meta-model, posterior, verdict.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adapters/doe/design_folder.hpp"
#include "core/assessment/assessed_calibration.hpp"
#include "core/calibration/calibration.hpp"
#include "core/result.hpp"
#include "core/screening/screen.hpp"
#include "daemon/site/calibrate/design_metamodel.hpp"

namespace recald::daemon {

struct DesignCalibrationOptions {
  MetamodelOptions metamodel;
  std::filesystem::path given_metamodel;  ///< Or empty: one is fitted.
  /// "screened": those that screening keeps; "all"; or names separated by commas.
  std::string parameters = "screened";
  /// Never calibrated unless named in `parameters`: see design_origin.hpp.
  std::vector<std::string> held;
  calibration::CalibrationOptions calibration;
  bool prior_sensitivity = false;
};

struct DesignCalibration : assessment::AssessedCalibration {
  std::vector<doe::DesignMonth> months;           ///< Those of `month_names`.
  std::optional<screening::Screening> screening;  ///< Where it chose the parameters.
  std::optional<FittedMetamodel> fitted;          ///< Absent where one was given.
};

/// Indices of months, ascending by time.
[[nodiscard]] std::vector<std::size_t> in_order_of_time(
    const std::vector<doe::DesignMonth>& months);

/// Calibrates on the months of the design that are measured; measured months beyond it validate.
///
/// Parameters that are not calibrated stay in the model at their prior means. What they could move
/// an output is counted as an error common to its months: one direction a parameter,
/// f(mean + sd) - f(mean), which is their exact marginalisation where f is linear in them.
///
/// With a given meta-model nothing is fitted, screened or added: parameters are scaled by their
/// priors' ends, model inputs by their ends over the design's months, outputs by those of the
/// design, and the meta-model is taken as free of error.
///
/// @return the calibration, or what reading, screening, fitting and sampling find.
[[nodiscard]] Result<DesignCalibration> calibrate_design(const doe::DesignFolder& design,
                                                         const doe::Measurements& measured,
                                                         const DesignCalibrationOptions& options,
                                                         const calibration::RunContext& context);

/// Indices of the parameters that a text of names, separated by commas, chooses.
/// @return not_found with the nearest name; invalid_value for none or one that comes twice.
[[nodiscard]] Result<std::vector<int>> named_parameters(const std::vector<Parameter>& parameters,
                                                        const std::string& names);

}  // namespace recald::daemon
