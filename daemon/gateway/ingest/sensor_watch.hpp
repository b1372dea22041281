/// Whether a weather sensor still works, and the events about it.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/meter_progress.hpp"

namespace recald::daemon {

/// A longer hole is filled with typical hours instead of a straight line (`weather::fill_gaps`).
inline constexpr std::chrono::hours kPolledSilenceMax{6};
/// A pushed sensor may send a whole day at a time.
inline constexpr std::chrono::hours kPushedSilenceMax{36};

/// The faults of one quantity of a sensor.
struct ChannelState {
  std::optional<metering::Instant> silent_since;  ///< Absent: not silent.
  std::optional<metering::Instant> frozen_since;
};

/// For one sensor, polled or pushed. Events report quantities that fall silent or return, and a
/// frozen dry bulb.
class SensorWatch {
 public:
  SensorWatch(std::string sensor, bool is_polled)
      : sensor_(std::move(sensor)), is_polled_(is_polled) {}

  [[nodiscard]] bool is_polled() const { return is_polled_; }
  [[nodiscard]] ChannelState state_of(const MeterProgress& channel, metering::Instant now) const;

  /// @param channels  Of this sensor. For a pushed one, only quantities that it has sent before,
  ///                  and the dry bulb, can be missing.
  [[nodiscard]] std::vector<StoreEvent> evaluate(std::span<const MeterProgress* const> channels,
                                                 metering::Instant now);

 private:
  [[nodiscard]] StoreEvent event(Severity severity, std::string_view kind, std::string text,
                                 metering::Instant now) const;

  std::string sensor_;
  bool is_polled_;
  std::optional<metering::Instant>
      begun_;             ///< Time of the first check; a quantity never known counts from here.
  bool is_first_ = true;  ///< The check that is being made.
  std::set<std::string_view> silent_;  ///< Quantities that were reported.
  std::set<std::string_view> frozen_;
};

/// "weather sensor 'roof' has sent no dry_bulb_C since 2024-03-01T12:00:00Z"
[[nodiscard]] std::string silence_words(std::string_view sensor, std::string_view quantity,
                                        metering::Instant since);
/// "weather sensor 'roof' has reported the same dry_bulb_C since 2024-03-01T12:00:00Z"
[[nodiscard]] std::string frozen_words(std::string_view sensor, std::string_view quantity,
                                       metering::Instant since);

}  // namespace recald::daemon
