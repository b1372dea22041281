/// What keeps a store healthy while the daemon runs: a daily backup, room in reserve, and nothing
/// that grows for ever but readings.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "adapters/ports/store.hpp"
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
  /// @param store  Outlives the upkeep.
  /// @param tell   Takes the events.
  Upkeep(Store& store, StoreConfig config, metering::LocalCalendar calendar,
         std::function<void(StoreEvent)> tell, const UpkeepRules& rules = {});

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
  /// Samples and events that are too old, results that are too many.
  [[nodiscard]] Result<Progress> delete_old(metering::Instant now);
  [[nodiscard]] Result<Progress> delete_results(JobKind kind);
  [[nodiscard]] std::chrono::milliseconds until_next(metering::Instant now) const;
  void tell(metering::Instant now, std::string& known, const char* kind,
            const std::string& sentence) const;

  Store& store_;
  StoreConfig config_;
  metering::LocalCalendar calendar_;
  std::function<void(StoreEvent)> tell_;
  UpkeepRules rules_;
  std::shared_ptr<system::ReservedSpace> reserve_;
  std::unique_ptr<StoreBackup> backup_;  ///< Under way.
  std::string reserve_failure_;          ///< The last one told.
  std::string backup_failure_;
  std::string deleting_failure_;
};

}  // namespace recald::daemon
