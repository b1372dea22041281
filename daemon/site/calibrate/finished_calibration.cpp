#include "daemon/site/calibrate/finished_calibration.hpp"

#include <utility>

#include "core/display/warning.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {

Result<FinishedCalibration> finish_calibration(ModelledSite modelled,
                                               const CalibrateOptions& options,
                                               const calibration::RunContext& context) {
  auto version = TRY(active_version(modelled.site.config));
  modelled.facts.model_version = version_name(version, modelled.facts.model_version);
  auto calibrated =
      TRY(calibrate_site(modelled.site.config, modelled.site.calendar, modelled.recording,
                         modelled.weather, options, context, std::move(version.effects)));
  modelled.facts = with_sampling(std::move(modelled.facts), context.seed, calibrated.calibration);
  return FinishedCalibration{std::move(modelled), std::move(calibrated)};
}

Result<FinishedDesign> finish_calibration(FinishedDesign done, const DesignOrigin& origin,
                                          const doe::Measurements& measured,
                                          DesignCalibrationOptions options,
                                          const calibration::RunContext& context) {
  options.held = origin.held;
  done.calibration = TRY(calibrate_design(done.design, measured, options, context));
  display::add_notes(origin.notes, done.calibration.warnings);
  done.facts = with_sampling(std::move(done.facts), context.seed, done.calibration.calibration);
  return done;
}

}  // namespace recald::daemon
