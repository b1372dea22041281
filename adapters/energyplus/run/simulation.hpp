/// One run of EnergyPlus in a folder of its own.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"
#include "adapters/energyplus/run/program.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

/// What is simulated, beside the model itself.
struct RunRequest {
  metering::Day first;              ///< Both in one calendar year, which the weather covers.
  metering::Day last;               ///< Inclusive.
  std::vector<std::string> meters;  ///< "Electricity:Facility"; reported at each time step.
};

struct RunLimits {
  std::chrono::seconds time_max{1800};
  std::uint64_t memory_max_bytes = std::uint64_t{8} << 30;
};

/// Makes the model report what is asked for, and nothing else, for these days: a model's own
/// output is of no use here and costs time and disk.
void prepare_objects(const RunRequest& request, Json& objects);

/// Writes the prepared model into the folder and runs it there.
/// @param objects  As `prepare_objects` left them.
/// @param folder   Made, or emptied.
/// @return the SQLite file of the run; or invalid_value: EnergyPlus refuses the model, breaks off
///         or dies, in its own first words; io_failed: it cannot be started; out_of_range: it
///         took too long; cancelled.
[[nodiscard]] Result<std::filesystem::path> simulate(
    const Json& objects, const std::filesystem::path& weather, const std::filesystem::path& folder,
    const Program& program, const RunLimits& limits, const std::function<bool()>& keep_going);

}  // namespace recald::energyplus
