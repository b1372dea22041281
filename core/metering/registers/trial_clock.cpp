#include "core/metering/registers/trial_clock.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace recald::metering {
namespace {

constexpr auto kForm =
    "write START@ANCHORxSPEED, such as 2026-01-30T00:00:00Z@1769900000x600: the start of the "
    "trial, the real time at that start in seconds since 1970, and how much faster time runs";

template <class Number>
std::optional<Number> whole(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end) return {};
  return value;
}

/// Accepts exactly the form "2026-01-30T00:00:00Z".
std::optional<Instant> parse_instant(std::string_view text) {
  if (text.size() != 20 || text[10] != 'T' || text[13] != ':' || text[16] != ':' ||
      text[19] != 'Z') {
    return {};
  }
  const auto day = parse_day(text.substr(0, 10));
  const auto hour = whole<int>(text.substr(11, 2));
  const auto minute = whole<int>(text.substr(14, 2));
  const auto second = whole<int>(text.substr(17, 2));
  if (!day || !hour || !minute || !second) return {};
  const auto within = [](int value, int end) { return 0 <= value && value < end; };
  if (!within(*hour, 24) || !within(*minute, 60) || !within(*second, 60)) return {};
  return std::chrono::sys_days{*day} + std::chrono::hours{*hour} + std::chrono::minutes{*minute} +
         std::chrono::seconds{*second};
}

}  // namespace

TrialClock::Milliseconds TrialClock::simulated(Microseconds real) const {
  const double elapsed_ms = static_cast<double>((real - Microseconds{anchor}).count()) / 1e3;
  return Milliseconds{start} + std::chrono::milliseconds{std::llround(elapsed_ms * speed)};
}

std::chrono::nanoseconds TrialClock::real_wait(std::chrono::milliseconds simulated_wait) const {
  // Rounded up, so that nobody wakes before the instant they wait for.
  return std::chrono::nanoseconds{
      std::llround(std::ceil(static_cast<double>(simulated_wait.count()) * 1e6 / speed))};
}

Result<TrialClock> parse_trial_clock(std::string_view text) {
  const auto at = text.find('@');
  const auto times = text.find('x', at == std::string_view::npos ? 0 : at);
  std::optional<Instant> start;
  std::optional<std::int64_t> anchor;
  std::optional<double> speed;
  if (at != std::string_view::npos && times != std::string_view::npos) {
    start = parse_instant(text.substr(0, at));
    anchor = whole<std::int64_t>(text.substr(at + 1, times - at - 1));
    speed = whole<double>(text.substr(times + 1));
  }
  if (!start || !anchor || *anchor < 0 || *anchor >= kLatestInstant.time_since_epoch().count() ||
      !speed || !(*speed > 0.0 && *speed <= 1e6)) {
    return failure(ErrorCode::malformed,
                   "the clock '" + std::string{text} + "' is not valid; " + kForm);
  }
  return TrialClock{*start, Instant{std::chrono::seconds{*anchor}}, *speed};
}

}  // namespace recald::metering
