/// A loop on a clock of its own: nothing waits, years pass in seconds.
#pragma once

#include <map>
#include <utility>

#include "adapters/ports/loop.hpp"

namespace recald::testing {

class VirtualLoop final : public Loop {
 public:
  explicit VirtualLoop(std::chrono::sys_time<std::chrono::milliseconds> start)
      : now_{start, std::chrono::milliseconds{0}} {}

  [[nodiscard]] Moment now() const override { return now_; }
  void after(std::chrono::milliseconds wait, Call call) override {
    calls_.emplace(now_.monotonic + std::max(wait, std::chrono::milliseconds{0}), std::move(call));
  }
  void post(Call call) override { after(std::chrono::milliseconds{0}, std::move(call)); }

  /// Makes all calls that fall due, each at its time.
  /// @return false: it was stopped before.
  bool run_for(std::chrono::milliseconds length) {
    const auto end = now_.monotonic + length;
    is_stopped_ = false;
    while (!calls_.empty() && calls_.begin()->first <= end) {
      auto next = calls_.extract(calls_.begin());
      pass(next.key() - now_.monotonic);
      next.mapped()();
      if (is_stopped_) return false;
    }
    pass(end - now_.monotonic);
    return true;
  }
  /// From within a call: it is the last one of this run.
  void stop() { is_stopped_ = true; }

  /// Somebody sets the clock on the wall.
  void set_wall_clock(std::chrono::milliseconds forward) { now_.wall += forward; }

 private:
  void pass(std::chrono::milliseconds length) {
    now_.wall += length;
    now_.monotonic += length;
  }

  Moment now_;
  bool is_stopped_ = false;
  std::multimap<std::chrono::milliseconds, Call> calls_;  ///< Equal keys keep their order.
};

}  // namespace recald::testing
