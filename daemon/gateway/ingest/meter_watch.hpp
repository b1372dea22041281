/// Whether a meter still gives readings, and the events about it.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "adapters/ports/store.hpp"

namespace recald::daemon {

/// How long a meter may give nothing before somebody should look: two of its intervals, and no
/// less than half an hour; a meter whose readings are pushed may send a whole day at a time.
[[nodiscard]] std::chrono::seconds meter_silence_max(std::chrono::seconds interval, bool is_polled);

/// For one meter, polled or pushed.
class MeterWatch {
 public:
  /// @param known_until  End of what the store has of a pushed meter: it may send rarely.
  /// @param is_silent    An earlier process has reported its silence, and no answer since.
  MeterWatch(std::string meter, std::chrono::seconds silence_max,
             std::optional<metering::Instant> known_until = {}, bool is_silent = false)
      : meter_(std::move(meter)),
        silence_max_(silence_max),
        since_(known_until),
        is_silent_(is_silent) {}

  [[nodiscard]] std::chrono::seconds silence_max() const { return silence_max_; }

  /// @param heard_at  When it last gave a value, in this process; nothing: it has not yet.
  /// @return what has changed since the last call.
  [[nodiscard]] std::optional<StoreEvent> evaluate(std::optional<metering::Instant> heard_at,
                                                   metering::Instant now);

  /// The time that the clock skipped is no silence.
  void clock_was_set() { since_.reset(); }

 private:
  std::string meter_;
  std::chrono::seconds silence_max_;
  std::optional<metering::Instant> since_;     ///< Silence counts from here; nothing: from now on.
  std::optional<metering::Instant> heard_at_;  ///< As last passed to evaluate().
  bool is_silent_;
};

}  // namespace recald::daemon
