/// The store that the process runs on: the site's, or one in memory while the site's
/// cannot be opened.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "adapters/stores/open.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "daemon/site/config/service/store_config.hpp"

namespace recald::daemon {

/// A store to run on.
struct RunningStore {
  std::unique_ptr<Store> store;
  std::string missing;  ///< Why it is only in memory; empty: it is the site's store.
};

/// Opens a site's store, trying as often as needed, and holds its lock from the first success. Used
/// by one thread at a time.
class StoreOpener {
 public:
  /// As `open_store`, with its exceptions caught.
  /// @return the store; or io_failed: not now; or an error that waiting does not fix: unsupported,
  ///         or another recald runs on it.
  [[nodiscard]] Result<stores::CheckedStore> open(const StoreConfig& config, metering::Instant now,
                                                  const std::function<void()>& on_progress = {});

  /// Wait before the next try: ten seconds. While a recovery is unfinished, each try reads all of a
  /// large store, so the wait doubles, up to ten minutes.
  [[nodiscard]] std::chrono::seconds wait() const { return wait_; }

  /// Call when the opened store could not be used.
  void back_off();

 private:
  [[nodiscard]] Result<stores::CheckedStore> try_to_open(const StoreConfig& config,
                                                         metering::Instant now,
                                                         const std::function<void()>& on_progress);

  std::optional<system::FileLock> lock_;
  std::chrono::seconds wait_{10};
};

/// Opens the site's store; if that fails for now, one in memory, so that meters are polled anyway
/// and their readings can be moved later.
[[nodiscard]] Result<RunningStore> open_running_store(StoreOpener& opener,
                                                      const StoreConfig& config,
                                                      metering::Instant now,
                                                      const std::function<void()>& on_progress);

}  // namespace recald::daemon
