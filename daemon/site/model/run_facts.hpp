/// What a result was made from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adapters/results/run_facts.hpp"
#include "core/calibration/calibration.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

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
