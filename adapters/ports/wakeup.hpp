/// One call at the earliest of the times that were asked for.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"

namespace recald {

/// A member of the object that is called: nothing comes after its end.
class Wakeup {
 public:
  Wakeup(Loop& loop, std::function<void()> poll) : loop_(loop), poll_(std::move(poll)) {}

  void after(std::chrono::milliseconds wait) {
    const std::chrono::milliseconds due = loop_.now().monotonic + wait;
    if (due_ && *due_ <= due) return;
    due_ = due;
    loop_.after(wait, alive_.guard([this, due] {
      if (due_ != due) return;
      due_.reset();
      poll_();
    }));
  }
  void cancel() { due_.reset(); }

 private:
  Loop& loop_;
  std::function<void()> poll_;
  std::optional<std::chrono::milliseconds> due_;  ///< By the monotonic clock.
  Alive alive_;
};

}  // namespace recald
