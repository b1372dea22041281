#include "daemon/gateway/upkeep/restore.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/stores/open.hpp"
#include "adapters/system/files/regular_file.hpp"
#include "core/text/nearest.hpp"
#include "daemon/gateway/upkeep/backups.hpp"

namespace recald::daemon {
namespace {

bool knows(const SiteConfig& site, const std::string& meter) {
  // Of a weather sensor: "roof.dry_bulb_C".
  return site.meter_index(meter).has_value() ||
         site.find_sensor(std::string_view{meter}.substr(0, meter.find('.'))) != nullptr;
}

Result<void> require_meters(const SiteConfig& site, const StoreSummary& backup) {
  const auto is_known = [&](const std::string& meter) { return knows(site, meter); };
  if (backup.meters.empty() || std::ranges::any_of(backup.meters, is_known)) return {};
  return failure(
      ErrorCode::invalid_value,
      fmt::format("it is of another site: it has meter '{}' and {} more, and none of "
                  "them is in {}; name a backup of this site",
                  backup.meters.front(), backup.meters.size() - 1, site.file.filename().string()));
}

/// "; did you mean 'site-2024-03-02.db'?"
std::string nearest_backup(const StoreConfig& store, const std::filesystem::path& named) {
  std::vector<std::string> files;
  for (const auto& one : backups_of(store)) files.push_back(one.filename().string());
  const std::vector<std::string_view> names(files.begin(), files.end());
  const std::string wanted = named.filename().string();
  const std::string_view nearest = nearest_name(wanted, names);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

}  // namespace

Result<std::filesystem::path> chosen_backup(const StoreConfig& store,
                                            const std::filesystem::path& named) {
  std::error_code ignored;
  if (!named.empty()) {
    const bool is_in_folder = !named.has_parent_path() &&
                              !std::filesystem::exists(named, ignored) &&
                              std::filesystem::exists(store.backup_folder / named, ignored);
    const auto file = is_in_folder ? store.backup_folder / named : named;
    auto is_file = system::require_file(file, "the backup");
    if (is_file) return file;
    Error why = is_file.error();
    if (why.code == ErrorCode::not_found) why.message += nearest_backup(store, named);
    return tl::unexpected(std::move(why));
  }
  const auto backups = backups_of(store);
  if (!backups.empty()) return backups.front();
  return failure(ErrorCode::not_found,
                 fmt::format("there is no backup in '{}'; name a file with --backup",
                             store.backup_folder.string()));
}

std::string RestoredStore::loss() const {
  if (!unreadable.empty()) {
    return fmt::format("what the store has cannot be said: {}", unreadable);
  }
  if (!in_store) return "there is no store to replace";
  if (!in_store->newest) return "the store has no readings";
  if (!in_backup.newest) return "the backup has no readings, and the store has";
  const std::chrono::duration<double, std::ratio<3600>> later =
      *in_store->newest - *in_backup.newest;
  const std::string newest = metering::to_string(*in_store->newest);
  if (later.count() <= 0.0) {
    return fmt::format("the store has nothing newer: its newest reading is of {}", newest);
  }
  return fmt::format("the store has {:.1f} h more: its newest reading is of {}", later.count(),
                     newest);
}

Result<RestoredStore> restore_store(const SiteConfig& site, const std::filesystem::path& backup,
                                    metering::Instant now, bool dry_run,
                                    const std::function<void()>& on_progress) {
  const std::filesystem::path& store = site.store.file;
  const auto refuse = [&](const Error& error) {
    return failure(error.code, fmt::format("the backup '{}' cannot be used: {}", backup.string(),
                                           error.message));
  };
  std::error_code ignored;
  if (std::filesystem::equivalent(backup, store, ignored)) {
    return refuse({ErrorCode::invalid_value, "it is the store itself"});
  }
  auto begun = stores::begin_restoration(store, backup, on_progress);
  if (!begun) return refuse(begun.error());
  StoreRestoration& restoration = **begun;
  if (auto ours = require_meters(site, restoration.summary()); !ours) return refuse(ours.error());
  RestoredStore restored{.in_backup = restoration.summary()};
  if (std::filesystem::exists(store, ignored)) {
    auto summary = stores::summary_of(store);
    if (summary) restored.in_store = std::move(*summary);
    if (!summary) restored.unreadable = summary.error().message;
  }
  if (dry_run) return restored;
  restored.replaced = TRY(restoration.keep(now));
  return restored;
}

}  // namespace recald::daemon
