/// Somewhere beside the loop where long work is done, one piece at a time.
#pragma once

#include <functional>

#include "adapters/ports/loop.hpp"

namespace recald {

class Worker {
 public:
  virtual ~Worker() = default;

  /// Does `work` elsewhere and then calls `done` once, on the loop's thread. `work` must not throw.
  /// @pre nothing is under way.
  virtual void run(std::function<void()> work, Loop::Call done) = 0;
};

}  // namespace recald
