/// Keeps a store healthy while the daemon runs: a daily backup, space in reserve, and nothing that
/// grows for ever except readings.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "adapters/ports/store.hpp"
#include "adapters/ports/worker.hpp"
#include "adapters/system/reserved_space.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/site/config/store_config.hpp"

namespace recald::daemon {

struct UpkeepRules {
  std::uintmax_t reserve_bytes = 64 * 1024 * 1024;
  int backup_pages = 64;                ///< Of 4 KiB, copied in one go.
  int rows = 500;                       ///< Deleted in one go.
  std::chrono::milliseconds pause{50};  ///< Between two portions: the meters come first.
};

class Upkeep {
 public:
  /// From now on a commit that the disk refuses is tried again once the reserve is given up.
  /// @param store    Outlives the upkeep.
  /// @param checker  Looks through each backup before it may take the place of an older one: nobody
  ///                 else's, and it outlives the upkeep.
  /// @param tell     Takes the events.
  Upkeep(Store& store, Worker& checker, StoreConfig config, metering::LocalCalendar calendar,
         std::function<void(StoreEvent)> tell, const UpkeepRules& rules = {});
  /// What the checker is about ends soon.
  ~Upkeep();
  Upkeep(const Upkeep&) = delete;
  Upkeep& operator=(const Upkeep&) = delete;

  /// Does one portion of what is due; none takes longer than a commit. What fails becomes an event,
  /// once, and is tried again within the hour.
  /// @return when to call again: soon while there is work, within the hour otherwise.
  std::chrono::milliseconds maintain(metering::Instant now);

  /// Other times, places and numbers of backups, and another retention. @pre the same file
  void set_config(StoreConfig config) { config_ = std::move(config); }

 private:
  enum class Progress { more, done };

  void hold_reserve(metering::Instant now);
  [[nodiscard]] Result<Progress> back_up(metering::Instant now);
  [[nodiscard]] Result<Progress> begin_backup(metering::Instant now);
  void check_backup(metering::Instant now);
  /// @param damage  What the check has found.
  void end_backup(const Result<std::string>& damage, metering::Instant now);
  /// Samples and events that are too old, results that are too many.
  [[nodiscard]] Result<Progress> delete_old(metering::Instant now);
  [[nodiscard]] Result<Progress> delete_aged(metering::Instant now);
  [[nodiscard]] Result<Progress> delete_results(JobKind kind);
  [[nodiscard]] std::chrono::milliseconds until_next(metering::Instant now) const;
  void tell(metering::Instant now, std::string& known, const char* kind,
            const std::string& sentence, Severity severity = Severity::warning) const;

  Store& store_;
  Worker& checker_;
  StoreConfig config_;
  metering::LocalCalendar calendar_;
  std::function<void(StoreEvent)> tell_;
  UpkeepRules rules_;
  std::shared_ptr<system::ReservedSpace> reserve_;
  std::shared_ptr<StoreBackup> backup_;  ///< Under way; the checker's too while it checks.
  bool is_checking_ = false;
  std::optional<metering::Day>
      damaged_on_;  ///< Whose backup was damaged; the next day has another.
  std::stop_source stop_;
  std::shared_ptr<Upkeep*> self_;
  std::string reserve_failure_;  ///< The last one told.
  std::string backup_failure_;
  std::string deleting_failure_;
};

}  // namespace recald::daemon
