/// What every result carries besides its numbers, so that it can be trusted and reproduced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adapters/ports/job_result.hpp"
#include "core/calibration/calibration.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

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

/// Hashes everything that the site's results depend on.
/// @param live_digest  Of the readings from live meters; empty: there were none.
/// @return not_found or io_failed for a data file.
[[nodiscard]] Result<RunFacts> facts_of(const SiteConfig& site,
                                        const std::string& live_digest = "");

/// As above for a design of experiments, over the files it was read from.
/// @param model  Kind of model; the version is this plus the shortened digest of the files.
[[nodiscard]] Result<RunFacts> facts_of_files(const std::vector<std::filesystem::path>& files,
                                              std::string_view model);

/// `facts` with the seed and the size of the sampling run.
[[nodiscard]] RunFacts with_sampling(RunFacts facts, std::uint64_t seed,
                                     const calibration::Calibration& calibration);

}  // namespace recald::daemon
