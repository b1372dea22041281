/// The files of `recald-sim eplus`: a model as a client has it, the building's truth, its weather.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace recald::simulators::energyplus {

struct ModelFileOptions {
  std::string kind;  ///< "laboratory" or "small_office".
  std::filesystem::path out;
  bool with_truth = false;
  int first_year = 2021;
  int years = 0;  ///< Of weather, and with the truth of habits; 0: none.
  std::uint64_t seed = 1;
};

/// Both buildings stand here.
inline constexpr const char* kTimeZone = "America/New_York";

/// Writes `model.epJSON`, by the drawings. With the truth also `truth.epJSON`, the same building as
/// it is, and `truth.json`, for scoring. With years `weather.csv` and a YEAR.epw each, and with
/// both truth-YEAR.epJSON beside habits-YEAR.csv: the true building with people who vary from day
/// to day. @return invalid_value: no such kind; io_failed.
[[nodiscard]] Result<void> write_model_files(const ModelFileOptions& options);

}  // namespace recald::simulators::energyplus
