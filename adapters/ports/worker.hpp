/// Runs long work outside the loop, one piece at a time.
#pragma once

#include <functional>

#include "adapters/ports/loop.hpp"

namespace recald {

class Worker {
 public:
  virtual ~Worker() = default;

  /// Runs `work` elsewhere, then calls `done` once on the loop's thread. `work` must not throw.
  /// @pre no other work is in progress.
  virtual void run(std::function<void()> work, Loop::Call done) = 0;
};

}  // namespace recald
