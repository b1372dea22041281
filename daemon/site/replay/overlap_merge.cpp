#include "daemon/site/replay/overlap_merge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::Reading;

constexpr std::chrono::days kHeld{800};

bool is_same_value(const Reading& a, const Reading& b) {
  const double larger = std::max(std::abs(a.mean_kW), std::abs(b.mean_kW));
  return std::abs(a.mean_kW - b.mean_kW) <= 1e-9 * larger;
}

}  // namespace

void OverlapMerge::merge(OneMeter& meter) {
  // Of one file the first value of an interval counts, as elsewhere.
  std::ranges::stable_sort(meter.of_file, {}, &Reading::start);
  const auto twice = std::ranges::unique(meter.of_file, {}, &Reading::start);
  meter.of_file.erase(twice.begin(), twice.end());

  std::vector<Reading> merged;
  merged.reserve(meter.held.size() + meter.of_file.size());
  auto earlier = meter.held.cbegin();
  for (const Reading& later : meter.of_file) {
    while (earlier != meter.held.cend() && earlier->start < later.start) {
      merged.push_back(*earlier++);
    }
    if (earlier == meter.held.cend() || later.start < earlier->start) {
      merged.push_back(later);
      continue;
    }
    ++repeated_;
    const bool is_blank = std::isnan(later.mean_kW);
    const bool was_blank = std::isnan(earlier->mean_kW);
    if (!is_blank && !was_blank && !is_same_value(later, *earlier)) ++corrected_;
    merged.push_back(is_blank ? *earlier : later);
    ++earlier;
  }
  merged.insert(merged.end(), earlier, meter.held.cend());
  meter.held = std::move(merged);
  meter.of_file.clear();
}

void OverlapMerge::hand_on(OneMeter& meter, Instant until) {
  const auto end = std::ranges::lower_bound(meter.held, until, {}, &Reading::start);
  if (sink_.on_reading) std::for_each(meter.held.begin(), end, sink_.on_reading);
  meter.held.erase(meter.held.begin(), end);
}

void OverlapMerge::end_file() {
  for (OneMeter& meter : meters_) {
    merge(meter);
    if (!meter.held.empty()) hand_on(meter, meter.held.back().start - kHeld);
  }
}

void OverlapMerge::finish() {
  for (OneMeter& meter : meters_) {
    merge(meter);
    hand_on(meter, Instant::max());
  }
}

}  // namespace recald::daemon
