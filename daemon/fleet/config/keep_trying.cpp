#include "daemon/fleet/config/keep_trying.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace recald::daemon {
namespace {

constexpr std::chrono::seconds kRetryMin{5};
constexpr std::chrono::seconds kRetryMax{60};

}  // namespace

void keep_trying(const std::string& meanwhile, const std::function<Result<void>()>& work,
                 const Report& report, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  auto wait = kRetryMin;
  std::string last_reason;
  while (!stop.stop_requested()) {
    const auto begin = std::chrono::steady_clock::now();
    const Result<void> ended = work();
    if (ended || stop.stop_requested()) return;
    const bool has_worked = std::chrono::steady_clock::now() - begin > kRetryMax;
    if (has_worked) wait = kRetryMin;
    if (std::exchange(last_reason, ended.error().message) != ended.error().message || has_worked) {
      report(fmt::format("{}: {}; trying again", meanwhile, last_reason));
    }
    std::unique_lock lock{mutex};
    stopped.wait_for(lock, stop, wait, [] { return false; });
    wait = std::min(2 * wait, kRetryMax);
  }
}

}  // namespace recald::daemon
