/// Measures at a building that recald models itself: quantities by the names of the library.
#pragma once

#include "core/calibration/sampling.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"
#include "daemon/site/savings/measured_model.hpp"

namespace recald::daemon {

/// Quantities that are not calibrated are drawn from their priors; of lights and plugs together the
/// meter knows the sum.
/// @param finished  Calibrated; outlives the model, as do the measures and the context.
/// @return or what `model_of` finds.
[[nodiscard]] Result<std::unique_ptr<MeasuredModel>> make_building_measures(
    const FinishedCalibration& finished, const std::vector<savings::Measure>& measures,
    const calibration::RunContext& context);

}  // namespace recald::daemon
