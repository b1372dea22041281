/// What every result carries besides its numbers, so that it can be trusted and reproduced.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/ports/job_result.hpp"

namespace recald {

struct RunFacts {
  std::string recald_version;
  std::string data_revision;  ///< SHA-256 over the site file and all data files.
  std::string model_version;  ///< Kind of model and SHA-256 of the site file, shortened.
  std::string time_zone_data;
  std::string weather_values;  ///< How temperatures were interpreted; empty without weather.
  std::vector<MonthWeather> weather = {};  ///< The requested months.
  /// Columns that no source measured and that were therefore assumed: "ghi_W_m2".
  std::vector<std::string> weather_assumed = {};
  std::string sampler;
  std::string hyper_prior_profile;
  std::uint64_t seed = 1;
  int iterations = 0;
  int burn_in = 0;
  int chains = 0;
  int design_runs = 0;
  double wall_s = 0.0;  ///< The only value that differs between equal runs.
};

}  // namespace recald
