/// Where jobs write their files: beside the store, "tower-3-results/calibration-12".
#pragma once

#include <filesystem>

#include "adapters/ports/store.hpp"
#include "daemon/site/config/service/store_config.hpp"

namespace recald::daemon {

[[nodiscard]] std::filesystem::path job_folder(const StoreConfig& store, JobKind kind,
                                               std::int64_t number);

}  // namespace recald::daemon
