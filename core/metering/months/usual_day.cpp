#include "core/metering/months/usual_day.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace recald::metering {
namespace {

using std::chrono::seconds;

constexpr int kDaysRemembered = 20;

}  // namespace

UsualDay::UsualDay(LocalCalendar calendar, seconds interval)
    : calendar_(std::move(calendar)), interval_(interval) {
  assert(interval > seconds{0} && kDay % interval == seconds{0});
  times_.resize(static_cast<std::size_t>(kDay / interval));
}

std::size_t UsualDay::index_of(Instant start) const {
  const std::chrono::minutes minute{calendar_.local_time(start).minute_of_day};
  return static_cast<std::size_t>(minute / interval_);
}

void UsualDay::observe(const Reading& reading) {
  if (reading.validity != Validity::ok || !std::isfinite(reading.mean_kW)) return;
  TimeOfDay& time = times_[index_of(reading.start)];
  time.days = std::min(time.days + 1, kDaysRemembered);
  time.mean_kW += (reading.mean_kW - time.mean_kW) / time.days;
}

double UsualDay::expected_kW(Instant start) const {
  const TimeOfDay& time = times_[index_of(start)];
  if (time.days > 0) return std::max(0.0, time.mean_kW);
  double sum_kW = 0.0;
  int known = 0;
  for (const TimeOfDay& other : times_) {
    if (other.days == 0) continue;
    sum_kW += std::max(0.0, other.mean_kW);
    ++known;
  }
  return known > 0 ? sum_kW / known : 0.0;
}

LoadShape UsualDay::shape() const {
  return [this](Instant start) { return expected_kW(start); };
}

}  // namespace recald::metering
