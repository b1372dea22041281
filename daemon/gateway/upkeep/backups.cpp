#include "daemon/gateway/upkeep/backups.hpp"

#include <algorithm>
#include <functional>
#include <system_error>

namespace recald::daemon {
namespace {

/// Whether a name is "<stem>-<day><extension>".
bool is_backup_of(const StoreConfig& store, const std::filesystem::path& file) {
  const std::string prefix = store.file.stem().string() + "-";
  const std::string stem = file.stem().string();
  return file.extension() == store.file.extension() && stem.starts_with(prefix) &&
         metering::parse_day(stem.substr(prefix.size())).has_value();
}

}  // namespace

std::filesystem::path backup_file(const StoreConfig& store, metering::Day day) {
  return store.backup_folder / (store.file.stem().string() + "-" + metering::to_string(day) +
                                store.file.extension().string());
}

std::vector<std::filesystem::path> backups_of(const StoreConfig& store) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator{store.backup_folder, error}) {
    if (is_backup_of(store, entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files, std::greater{});  // names of one form sort as their days do
  return files;
}

std::vector<std::filesystem::path> prune_backups(const StoreConfig& store) {
  const auto files = backups_of(store);
  std::vector<std::filesystem::path> kept_against_will;
  for (std::size_t i = kBackupsKept; i < files.size(); ++i) {
    std::error_code error;
    std::filesystem::remove(files[i], error);
    if (error) kept_against_will.push_back(files[i]);
  }
  return kept_against_will;
}

}  // namespace recald::daemon
