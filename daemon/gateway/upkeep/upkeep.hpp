/// Keeps a store healthy while the daemon runs: a daily backup, disk space in reserve, and bounded
/// size for everything except readings.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/store.hpp"
#include "adapters/ports/worker.hpp"
#include "adapters/system/files/reserved_space.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/site/config/service/store_config.hpp"

namespace recald::daemon {

struct UpkeepRules {
  std::uintmax_t reserve_bytes = 64 * 1024 * 1024;
  int backup_pages = 64;                ///< Of 4 KiB, copied per step.
  int rows = 500;                       ///< Deleted per step.
  std::chrono::milliseconds pause{50};  ///< Between two steps: the meters come first.
};

class Upkeep {
 public:
  /// From now on, a commit that the disk refuses is tried again after the reserve is released.
  /// @param store    Outlives the upkeep.
  /// @param checker  Checks each backup before it may replace an older one. For this object alone,
  ///                 and outlives it.
  /// @param report     Receives the events.
  Upkeep(Store& store, Worker& checker, StoreConfig config, metering::LocalCalendar calendar,
         std::function<void(StoreEvent)> report, const UpkeepRules& rules = {});
  /// Stops the checker's work early.
  ~Upkeep();
  Upkeep(const Upkeep&) = delete;
  Upkeep& operator=(const Upkeep&) = delete;

  /// Does one step of what is due; no step takes longer than a commit. A failure becomes one event,
  /// and is tried again within the hour.
  /// @param is_clock_right  No backup begins on a day that the clock does not know.
  /// @return when to call again: soon while there is work, else within the hour.
  std::chrono::milliseconds maintain(metering::Instant now, bool is_clock_right);

  /// Changes the times, place and number of backups, and the retention. @pre the same file
  void set_config(StoreConfig config) { config_ = std::move(config); }

 private:
  enum class Progress { more, done };

  void hold_reserve(metering::Instant now);
  [[nodiscard]] Result<Progress> back_up(metering::Instant now, bool is_clock_right);
  [[nodiscard]] Result<Progress> begin_backup(metering::Instant now);
  void check_backup(metering::Instant now);
  /// @param damage  The result of the check.
  void end_backup(const Result<std::string>& damage, metering::Instant now);
  /// Deletes samples and events that are too old, and surplus results.
  [[nodiscard]] Result<Progress> delete_old(metering::Instant now);
  [[nodiscard]] Result<Progress> delete_aged(metering::Instant now);
  [[nodiscard]] Result<Progress> delete_results(JobKind kind);
  [[nodiscard]] std::chrono::milliseconds until_next(metering::Instant now) const;
  void report(metering::Instant now, std::string& known, const char* kind,
              const std::string& sentence, Severity severity = Severity::warning) const;

  Store& store_;
  Worker& checker_;
  StoreConfig config_;
  metering::LocalCalendar calendar_;
  std::function<void(StoreEvent)> notify_;
  UpkeepRules rules_;
  std::shared_ptr<system::ReservedSpace> reserve_;
  std::shared_ptr<StoreBackup> backup_;  ///< In progress; shared with the checker while it checks.
  bool is_checking_ = false;
  std::optional<metering::Day>
      damaged_on_;  ///< Day whose backup was damaged; the next day gets another.
  std::stop_source stop_;
  Alive alive_;
  std::string reserve_failure_;  ///< The last failure reported.
  std::string backup_failure_;
  std::string deleting_failure_;
};

}  // namespace recald::daemon
