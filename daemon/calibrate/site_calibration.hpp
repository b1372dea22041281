/// A site's calibration from its recording: what a report, a file or a store is made from.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/assessment/output_assessment.hpp"
#include "core/calibration/calibration.hpp"
#include "core/calibration/sensitivity.hpp"
#include "core/model/parameter_library.hpp"
#include "core/profile/electricity_profile.hpp"
#include "core/result.hpp"
#include "daemon/config/site_config.hpp"
#include "daemon/replay/recording.hpp"
#include "daemon/replay/site_weather.hpp"

namespace recald::daemon {

/// One modelled meter over all months of calibration and validation.
struct OutputCalibration {
  std::size_t meter;  ///< Index into the recording.
  std::string name;   ///< "steam_daily_kWh"
  double weight = 1.0;
  bool calibrated = true;               ///< False: parameters hardly move it: shown, not fitted.
  std::vector<double> measured;         ///< (months) kWh/day; NaN where there is no usable figure.
  std::vector<double> extra_variances;  ///< (months) (kWh/day)², from estimated slots.
  assessment::OutputAssessment assessment;
};

struct SiteCalibration {
  std::vector<metering::Month> months;
  std::vector<assessment::MonthRole> roles;  ///< (months)
  std::vector<const model::ParameterDefinition*> definitions;
  std::vector<Parameter> parameters;
  profile::ElectricityProfile profile;
  calibration::Calibration calibration;
  std::vector<OutputCalibration> outputs;
  std::optional<calibration::PriorSensitivity> sensitivity;
  std::vector<std::string> warnings;  ///< In words, in order of discovery.
};

struct CalibrateOptions {
  calibration::CalibrationOptions calibration;
  bool prior_sensitivity = false;
};

/// Profile, model, design, chains, assessment. @pre the site has a model
[[nodiscard]] Result<SiteCalibration> calibrate_site(const SiteConfig& site,
                                                     const metering::LocalCalendar& calendar,
                                                     const Recording& recording,
                                                     const SiteWeather& weather,
                                                     const CalibrateOptions& options,
                                                     const calibration::RunContext& context);

/// The electricity profile alone. @pre the site has a building and a period
[[nodiscard]] Result<profile::ElectricityProfile> profile_site(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather);

}  // namespace recald::daemon
