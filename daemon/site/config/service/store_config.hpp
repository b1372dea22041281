/// Where `recald run` keeps what it read, as a site file says it.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "adapters/toml/toml_reader.hpp"

namespace recald::daemon {

struct StoreConfig {
  std::filesystem::path file;           ///< Default: the site file with the ending .db.
  std::filesystem::path backup_folder;  ///< Default: the folder "backups" beside the store.
  /// Local time of day of the daily backup; absent: never.
  std::optional<std::chrono::minutes> backup_at = std::chrono::minutes{3 * 60 + 15};
  std::chrono::days raw_kept{400};     ///< Samples older than this are deleted.
  std::chrono::days events_kept{730};  ///< Events likewise.
  int results_kept = 24;               ///< Calibrations, and diagnoses, besides those in use.
};

/// Without a [store].
[[nodiscard]] StoreConfig default_store(const std::filesystem::path& site_file);

/// [store]
[[nodiscard]] StoreConfig read_store(TomlReader& table, const std::filesystem::path& site_file);

}  // namespace recald::daemon
