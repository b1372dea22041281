#include "daemon/gateway/poll/unit_health.hpp"

#include <algorithm>

namespace recald::daemon {

using std::chrono::milliseconds;

UnitState UnitHealth::state() const {
  if (misses_ == 0) return UnitState::up;
  return misses_ < rules_.down_after ? UnitState::degraded : UnitState::down;
}

void UnitHealth::answered() {
  misses_ = 0;
  wait_ = milliseconds{0};
}

void UnitHealth::missed(milliseconds now, Rng& rng) {
  misses_ = std::min(misses_ + 1, rules_.down_after);
  if (state() != UnitState::down) return;
  wait_ = wait_ == milliseconds{0} ? rules_.probe_min : std::min(2 * wait_, rules_.probe_max);
  const double jitter = rng.uniform(1.0 - rules_.probe_jitter, 1.0 + rules_.probe_jitter);
  next_probe_ =
      now + milliseconds{static_cast<std::int64_t>(static_cast<double>(wait_.count()) * jitter)};
}

}  // namespace recald::daemon
