/// Tells systemd, if it started us, that we are ready and alive.
#pragma once

#include <functional>
#include <memory>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"

namespace recald::daemon {

/// Asks systemd to wait longer: a start that checks or recovers a large store takes minutes.
/// Notifies it at most every ten seconds, however often it is called.
void extend_start();

/// Feeds the watchdog while the loop is blocked but work continues.
void feed_watchdog();

/// Feeds the watchdog of the unit file as long as the loop runs and the store answers. Without a
/// watchdog it does nothing.
class Watchdog {
 public:
  /// @param is_well  Called on the loop before each feed; false lets systemd restart us.
  Watchdog(Loop& loop, std::function<bool()> is_well);

  void ready();
  void ending();

 private:
  void feed();

  Loop& loop_;
  std::function<bool()> is_well_;
  std::chrono::milliseconds period_{0};  ///< 0: no watchdog.
  Alive alive_;
};

}  // namespace recald::daemon
