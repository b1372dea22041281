#include "daemon/gateway/run/clock_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::days;
using std::chrono::milliseconds;

constexpr milliseconds kClockWasSet{2'000};
/// A clock without a time server is set by hours by people: summer time, time zones.
constexpr days kBehindMax{1};
/// So long after all it knows, a clock without a time server is wrong: no gateway lives as long.
constexpr std::chrono::years kAheadMax{20};
/// Calendars of months need what comes after them.
constexpr days kMonthsAhead{62};

}  // namespace

milliseconds ClockWatch::look(const Moment& now) {
  const milliseconds offset = now.wall.time_since_epoch() - now.monotonic;
  milliseconds moved = offset - wall_minus_monotonic_.value_or(offset);
  wall_minus_monotonic_ = offset;
  if (moved <= kClockWasSet && -moved <= kClockWasSet) moved = milliseconds{0};
  was_set_ = was_set_ || moved != milliseconds{0};
  doubt_ = doubt_about(now.instant());
  is_believed_ = doubt_.empty();
  if (is_believed_) newest_ = now.instant();
  return moved;
}

std::string ClockWatch::doubt_about(Instant now) const {
  if (evidence_ && evidence_->recorded_doubt) return evidence_->recorded_doubt();
  const Instant first{std::chrono::sys_days{metering::kFirstKnownYear / std::chrono::January / 2}};
  if (now < first || now >= metering::kLatestInstant - kMonthsAhead) {
    return fmt::format("it says {}, but recald knows the years {}", metering::to_string(now),
                       metering::kKnownYears);
  }
  if (!evidence_) return {};
  if (now < evidence_->released) {
    return fmt::format("it says {}, before this version of recald was made",
                       metering::to_string(now));
  }
  // Once believed it is not asked again: a clock that loses its server keeps running.
  if (!is_believed_ && evidence_->is_settling && evidence_->is_settling()) {
    return "the machine has just started and has not heard from a time server";
  }
  // Whoever sets a clock, server or person, knows better than what was recorded by the old one.
  const bool is_behind = !was_set_ && !is_believed_ && newest_ && now < *newest_ - kBehindMax;
  const Instant known = std::max(evidence_->released, newest_.value_or(evidence_->released));
  const bool is_ahead = now > known + kAheadMax;
  if ((!is_behind && !is_ahead) || (evidence_->is_synchronised && evidence_->is_synchronised())) {
    return {};
  }
  return fmt::format(
      "it says {}, {} {}, and no time server is heard; set the clock", metering::to_string(now),
      is_behind ? "but the store has readings until" : "more than 20 years after the last known,",
      metering::to_string(is_behind ? *newest_ : known));
}

}  // namespace recald::daemon
