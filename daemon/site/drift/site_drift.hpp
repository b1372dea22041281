/// A site followed from month to month: what was forecast, what came, what has moved.
#pragma once

#include <vector>

#include "core/drift/follow.hpp"
#include "core/drift/site_drift.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

using drift::DailyState;
using drift::ExplainedAlarm;
using drift::FollowedOutput;
using drift::FollowedWindow;
using drift::kLastYearWindow;
using drift::MeterChange;
using drift::ParameterPath;
using drift::SiteDrift;
using DriftOptions = drift::FollowOptions;

/// The months that all modelled meters have in common, the first `learning_months` of them to learn
/// from. Months without weather are left out later.
/// @return not_enough_data where there are none to follow after the learning ones.
[[nodiscard]] Result<PeriodConfig> followed_period(const OpenSite& site, const Recording& recording,
                                                   metering::Instant now, int learning_months);

/// Forecasts each month from those before, looks at it, scores it and takes it in, in four windows
/// side by side.
/// @param modelled  On the period of `followed_period`.
/// @return or what `prepare_site` finds, an error of the model, cancelled.
[[nodiscard]] Result<SiteDrift> follow_site(const ModelledSite& modelled,
                                            const DriftOptions& options,
                                            const std::vector<diagnosis::AddedEffect>& added,
                                            const calibration::RunContext& context);

}  // namespace recald::daemon
