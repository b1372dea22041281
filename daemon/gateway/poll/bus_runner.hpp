/// One bus, kept busy: asks its poller what is next, its bus to read it, and hands on the outcome.
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
  std::chrono::milliseconds lateness;  ///< Of the request, behind its due time.
  std::chrono::milliseconds duration;
  Moment at;  ///< When the outcome was known: what its values are stamped with.
};

/// Polling continues whatever the listener throws. Lives on the loop's thread. May be destroyed at
/// any time; the outcome of a request in progress is then not reported.
class BusRunner {
 public:
  using OnRead = std::function<void(const PolledRead&)>;

  BusRunner(Loop& loop, std::unique_ptr<Bus> bus, BusPoller poller, OnRead on_read);

  void start();
  /// Starts again on another connection and keeps its counts. The outcome of a request in progress
  /// is not reported.
  /// @param make_bus  Called once the old bus has ended: a serial line has one owner.
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
  std::shared_ptr<BusRunner*> self_;  ///< Calls that come later find out whether this still is.
};

}  // namespace recald::daemon
