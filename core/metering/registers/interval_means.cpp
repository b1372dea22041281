#include "core/metering/registers/interval_means.hpp"

#include <algorithm>
#include <cmath>

#include "core/absent.hpp"

namespace recald::metering {
namespace {

constexpr double kMeansCoverageMin = 0.8;

}  // namespace

void IntervalMeans::take(const TimeSpan& span, const Reading& value, const Sink& sink) {
  Instant begin = std::max(span.begin, until_);
  while (begin < span.end) {
    const Instant start = interval_start(begin - phase_, interval_) + phase_;
    const Instant end = std::min(span.end, start + interval_);
    if (open_ != start) {
      finish(sink);
      open_ = start;
    }
    add({begin, end}, value);
    begin = end;
  }
  until_ = std::max(until_, span.end);
}

void IntervalMeans::add(const TimeSpan& part, const Reading& value) {
  reasons_ |= value.reasons;
  const bool counts = std::isfinite(value.mean_kW) &&
                      (value.validity == Validity::ok || value.validity == Validity::scaled);
  if (!counts) return;
  covered_ += part.length();
  energy_kWh_ += value.mean_kW * in_hours(part.length());
  if (value.validity == Validity::scaled) validity_ = Validity::scaled;
}

void IntervalMeans::finish(const Sink& sink) {
  if (!open_) return;
  Reading reading{meter_, *open_, kAbsent, Validity::missing, reasons_};
  if (in_hours(covered_) >= kMeansCoverageMin * in_hours(interval_)) {
    reading.mean_kW = energy_kWh_ / in_hours(covered_);
    reading.validity = validity_;
  } else {
    reading.reasons |= Reason::partial;
  }
  sink(reading);
  open_.reset();
  covered_ = std::chrono::seconds{0};
  energy_kWh_ = 0.0;
  validity_ = Validity::ok;
  reasons_ = Reason::none;
}

}  // namespace recald::metering
