/// A calibration with its progress on the console, for the commands that end with one.
#pragma once

#include "daemon/commands/commands.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"

namespace recald::daemon {

/// From the site file to the calibration; failures are printed and come back as an exit code.
[[nodiscard]] tl::expected<FinishedCalibration, int> calibrate_aloud(
    const CalibrateArguments& arguments, const Console& console);

}  // namespace recald::daemon
