#include "daemon/gateway/run/running_store.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "daemon/gateway/upkeep/open_store.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::seconds kWaitMin{10};
constexpr std::chrono::seconds kWaitMax{600};

/// The file name is set in adapters/sqlite/recovery.
bool has_unfinished_recovery(const StoreConfig& config) {
  std::error_code ignored;
  return std::filesystem::exists(config.file.string() + ".recovery", ignored);
}

}  // namespace

void StoreOpener::back_off() { wait_ = std::min(2 * wait_, kWaitMax); }

Result<stores::CheckedStore> StoreOpener::try_to_open(const StoreConfig& config,
                                                      metering::Instant now,
                                                      const std::function<void()>& on_progress) {
  if (!lock_) {
    lock_ = TRY(system::FileLock::acquire(config.file.string() + ".lock"));
  }
  return open_store(config, now, on_progress);
}

Result<stores::CheckedStore> StoreOpener::open(const StoreConfig& config, metering::Instant now,
                                               const std::function<void()>& on_progress) {
  Result<stores::CheckedStore> opened;
  try {
    opened = try_to_open(config, now, on_progress);
  } catch (const std::exception& thrown) {
    opened = failure(ErrorCode::io_failed,
                     fmt::format("'{}' cannot be opened: {}", config.file.string(), thrown.what()));
  }
  if (opened) return opened;
  if (has_unfinished_recovery(config)) {
    back_off();
  } else {
    wait_ = kWaitMin;
  }
  return opened;
}

Result<RunningStore> open_running_store(StoreOpener& opener, const StoreConfig& config,
                                        metering::Instant now,
                                        const std::function<void()>& on_progress) {
  auto opened = opener.open(config, now, on_progress);
  if (opened) {
    if (!opened->recovery.empty()) {
      spdlog::error("event=store_recovered what=\"{}\"", opened->recovery);
    }
    return RunningStore{std::move(opened->store), ""};
  }
  std::error_code ignored;
  const bool is_of_the_disk = opened.error().code == ErrorCode::io_failed &&
                              !std::filesystem::is_directory(config.file, ignored);
  if (!is_of_the_disk) return tl::unexpected(opened.error());
  auto memory = TRY(stores::open_in_memory());
  return RunningStore{std::move(memory), opened.error().message};
}

}  // namespace recald::daemon
