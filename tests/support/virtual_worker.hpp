/// A worker on the virtual loop: work takes as long as a test says, and none of its own threads.
#pragma once

#include <utility>

#include "adapters/ports/worker.hpp"

namespace recald::testing {

class VirtualWorker final : public Worker {
 public:
  /// @param length  Of every piece of work; it happens at the end of it.
  VirtualWorker(Loop& loop, std::chrono::milliseconds length) : loop_(loop), length_(length) {}

  void run(std::function<void()> work, Loop::Call done) override {
    loop_.after(length_, [work = std::move(work), done = std::move(done)] {
      work();
      done();
    });
  }

 private:
  Loop& loop_;
  std::chrono::milliseconds length_;
};

}  // namespace recald::testing
