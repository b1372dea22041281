/// Calibrations for tests of what is around them: months, weather, files, jobs.
#pragma once

#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon::testing {

/// Two short chains, whatever they agree on. By default the sampler would go on until they agree,
/// a quarter of a minute where six months say little.
inline CalibrateOptions short_chains() {
  CalibrateOptions options;
  options.calibration.sampling.iterations = 700;
  options.calibration.sampling.burn_in = 300;
  options.calibration.sampling.chains = 2;
  options.calibration.sampling.gate = {.rhat_max = 1e9,
                                       .ess_min = 0.0,
                                       .mcse_share_max = 1e9,
                                       .e_bfmi_min = 0.0,
                                       .divergences_max = 1'000'000};
  return options;
}

}  // namespace recald::daemon::testing
