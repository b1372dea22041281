/// A site's calibration from its recording: what a report, a file or a store is made from.
#pragma once

#include <memory>
#include <vector>

#include "adapters/doe/design_folder.hpp"
#include "core/assessment/assessed_calibration.hpp"
#include "core/assessment/model_errors.hpp"
#include "core/diagnosis/model_effects.hpp"
#include "core/model/electricity_profile.hpp"
#include "core/model/epc/prepare.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter_library.hpp"
#include "core/result.hpp"
#include "core/screening/screen.hpp"
#include "core/weather/monthly_inputs.hpp"
#include "daemon/site/calibrate/design_metamodel.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/site_model.hpp"
#include "daemon/site/model/site_parts.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

/// Runs of a site's model, and the meta-model that speaks for it.
struct SiteDesign {
  doe::DesignFolder folder;
  screening::Screening screening;
  FittedMetamodel fitted;
};

/// What a site was calibrated with, for who asks its model further.
struct CalibratedWith {
  calibration::CalibrationProblem problem;      ///< As the chains had it.
  std::vector<assessment::CommonError> errors;  ///< Of `problem.common_errors`.
  SiteModelParts parts;
};

struct SiteCalibration : assessment::AssessedCalibration {
  std::vector<metering::Month> months;  ///< Those of `month_names`.
  model::ElectricityProfile profile;    ///< Of a model of the site's [building].
  /// Of a model that a design of experiments stands for: the design, and what was made of it.
  std::shared_ptr<const SiteDesign> design;
  /// Of the version in force; null: the model is that of the drawings. Their parameters stand
  /// behind the others in `parameters`.
  std::shared_ptr<const diagnosis::ModelEffects> effects;
  std::shared_ptr<const CalibratedWith> with;  ///< Null: no model was calibrated.
};

/// A site of which everything is known but the parameters: what a calibration samples and a design
/// of experiments runs.
struct PreparedSite {
  SiteCalibration so_far;  ///< Months, parameters, outputs, profile, warnings; nothing calibrated.
  std::unique_ptr<MonthlyModel> model;        ///< Of the calibration months.
  std::unique_ptr<MonthlyModel> whole_model;  ///< Of all months.
  calibration::CalibrationProblem problem;
  weather::MonthlyInputs inputs;  ///< Of all months; those that `problem` has, where all have them.
  std::vector<Eigen::VectorXd> common_errors;   ///< As the problem's, of all months …
  std::vector<assessment::CommonError> errors;  ///< … and what each of them is of.
  SiteModelParts parts;
  /// What all months gain when lights and plugs double, heat in the rooms included: (outputs *
  /// months) in units, output-major, straightened out from a tenth more.
  std::vector<double> electricity_use;
};

/// What separates the model from the meters, besides noise.
enum class DiscrepancyForm {
  sound,  ///< The seed's discrepancy, the model's own errors, and no meter that a profile was read
          ///< off.
  seed,   ///< The seed's discrepancy alone, over all outputs, with the model itself in the chains.
};

struct CalibrateOptions {
  calibration::CalibrationOptions calibration;
  bool prior_sensitivity = false;
  DiscrepancyForm discrepancy = DiscrepancyForm::sound;
};

/// What every model of a site begins with.
struct BegunSite {
  SiteMonths months;
  SiteCalibration so_far;  ///< Kind, units, months and outputs.
};

/// @return the months that have weather, and what the meters show in them; or not_enough_data.
/// @pre the site has a model
[[nodiscard]] Result<BegunSite> begin_site(const SiteConfig& site, const Recording& recording,
                                           const SiteWeather& weather);

/// What a discrepancy may depend on: the months' weather, but for what is assumed of it.
void add_inputs(const metering::LocalCalendar& calendar, const SiteWeather& weather,
                const SiteMonths& months, PreparedSite& prepared);

/// @param errors  Of all months; the problem gets its own.
/// @param kinds   What they are of; empty: of nothing that can be told.
void add_common_errors(const std::vector<Eigen::VectorXd>& errors,
                       const std::vector<assessment::CommonError>& kinds, PreparedSite& prepared);

/// Their names, lengths and roles.
void take_months(const SiteMonths& months, SiteCalibration& result);

/// Profile, model and measurements; of an EnergyPlus model its runs, as `prepare_on_runs`.
/// @param added  Effects of the version in force.
/// @return the site, or what is missing of it; of effects also what `make_model_effects` finds.
/// @pre the site has a model
[[nodiscard]] Result<PreparedSite> prepare_site(const SiteConfig& site,
                                                const metering::LocalCalendar& calendar,
                                                const Recording& recording,
                                                const SiteWeather& weather,
                                                std::vector<diagnosis::AddedEffect> added = {});

/// Chains of all parameters together. Fills `result.calibration`.
[[nodiscard]] Result<void> calibrate_all(PreparedSite& prepared, const CalibrateOptions& options,
                                         calibration::DesignRuns design,
                                         const calibration::RunContext& context,
                                         SiteCalibration& result);

/// Profile, model, design, chains, assessment. Without a model, or where too little is metered that
/// its parameters move, forecasts alone (`forecast_meters`), and why.
/// @param added  Effects of the version in force; see effects_calibration.hpp.
[[nodiscard]] Result<SiteCalibration> calibrate_site(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather, const CalibrateOptions& options,
    const calibration::RunContext& context, std::vector<diagnosis::AddedEffect> added = {});

/// Each meter's daily averages in these months and, where the site's model has peaks, its peaks: in
/// the order in which `model_of` gives them.
[[nodiscard]] std::vector<assessment::OutputCalibration> collect_outputs(
    const SiteConfig& site, const Recording& recording, const std::vector<metering::Month>& months);

/// Lights and plugs for the site's kind of model.
/// @return not_enough_data without an electricity meter; unsupported for a monthly model of a
///         building with a chiller of its own.
[[nodiscard]] Result<model::ElectricityProfile> fit_site_profile(
    const SiteConfig& site, const Recording& recording, const model::epc::Place& place,
    const std::vector<metering::Month>& months);

/// The electricity profile alone. @return or not_enough_data without a [building]. @pre the site
/// has a period
[[nodiscard]] Result<model::ElectricityProfile> profile_site(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather);

}  // namespace recald::daemon
