/// Whether a meter still gives readings, and the events about it.
#pragma once

#include <optional>
#include <string>

#include "adapters/ports/store.hpp"

namespace recald::daemon {

/// How long a meter may give nothing before somebody should look: two of its intervals, and no
/// less than half an hour; a meter whose readings are pushed may send a whole day at a time.
[[nodiscard]] std::chrono::seconds meter_silence_max(std::chrono::seconds interval, bool is_polled);

/// For one meter, polled or pushed.
class MeterWatch {
 public:
  MeterWatch(std::string meter, std::chrono::seconds silence_max)
      : meter_(std::move(meter)), silence_max_(silence_max) {}

  [[nodiscard]] std::chrono::seconds silence_max() const { return silence_max_; }

  /// @param heard_at  When it last gave a good value, in this process; nothing: it has not yet.
  /// @return what has changed since the last call.
  [[nodiscard]] std::optional<StoreEvent> judge(std::optional<metering::Instant> heard_at,
                                                metering::Instant now);

  /// The time that the clock skipped is no silence.
  void clock_was_set() { since_.reset(); }

 private:
  std::string meter_;
  std::chrono::seconds silence_max_;
  /// When it was last heard, or of the first check: silence counts from here.
  std::optional<metering::Instant> since_;
  bool is_silent_ = false;
};

}  // namespace recald::daemon
