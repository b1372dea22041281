#include "daemon/gateway/upkeep/backups.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <system_error>

namespace recald::daemon {
namespace {

/// The day in a name "<stem>-<day><extension>"; nothing for another name.
std::optional<metering::Day> day_in(const StoreConfig& store, const std::filesystem::path& file) {
  const std::string prefix = store.file.stem().string() + "-";
  const std::string stem = file.stem().string();
  if (file.extension() != store.file.extension() || !stem.starts_with(prefix)) return {};
  const auto day = metering::parse_day(stem.substr(prefix.size()));
  return day ? std::optional{*day} : std::nullopt;
}

/// The day "20240301" in the name of the last damaged store beside this one; empty: none.
/// @return or why the folder cannot be read.
Result<std::string> last_damage(const StoreConfig& store) {
  const std::string prefix = store.file.filename().string() + ".damaged-";
  const auto folder = store.file.has_parent_path() ? store.file.parent_path() : ".";
  std::string last;
  std::error_code error;
  for (std::filesystem::directory_iterator entry{folder, error}, end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    // A log left behind without its file is useless.
    if (!name.starts_with(prefix) || name.ends_with("-wal") || name.ends_with("-shm")) continue;
    last = std::max(last, name.substr(prefix.size(), 8));
  }
  if (error) return failure(ErrorCode::io_failed, error.message());
  return last;
}

/// "20240301", as in the name of a damaged store.
std::string digits_of(metering::Day day) {
  std::string digits = metering::to_string(day);
  std::erase(digits, '-');
  return digits;
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
    if (day_in(store, entry->path())) files.push_back(entry->path());
  }
  std::ranges::sort(files, std::greater{});  // names of one form sort by day
  return files;
}

metering::Day day_of(const StoreConfig& store, const std::filesystem::path& backup) {
  return *day_in(store, backup);
}

std::vector<std::filesystem::path> prune_backups(const StoreConfig& store) {
  const auto files = backups_of(store);
  const auto damaged = last_damage(store);
  if (!damaged) return {};
  std::vector<std::filesystem::path> kept_against_will;
  for (std::size_t i = kBackupsKept; i < files.size(); ++i) {
    if (digits_of(day_of(store, files[i])) <= *damaged) continue;
    std::error_code error;
    std::filesystem::remove(files[i], error);
    if (error) kept_against_will.push_back(files[i]);
  }
  return kept_against_will;
}

}  // namespace recald::daemon
