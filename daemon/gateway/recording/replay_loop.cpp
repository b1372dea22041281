#include "daemon/gateway/recording/replay_loop.hpp"

namespace recald::daemon::recording {

void ReplayLoop::advance_to(const Moment& to) {
  while (!waiting_.empty() && waiting_.begin()->first <= to.monotonic) {
    const auto next = waiting_.begin();
    const Call call = std::move(next->second);
    if (next->first > now_.monotonic) {
      now_ = {now_.wall + (next->first - now_.monotonic), next->first};
    }
    waiting_.erase(next);
    call();
  }
  now_ = to;
}

bool ReplayLoop::run_posted() {
  if (posted_.empty()) return false;
  const Call call = std::move(posted_.front());
  posted_.pop_front();
  call();
  return true;
}

}  // namespace recald::daemon::recording
