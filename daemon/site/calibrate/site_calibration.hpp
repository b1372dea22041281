/// A site's calibration from its recording: what a report, a file or a store is made from.
#pragma once

#include <memory>
#include <vector>

#include "core/assessment/assessed_calibration.hpp"
#include "core/model/epc/prepare.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter_library.hpp"
#include "core/profile/electricity_profile.hpp"
#include "core/result.hpp"
#include "core/weather/monthly_inputs.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/model_effects.hpp"
#include "daemon/site/model/site_parts.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

struct SiteCalibration : assessment::AssessedCalibration {
  std::vector<metering::Month> months;  ///< Those of `month_names`.
  std::vector<const model::ParameterDefinition*> definitions;
  profile::ElectricityProfile profile;
  /// Of the version in force; null: the model is that of the drawings. Their parameters stand
  /// behind the others in `parameters`.
  std::shared_ptr<const ModelEffects> effects;
};

/// A site of which everything is known but the parameters: what a calibration samples and a design
/// of experiments runs.
struct PreparedSite {
  SiteCalibration so_far;  ///< Months, parameters, outputs, profile, warnings; nothing calibrated.
  std::unique_ptr<MonthlyModel> model;        ///< Of the calibration months.
  std::unique_ptr<MonthlyModel> whole_model;  ///< Of all months.
  calibration::CalibrationProblem problem;
  weather::MonthlyInputs inputs;  ///< Of all months; those that `problem` has, where all have them.
  std::vector<Eigen::VectorXd> common_errors;  ///< As the problem's, of all months.
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

/// Their names, lengths and roles.
void take_months(const SiteMonths& months, SiteCalibration& result);

/// Profile, model and measurements.
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

/// Each meter's daily averages in these months and, where the site's model is hourly, its peaks: in
/// the order in which `model_of` gives them.
[[nodiscard]] std::vector<assessment::OutputCalibration> collect_outputs(
    const SiteConfig& site, const Recording& recording, const std::vector<metering::Month>& months);

/// Lights and plugs for the site's kind of model.
/// @return not_enough_data without an electricity meter; unsupported for a monthly model of a
///         building with a chiller of its own.
[[nodiscard]] Result<profile::ElectricityProfile> fit_site_profile(
    const SiteConfig& site, const Recording& recording, const model::epc::Place& place,
    const std::vector<metering::Month>& months);

/// The electricity profile alone. @pre the site has a building and a period
[[nodiscard]] Result<profile::ElectricityProfile> profile_site(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather);

}  // namespace recald::daemon
