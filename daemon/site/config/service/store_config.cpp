#include "daemon/site/config/service/store_config.hpp"

#include <fmt/format.h>

#include "daemon/site/config/service/site_path.hpp"

namespace recald::daemon {
namespace {

std::filesystem::path folder_beside(const std::filesystem::path& store) {
  return store.parent_path() / "backups";
}

}  // namespace

StoreConfig default_store(const std::filesystem::path& site_file) {
  StoreConfig config;
  config.file = std::filesystem::path{site_file}.replace_extension(".db");
  config.backup_folder = folder_beside(config.file);
  return config;
}

StoreConfig read_store(TomlReader& table, const std::filesystem::path& site_file) {
  StoreConfig config = default_store(site_file);
  if (const auto file = table.text("file")) {
    config.file = resolve(site_file, *file, "file", table);
    config.backup_folder = folder_beside(config.file);
  }
  if (const auto folder = table.text("backup_folder")) {
    config.backup_folder = resolve(site_file, *folder, "backup_folder", table);
  }
  if (const auto backup = table.text("backup")) {
    config.backup_at = parse_time_of_day(*backup);
    if (!config.backup_at && *backup != "never") {
      table.problem_at("backup", fmt::format("'backup' is \"{}\"; write a local time of day such "
                                             "as \"03:15\", or \"never\"",
                                             *backup));
    }
  }
  config.raw_kept = std::chrono::days{table.whole_number_or("raw_days", 400, {1, 36'500})};
  config.events_kept = std::chrono::days{table.whole_number_or("event_days", 730, {1, 36'500})};
  config.results_kept = static_cast<int>(table.whole_number_or("results_kept", 24, {1, 10'000}));
  table.finish();
  return config;
}

}  // namespace recald::daemon
