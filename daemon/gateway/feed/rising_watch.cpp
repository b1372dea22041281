#include "daemon/gateway/feed/rising_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace recald::daemon {
namespace {

using metering::Reading;
using metering::Validity;

constexpr double kBuildingMax_kW = 50'000.0;
constexpr double kEvenRise = 0.0005;  // of the value: what a total has grown by
constexpr std::size_t kEvenRises = 8;
constexpr std::size_t kRisesInRun = 20;
constexpr std::chrono::hours kRun{24};  // the sun and the people of a building set every day
constexpr std::size_t kRunKept = 3000;

constexpr std::chrono::hours kEvenRun{2};
constexpr double kLarge_kW = 1000.0;  // a few rises of so much by so little are worth a word
constexpr double kSmallRise = 0.005;
constexpr std::size_t kFewRises = 3;
constexpr std::string_view kOnlyRise = "its values only rise, as those of a register";
constexpr std::string_view kAdvice =
    "if they are readings of a register, write counter = { unit = \"kWh\" } and rated_kW, the most "
    "that its load can draw, to its [[meter]]; if they are amounts, write rated_kW";

void doubt_rise(Reading& reading) {
  reading.validity = Validity::suspect;
  reading.reasons |= metering::Reason::range;
}

}  // namespace

void RisingWatch::enter(const Reading& reading) {
  const bool goes_on = !run_.empty() && reading.start > run_.back().start &&
                       reading.mean_kW >= run_.back().mean_kW && run_.back().mean_kW > 0.0;
  if (!goes_on) {
    run_.clear();
    rises_ = 0;
    is_even_ = is_small_ = true;
  } else if (reading.mean_kW > run_.back().mean_kW) {
    ++rises_;
    const double rise = reading.mean_kW - run_.back().mean_kW;
    is_even_ = is_even_ && rise <= kEvenRise * run_.back().mean_kW;
    is_small_ = is_small_ && rise <= kSmallRise * run_.back().mean_kW;
  }
  run_.push_back(reading);
  // Older ones were stored as they are, or are suspect already.
  if (run_.size() > kRunKept) run_.erase(run_.begin());
}

bool RisingWatch::is_register() const {
  if (run_.empty()) return false;
  const auto span = run_.back().start - run_.front().start;
  const bool is_long = span >= kRun && rises_ >= kRisesInRun;
  return is_long || (is_even_ && rises_ >= kEvenRises && span >= kEvenRun);
}

bool RisingWatch::may_be_register() const {
  return !run_.empty() && is_small_ && rises_ >= kFewRises && run_.back().mean_kW >= kLarge_kW;
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
  if (largest != nullptr) {
    doubt.words = fmt::format(
        "{}, up to {:.1f} kWh in an interval ({:.0f} kW), so they are stored as suspect; {}",
        rises ? kOnlyRise : "its values are larger than any building's",
        largest->mean_kW * metering::in_hours(interval), largest->mean_kW, kAdvice);
  } else if (may_be_register()) {
    doubt.is_weak = true;
    doubt.words = fmt::format("{} would, up to {:.1f} kWh in an interval ({:.0f} kW); {}",
                              kOnlyRise, run_.back().mean_kW * metering::in_hours(interval),
                              run_.back().mean_kW, kAdvice);
  }
  return doubt;
}

}  // namespace recald::daemon
