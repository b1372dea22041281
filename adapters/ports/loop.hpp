/// The one thread that does all bookkeeping: tells the time and makes delayed calls.
///
/// A port. The daemon's runs on Boost.Asio. A test's runs on its own clock, where years pass in
/// seconds and two runs with the same seed do the same.
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

  /// Makes the call once, `wait` from now by the monotonic clock, on the loop's thread. Calls for
  /// the same time are made in the order of their requests. A call that throws is repeated a minute
  /// later, so that a chain of calls that schedules itself does not break.
  virtual void after(std::chrono::milliseconds wait, Call call) = 0;

  /// Makes the call soon, on the loop's thread. The only member that other threads may use.
  virtual void post(Call call) = 0;
};

}  // namespace recald
