/// The store that the process runs on: the site's, or one in memory until the disk lets us have it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "adapters/stores/open.hpp"
#include "adapters/system/file_lock.hpp"
#include "daemon/site/config/store_config.hpp"

namespace recald::daemon {

/// A store to run on.
struct RunningStore {
  std::unique_ptr<Store> store;
  std::string missing;  ///< Why it only lives in memory; empty: it is the site's.
};

/// Opens a site's store, as often as it takes, and holds its lock from the first time that it can
/// be had. Used by one thread at a time.
class StoreOpener {
 public:
  /// As `open_store`, whatever that throws.
  /// @return io_failed: not now; else what no waiting helps against: unsupported, another recald
  ///         runs on it.
  [[nodiscard]] Result<stores::CheckedStore> open(const StoreConfig& config, metering::Instant now,
                                                  const std::function<void()>& on_progress = {});

  /// How long to wait before the next try: ten seconds. As long as a recovery is unfinished, which
  /// reads all of a large store each time, twice as long as before, up to ten minutes.
  [[nodiscard]] std::chrono::seconds wait() const { return wait_; }

  /// What was opened could not be used.
  void back_off();

 private:
  [[nodiscard]] Result<stores::CheckedStore> try_to_open(const StoreConfig& config,
                                                         metering::Instant now,
                                                         const std::function<void()>& on_progress);

  std::optional<system::FileLock> lock_;
  std::chrono::seconds wait_{10};
};

/// The site's store; where the disk does not let us have it, one in memory: meters are polled at
/// any rate, and what they say can be taken over later.
[[nodiscard]] Result<RunningStore> open_running_store(StoreOpener& opener,
                                                      const StoreConfig& config,
                                                      metering::Instant now,
                                                      const std::function<void()>& on_progress);

}  // namespace recald::daemon
