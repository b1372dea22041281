/// What a command line says about sampling, as core takes it.
#pragma once

#include "core/calibration/calibration.hpp"
#include "daemon/commands/commands.hpp"

namespace recald::daemon {

/// @return the options; or the exit code, after saying what is wrong: kUsage for words and numbers
///         of the command line, kFailure for a file.
[[nodiscard]] tl::expected<calibration::CalibrationOptions, int> calibration_options(
    const SamplingArguments& arguments, const Console& console);

/// Where the files of a calibration go, and the exit code after they are written: a gate that
/// failed is a failure unless the user set the number of draws and nothing good was there to lose.
[[nodiscard]] std::filesystem::path folder_for(bool converged, const CalibrateArguments& arguments);
[[nodiscard]] int gate_verdict(bool converged, const CalibrateArguments& arguments,
                               const std::filesystem::path& folder, const Console& console);

}  // namespace recald::daemon
