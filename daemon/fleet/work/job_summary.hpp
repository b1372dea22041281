/// What lists and comparisons of a fleet need of one result.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "daemon/gateway/run/job_runner.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Of a calibration: `outputs` with what the calibrated model leaves unexplained on the fitted
/// months (`nmbe` is modelled minus measured, as a share; `cvrmse`), and what that is worth a
/// month; `alarms` and `meter_changes` in words. Of a diagnosis: `named`, with its probability,
/// what it moves a month and what that is worth. Money is absent without a tariff, and at the price
/// that holds outside its periods.
[[nodiscard]] nlohmann::ordered_json job_summary(const SiteConfig& site, JobKind kind,
                                                 const JobOutcome& outcome);

}  // namespace recald::daemon
