/// A loop on a clock of its own: nothing waits, years pass in seconds.
#pragma once

#include <map>

#include "adapters/ports/loop.hpp"

namespace recald::testing {

class VirtualLoop final : public Loop {
 public:
  explicit VirtualLoop(std::chrono::sys_time<std::chrono::milliseconds> start)
      : now_{start, std::chrono::milliseconds{0}} {}

  [[nodiscard]] Moment now() const override { return now_; }
  void after(std::chrono::milliseconds wait, Call call) override;
  void post(Call call) override;

  /// Makes all calls that fall due, each at its time.
  /// @return false: it was stopped before.
  bool run_for(std::chrono::milliseconds length);
  /// From within a call: it is the last one of this run.
  void stop() { is_stopped_ = true; }

  /// Somebody sets the clock on the wall.
  void set_wall_clock(std::chrono::milliseconds forward) { now_.wall += forward; }

 private:
  void pass(std::chrono::milliseconds length);

  Moment now_;
  bool is_stopped_ = false;
  std::multimap<std::chrono::milliseconds, Call> calls_;  ///< Equal keys keep their order.
};

}  // namespace recald::testing
