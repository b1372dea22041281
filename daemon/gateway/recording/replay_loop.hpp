/// A loop whose time is that of a recording.
#pragma once

#include <deque>
#include <map>
#include <utility>

#include "adapters/ports/loop.hpp"

namespace recald::daemon::recording {

class ReplayLoop final : public Loop {
 public:
  [[nodiscard]] Moment now() const override { return now_; }
  void after(std::chrono::milliseconds wait, Call call) override {
    waiting_.emplace(now_.monotonic + wait, std::move(call));
  }
  void post(Call call) override { posted_.push_back(std::move(call)); }

  /// Makes the calls that fall due until then, each at its time. What was posted waits.
  /// @pre `to` is not earlier by the monotonic clock
  void advance_to(const Moment& to);

  /// Makes the call that was posted first. @return false: there is none.
  bool run_posted();

 private:
  Moment now_{};
  std::multimap<std::chrono::milliseconds, Call> waiting_;  ///< Equal keys keep their order.
  std::deque<Call> posted_;
};

}  // namespace recald::daemon::recording
