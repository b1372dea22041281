/// Measures at a building whose model is a meta-model of EnergyPlus runs.
#pragma once

#include "core/calibration/sampling.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"
#include "daemon/site/savings/measured_model.hpp"

namespace recald::daemon {

/// What a measure changes is a function of the parameters, fitted to the differences between runs
/// with it and the same runs without. The fit's own error is drawn.
/// @param finished  Calibrated on its runs; outlives the model, as do the measures and the
/// context.
/// @return or not_found: runs with a measure are missing; or what reading and fitting find.
[[nodiscard]] Result<std::unique_ptr<MeasuredModel>> make_runs_measures(
    const FinishedCalibration& finished, const std::vector<savings::Measure>& measures,
    const calibration::RunContext& context);

}  // namespace recald::daemon
