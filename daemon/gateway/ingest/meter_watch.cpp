#include "daemon/gateway/ingest/meter_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::daemon {

using metering::Instant;

std::chrono::seconds meter_silence_max(std::chrono::seconds interval, bool is_polled) {
  if (!is_polled) return std::chrono::hours{36};
  return std::max<std::chrono::seconds>(2 * interval, std::chrono::minutes{30});
}

std::optional<StoreEvent> MeterWatch::evaluate(std::optional<Instant> heard_at, Instant now) {
  // Only a new value counts: whatever the clock does, it has another time than the last.
  const bool is_heard = heard_at && heard_at != heard_at_;
  if (is_heard) heard_at_ = heard_at;
  since_ = is_heard ? std::min(*heard_at, now) : since_.value_or(now);
  const bool stays_silent = is_silent_ && !is_heard;
  const bool was_silent = std::exchange(is_silent_, stays_silent || now - *since_ > silence_max_);
  if (is_silent_ == was_silent) return std::nullopt;
  const auto event = [&](Severity severity, const char* kind, std::string text) {
    return StoreEvent{.time = now,
                      .severity = severity,
                      .kind = kind,
                      .subject = meter_,
                      .text = std::move(text)};
  };
  if (!is_silent_) {
    return event(Severity::info, "meter_answers", fmt::format("meter '{}' answers again", meter_));
  }
  return event(Severity::warning, "meter_silent",
               fmt::format("meter '{}' has given no reading since {}; its readings are missing "
                           "until it answers",
                           meter_, metering::to_string(*since_)));
}

}  // namespace recald::daemon
