/// A bus as a command uses it by hand: one connection, one request after the other, none too soon.
#pragma once

#include <optional>

#include "daemon/commands/meters/try_meter.hpp"

namespace recald::daemon {

/// Why the bus had better be left alone, in a sentence: another process has the serial port open,
/// and two on one line garble each other's frames.
[[nodiscard]] std::optional<std::string> why_bus_is_taken(const BusConfig& bus);

/// How long to wait for a reply: as the meter says, else the bus, else a second.
[[nodiscard]] std::chrono::milliseconds timeout_of(const BusConfig& bus,
                                                   std::chrono::milliseconds of_meter = {});

class BusAccess {
 public:
  explicit BusAccess(const BusConfig& bus);

  /// At least the bus's `request_gap` after the last answer, and never less than 50 ms: whoever
  /// tries meters beside their owner must not keep him waiting.
  [[nodiscard]] TimedRead ask(const modbus::ReadRequest& request,
                              std::chrono::milliseconds timeout);

  [[nodiscard]] modbus::Connection& connection() { return connection_; }
  void pause();

 private:
  std::chrono::milliseconds gap_;
  modbus::Connection connection_;
  bool is_first_ = true;
};

}  // namespace recald::daemon
