/// Tells systemd, if it started us, that we are ready and alive.
#pragma once

#include <functional>
#include <memory>

#include "adapters/ports/loop.hpp"

namespace recald::daemon {

/// Whoever starts us waits longer: a start that looks through a large store, or recovers one, takes
/// minutes. Tells systemd at most every ten seconds, however often it is called.
void extend_start();

/// Feeds it while the loop is blocked but work goes on.
void feed_watchdog();

/// Feeds the watchdog of the unit file for as long as the loop turns and the store answers. Where
/// nobody watches it does nothing.
class Watchdog {
 public:
  /// @param is_well  Asked on the loop before each feed; false lets systemd restart us.
  Watchdog(Loop& loop, std::function<bool()> is_well);

  void ready();
  void ending();

 private:
  void feed();

  Loop& loop_;
  std::function<bool()> is_well_;
  std::chrono::milliseconds period_{0};  ///< 0: nobody watches.
  std::shared_ptr<Watchdog*> self_;
};

}  // namespace recald::daemon
