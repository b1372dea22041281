/// Whether the gateway's clock shows the time: only then are readings stamped by it.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "adapters/ports/loop.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::daemon {

/// What a machine knows of the time besides its clock.
struct ClockEvidence {
  metering::Instant released;  ///< When this program was made: no clock before is right.
  /// Whether the clock is about to be set; not asked again once it is believed. Absent: never.
  std::function<bool()> is_settling = {};
  /// Whether a time server sets the clock. Absent: none does.
  std::function<bool()> is_synchronised = {};
  /// In a replay: what ClockWatch::doubt() was, instead of all the above.
  std::function<std::string()> recorded_doubt = {};
};

class ClockWatch {
 public:
  /// @param evidence  Nothing: a trial's clock, which shows the time that the trial is about.
  /// @param newest    End of the newest reading in the store.
  explicit ClockWatch(std::optional<ClockEvidence> evidence,
                      std::optional<metering::Instant> newest = {})
      : evidence_(std::move(evidence)), newest_(newest) {}

  /// Looks at the clock.
  /// @return by how much it was set since the last look, forward or back; zero: it was not.
  std::chrono::milliseconds look(const Moment& now);

  [[nodiscard]] bool is_believed() const { return is_believed_; }
  /// "it says 2000-01-01T00:00:00Z, before …"; empty if the clock is believed.
  [[nodiscard]] const std::string& doubt() const { return doubt_; }

 private:
  [[nodiscard]] std::string doubt_about(metering::Instant now) const;

  std::optional<ClockEvidence> evidence_;
  std::optional<metering::Instant> newest_;  ///< In the store, or when the clock was last believed.
  std::optional<std::chrono::milliseconds> wall_minus_monotonic_;
  bool was_set_ = false;  ///< While this ran.
  bool is_believed_ = false;
  std::string doubt_ = "it was not looked at yet";
};

}  // namespace recald::daemon
