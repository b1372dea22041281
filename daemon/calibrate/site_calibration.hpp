/// A site's calibration from its recording: what a report, a file or a store is made from.
#pragma once

#include <memory>
#include <vector>

#include "core/model/monthly_model.hpp"
#include "core/model/parameter_library.hpp"
#include "core/profile/electricity_profile.hpp"
#include "core/result.hpp"
#include "core/weather/monthly_inputs.hpp"
#include "daemon/calibrate/assessed_calibration.hpp"
#include "daemon/config/site_config.hpp"
#include "daemon/replay/recording.hpp"
#include "daemon/replay/site_weather.hpp"

namespace recald::daemon {

struct SiteCalibration : AssessedCalibration {
  std::vector<metering::Month> months;  ///< Those of `month_names`.
  std::vector<const model::ParameterDefinition*> definitions;
  profile::ElectricityProfile profile;
};

/// A site of which everything is known but the parameters: what a calibration samples and a design
/// of experiments runs.
struct PreparedSite {
  SiteCalibration so_far;  ///< Months, parameters, outputs, profile, warnings; nothing calibrated.
  std::unique_ptr<MonthlyModel> model;        ///< Of the calibration months.
  std::unique_ptr<MonthlyModel> whole_model;  ///< Of all months.
  calibration::CalibrationProblem problem;
  weather::MonthlyInputs inputs;  ///< Of all months; those that `problem` has, where all have them.
};

struct CalibrateOptions {
  calibration::CalibrationOptions calibration;
  bool prior_sensitivity = false;
};

/// Profile, model and measurements. @pre the site has a model
[[nodiscard]] Result<PreparedSite> prepare_site(const SiteConfig& site,
                                                const metering::LocalCalendar& calendar,
                                                const Recording& recording,
                                                const SiteWeather& weather);

/// Profile, model, design, chains, assessment. @pre the site has a model
[[nodiscard]] Result<SiteCalibration> calibrate_site(const SiteConfig& site,
                                                     const metering::LocalCalendar& calendar,
                                                     const Recording& recording,
                                                     const SiteWeather& weather,
                                                     const CalibrateOptions& options,
                                                     const calibration::RunContext& context);

/// What each modelled meter counts, in order of the model's outputs. @pre the site has a model
[[nodiscard]] Result<std::vector<model::MeterMap>> meter_maps(const SiteConfig& site);

/// The electricity profile alone. @pre the site has a building and a period
[[nodiscard]] Result<profile::ElectricityProfile> profile_site(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather);

}  // namespace recald::daemon
