#include "daemon/site/calibrate/finished_calibration.hpp"

#include <utility>

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

}  // namespace recald::daemon
