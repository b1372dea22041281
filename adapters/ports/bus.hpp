/// A bus of meters: takes one read at a time and answers later.
#pragma once

#include <chrono>
#include <functional>

#include "adapters/ports/register_read.hpp"

namespace recald {

class Bus {
 public:
  /// @param duration  From request to outcome.
  using Done = std::function<void(modbus::ReadResult result, std::chrono::milliseconds duration)>;

  virtual ~Bus() = default;

  /// Begins a read, and calls `done` once on the loop's thread when it has ended.
  /// @pre no other read is in progress.
  virtual void read(const modbus::ReadRequest& request, std::chrono::milliseconds timeout,
                    Done done) = 0;
};

}  // namespace recald
