/// The one thread that all bookkeeping happens on: what time it is, and calls at a later one.
///
/// A port. The daemon's runs on Boost.Asio; a test's runs on a clock of its own making, where years
/// pass in seconds and two runs with the same seed do the same.
#pragma once

#include <chrono>
#include <functional>

#include "adapters/ports/clock.hpp"

namespace recald {

class Loop {
 public:
  using Call = std::function<void()>;

  virtual ~Loop() = default;

  [[nodiscard]] virtual Moment now() const = 0;

  /// Calls once, `wait` from now by the monotonic clock, on the loop's thread. Calls of one time
  /// are made in the order in which they were asked for. One that throws is made again a minute
  /// later, so that what goes on by asking for the next call goes on.
  virtual void after(std::chrono::milliseconds wait, Call call) = 0;

  /// Calls soon, on the loop's thread. The only member that other threads may use.
  virtual void post(Call call) = 0;
};

}  // namespace recald
