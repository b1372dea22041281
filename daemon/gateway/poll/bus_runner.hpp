/// Keeps one bus busy: asks the poller what is next, reads it on the bus, and
/// passes on the outcome.
#pragma once

#include <functional>
#include <memory>

#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"
#include "daemon/gateway/poll/bus_counters.hpp"
#include "daemon/gateway/poll/bus_poller.hpp"

namespace recald::daemon {

/// The outcome of one read.
struct PolledRead {
  BusOrder order;
  modbus::ReadResult result;
  std::chrono::milliseconds lateness;  ///< Of the request, after its due time.
  std::chrono::milliseconds duration;
  Moment at;  ///< When the outcome was known; its values get this stamp.
};

/// Polling continues even if the listener throws. Lives on the loop's thread. May be destroyed at
/// any time; the outcome of a request in progress is then not reported.
class BusRunner {
 public:
  using OnRead = std::function<void(const PolledRead&)>;

  BusRunner(Loop& loop, std::unique_ptr<Bus> bus, BusPoller poller, OnRead on_read);

  void start();
  /// Restarts on another connection and keeps its counts. The outcome of a request in progress
  /// is not reported.
  /// @param make_bus  Called once the old bus has ended, because a serial line has one owner.
  void begin_anew(const std::function<std::unique_ptr<Bus>()>& make_bus);
  [[nodiscard]] const BusPoller& poller() const { return poller_; }
  [[nodiscard]] const BusCounters& counters() const { return counters_; }

 private:
  void step();
  void finish(const PolledRead& read);
  void count(const PolledRead& read);

  Loop& loop_;
  std::unique_ptr<Bus> bus_;
  BusPoller poller_;
  OnRead on_read_;
  BusCounters counters_;
  std::shared_ptr<BusRunner*> self_;  ///< Tells later calls whether this still exists.
};

}  // namespace recald::daemon
