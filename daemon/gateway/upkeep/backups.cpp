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

/// "20240301" of the first damaged store beside this one, as its name has the day; empty: none.
std::string first_damage(const StoreConfig& store) {
  const std::string prefix = store.file.filename().string() + ".damaged-";
  std::string first;
  std::error_code error;
  for (std::filesystem::directory_iterator entry{store.file.parent_path(), error}, end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix)) continue;
    const std::string day = name.substr(prefix.size(), 8);
    if (first.empty() || day < first) first = day;
  }
  return first;
}

/// The day of a backup, written likewise.
std::string day_of(const StoreConfig& store, const std::filesystem::path& backup) {
  std::string day = backup.stem().string().substr(store.file.stem().string().size() + 1);
  std::erase(day, '-');
  return day;
}

}  // namespace

std::filesystem::path backup_file(const StoreConfig& store, metering::Day day) {
  return store.backup_folder / (store.file.stem().string() + "-" + metering::to_string(day) +
                                store.file.extension().string());
}

std::vector<std::filesystem::path> backups_of(const StoreConfig& store) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry{store.backup_folder, error}, end;
       !error && entry != end; entry.increment(error)) {
    if (is_backup_of(store, entry->path())) files.push_back(entry->path());
  }
  std::ranges::sort(files, std::greater{});  // names of one form sort as their days do
  return files;
}

std::vector<std::filesystem::path> prune_backups(const StoreConfig& store) {
  const auto files = backups_of(store);
  const std::string damaged = first_damage(store);
  std::vector<std::filesystem::path> kept_against_will;
  for (std::size_t i = kBackupsKept; i < files.size(); ++i) {
    if (!damaged.empty() && day_of(store, files[i]) <= damaged) continue;
    std::error_code error;
    std::filesystem::remove(files[i], error);
    if (error) kept_against_will.push_back(files[i]);
  }
  return kept_against_will;
}

}  // namespace recald::daemon
