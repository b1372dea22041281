#include "daemon/gateway/poll/poll_times.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;

/// Leaves a fifth of the second for the reads themselves.
constexpr milliseconds kBoundarySpread{800};
/// Of a period, for all units of a bus.
constexpr double kBusShare = 0.25;

milliseconds share_of(milliseconds length, double share) {
  return std::chrono::floor<milliseconds>(share *
                                          std::chrono::duration<double, std::milli>{length});
}

/// The first time after `t` that is a multiple of `step`, shifted.
WallTime next_multiple(WallTime t, milliseconds step, milliseconds shift) {
  return t - (t - shift).time_since_epoch() % step + step;
}

}  // namespace

PollTimes::PollTimes(milliseconds period, milliseconds interval, double phase)
    : period_(period),
      interval_(interval),
      shift_(share_of(period, phase < 0.5 ? phase : phase - 1.0)),
      boundary_delay_(share_of(std::min(kBoundarySpread, period / 2), phase)) {
  assert(period > milliseconds{0} && interval > milliseconds{0} && 0.0 <= phase && phase < 1.0);
}

WallTime PollTimes::after(WallTime t) const {
  const WallTime boundary = next_multiple(t, interval_, boundary_delay_);
  const auto is_boundary = [&](WallTime regular) {
    return (regular - shift_).time_since_epoch() % interval_ == milliseconds{0};
  };
  WallTime regular = next_multiple(t, period_, shift_);
  // If the next multiple is a boundary too, every one is.
  if (is_boundary(regular)) regular += period_;
  return is_boundary(regular) ? boundary : std::min(regular, boundary);
}

double poll_phase(std::string_view bus, std::size_t unit, std::size_t units) {
  assert(unit < units);
  constexpr double kHashes = 18446744073709551616.0;  // 2^64
  const auto hash = static_cast<std::uint64_t>(std::hash<std::string_view>{}(bus));
  const double of_bus = static_cast<double>(hash) / kHashes;
  const double phase = of_bus + kBusShare * static_cast<double>(unit) / static_cast<double>(units);
  return phase - std::floor(phase);
}

}  // namespace recald::daemon
