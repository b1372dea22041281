/// What a command line says about sampling, as core takes it, and how a calibration ends.
#pragma once

#include <functional>

#include "core/assessment/assessed_calibration.hpp"
#include "core/calibration/calibration.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"

namespace recald::daemon {

/// @return the options; or the exit code, after saying what is wrong: kUsage for words and numbers
///         of the command line, kFailure for a file.
[[nodiscard]] tl::expected<calibration::CalibrationOptions, int> calibration_options(
    const SamplingArguments& arguments, const Console& console);

/// Seed and threads of the command line, progress on the terminal; an interrupt stops the work.
/// @pre `guard` and `line` outlive the context
[[nodiscard]] calibration::RunContext run_context(const SamplingArguments& arguments,
                                                  const InterruptGuard& guard, ProgressLine& line);

/// Writes the files of a calibration where they belong, then prints its table or `json`.
/// @param write  Into the folder it is given; not called without --out.
/// @return the exit code: a gate that failed is a failure unless the user set the number of draws
///         and nothing good was there to lose.
[[nodiscard]] int deliver(const assessment::AssessedCalibration& result, const std::string& json,
                          const CalibrateArguments& arguments, const Console& console,
                          const std::function<Result<void>(const std::filesystem::path&)>& write);

}  // namespace recald::daemon
