#include "daemon/gateway/ingest/rising_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace recald::daemon {
namespace {

using metering::Reading;
using metering::Validity;

constexpr double kBuildingMax_kW = 50'000.0;
constexpr double kEvenRise = 0.005;
constexpr std::size_t kEvenRises = 3;
constexpr std::size_t kRisesInRun = 20;

void doubt_rise(Reading& reading) {
  reading.validity = Validity::suspect;
  reading.reasons |= metering::Reason::range;
}

}  // namespace

void RisingWatch::enter(const Reading& reading) {
  const bool goes_on = !run_.empty() && reading.start > run_.back().start &&
                       reading.mean_kW > run_.back().mean_kW && run_.back().mean_kW > 0.0;
  if (!goes_on) {
    run_.clear();
    is_even_ = true;
  } else if (reading.mean_kW - run_.back().mean_kW > kEvenRise * run_.back().mean_kW) {
    is_even_ = false;
  }
  run_.push_back(reading);
  // Older ones were stored as they are, or are suspect already.
  if (run_.size() > 2 * kRisesInRun) run_.erase(run_.begin());
}

bool RisingWatch::is_register() const {
  return run_.size() > kRisesInRun || (is_even_ && run_.size() > kEvenRises);
}

RisingWatch::Doubt RisingWatch::look(std::vector<Reading>& readings,
                                     std::chrono::seconds interval) {
  const std::vector<Reading> known = run_;
  std::ranges::stable_sort(readings, {}, &Reading::start);
  for (const Reading& reading : readings) {
    if (reading.validity == Validity::ok) enter(reading);
  }
  const bool rises = is_register();
  Doubt doubt;
  const Reading* largest = nullptr;
  for (Reading& reading : readings) {
    if (reading.validity != Validity::ok) continue;
    const bool is_of_run = rises && reading.start >= run_.front().start;
    if (!is_of_run && std::abs(reading.mean_kW) <= kBuildingMax_kW) continue;
    doubt_rise(reading);
    if (largest == nullptr || reading.mean_kW > largest->mean_kW) largest = &reading;
  }
  if (rises) {
    for (Reading before : known) {
      if (before.start < run_.front().start) continue;
      doubt_rise(before);
      doubt.before.push_back(before);
    }
  }
  if (largest == nullptr) return doubt;
  const double amount_kWh = largest->mean_kW * metering::in_hours(interval);
  doubt.words = fmt::format(
      "{}, up to {:.1f} kWh in an interval ({:.0f} kW), so they are stored as suspect; if they are "
      "readings of a register, write counter = {{ unit = \"kWh\" }} and rated_kW, the most that "
      "its "
      "load can draw, to its [[meter]]; if they are amounts, write rated_kW",
      rises ? "its values only rise, as those of a register"
            : "its values are larger than any "
              "building's",
      amount_kWh, largest->mean_kW);
  return doubt;
}

}  // namespace recald::daemon
