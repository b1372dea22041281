#include "daemon/gateway/upkeep/restore.hpp"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "adapters/stores/open.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "adapters/system/files/file_rights.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/gateway/upkeep/backups.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string newest_words(const StoreSummary& summary) {
  return summary.newest ? "newest reading " + metering::to_string(*summary.newest)
                        : std::string{"no readings"};
}

Json json_of(const StoreSummary& summary) {
  return {{"schema_version", summary.schema_version},
          {"meters", summary.meters},
          {"newest_reading", summary.newest ? Json(metering::to_string(*summary.newest)) : Json()}};
}

int list_backups(const SiteConfig& site, const RestoreArguments& arguments,
                 const Console& console) {
  Json list = Json::array();
  for (const auto& file : backups_of(site.store)) {
    std::error_code ignored;
    const auto bytes = std::filesystem::file_size(file, ignored);
    const auto summary = stores::summary_of(file);
    Json one{{"file", file.string()}, {"bytes", bytes}};
    one.update(summary ? json_of(*summary) : Json{{"problem", summary.error().message}});
    list.push_back(one);
    if (arguments.json) continue;
    console.out << fmt::format("{}  {:.1f} MiB, {}\n", file.filename().string(),
                               static_cast<double>(bytes) / 1048576.0,
                               summary ? newest_words(*summary) : summary.error().message);
  }
  if (arguments.json) console.out << Json{{"backups", list}}.dump(2) << "\n";
  if (list.empty() && !arguments.json) {
    console.out << fmt::format("there is no backup in '{}'\n", site.store.backup_folder.string());
  }
  return kSuccess;
}

/// An earlier call that was ended after it had decided.
int finish(const StoreConfig& store, const RestoreArguments& arguments, const Console& console) {
  if (arguments.dry_run) {
    return console.fail(
        "a restoration was interrupted after its backup was checked; recald restore without "
        "--dry-run, or the start of the daemon, finishes it");
  }
  const auto replaced = stores::finish_restoration(store.file);
  if (!replaced) return console.fail(replaced.error());
  if (arguments.json) {
    console.out << Json{{"finished", true}, {"replaced", replaced->string()}}.dump(2) << "\n";
    return kSuccess;
  }
  console.out << "finished the restoration that was interrupted; call recald restore again for "
                 "another backup\n";
  return kSuccess;
}

void print_words(const std::filesystem::path& backup, const RestoredStore& restored, bool dry_run,
                 const Console& console) {
  console.out << fmt::format(
      "{}: intact, {} meter{}, {}\n", backup.filename().string(), restored.in_backup.meters.size(),
      restored.in_backup.meters.size() == 1 ? "" : "s", newest_words(restored.in_backup));
  console.out << restored.loss() << "\n";
  if (dry_run) {
    console.out << "dry run: nothing was changed\n";
    return;
  }
  console.out << "the backup is in place; start the daemon\n";
  if (!restored.replaced.empty()) {
    console.out << fmt::format(
        "the store that was there is kept as '{}'; delete it when you no "
        "longer need it\n",
        restored.replaced.filename().string());
  }
}

}  // namespace

int run_restore(const RestoreArguments& arguments, const Console& console) {
  const auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  const StoreConfig& store = site->config.store;
  if (arguments.list) return list_backups(site->config, arguments, console);
  const std::filesystem::path lock_file = store.file.string() + ".lock";
  const auto lock = system::FileLock::acquire(lock_file);
  if (!lock) {
    return console.fail(lock.error().message + "; stop the daemon, restore, and start it again");
  }
  system::own_like(lock_file, std::filesystem::absolute(store.file).parent_path());
  if (stores::has_unfinished_restoration(store.file)) return finish(store, arguments, console);
  const auto backup = chosen_backup(store, arguments.backup);
  if (!backup) return console.fail(backup.error());
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto restored = restore_store(site->config, *backup, now, arguments.dry_run);
  if (!restored) return console.fail(restored.error());
  if (!arguments.json) {
    print_words(*backup, *restored, arguments.dry_run, console);
    return kSuccess;
  }
  const Json json{{"backup", backup->string()},
                  {"in_backup", json_of(restored->in_backup)},
                  {"in_store", restored->in_store ? json_of(*restored->in_store) : Json()},
                  {"loss", restored->loss()},
                  {"replaced", restored->replaced.string()},
                  {"dry_run", arguments.dry_run}};
  console.out << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
  return kSuccess;
}

}  // namespace recald::daemon
