/// Whether a device answers, and how often to try a silent one.
#pragma once

#include <chrono>
#include <cstdint>

#include "core/random/rng.hpp"

namespace recald::daemon {

enum class UnitState : std::uint8_t {
  down,      ///< Missed several polls in a row: gets only a cheap probe now and then.
  degraded,  ///< Missed the last poll.
  up,
};

struct HealthRules {
  int down_after = 3;                          ///< Misses in a row.
  std::chrono::milliseconds probe_min{5'000};  ///< Wait before the first probe; doubles.
  std::chrono::milliseconds probe_max{300'000};
  double probe_jitter = 0.1;  ///< Keeps devices that lost power together from being probed in step.
};

/// One device. Times are monotonic. Retries never stop, so no state needs a restart.
class UnitHealth {
 public:
  explicit UnitHealth(const HealthRules& rules = {}) : rules_(rules) {}

  [[nodiscard]] UnitState state() const;
  [[nodiscard]] int misses() const { return misses_; }  ///< In a row.
  /// When a unit that is down gets its next probe.
  [[nodiscard]] std::chrono::milliseconds next_probe() const { return next_probe_; }

  void answered();
  void missed(std::chrono::milliseconds now, Rng& rng);

 private:
  HealthRules rules_;
  int misses_ = 0;
  std::chrono::milliseconds wait_{0};
  std::chrono::milliseconds next_probe_{0};
};

}  // namespace recald::daemon
