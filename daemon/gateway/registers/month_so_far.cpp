#include "daemon/gateway/registers/month_so_far.hpp"

#include <cmath>
#include <utility>

namespace recald::daemon {

using metering::Validity;

MonthSoFar::MonthSoFar(metering::Meter meter, metering::LocalCalendar calendar,
                       metering::Month month)
    : meter_(std::move(meter)),
      calendar_(std::move(calendar)),
      month_(month),
      span_(calendar_.month_span(month)),
      next_(span_.begin),
      block_length_(meter_.peak.window % meter_.interval == std::chrono::seconds{0}
                        ? static_cast<int>(meter_.peak.window / meter_.interval)
                        : 1) {}

void MonthSoFar::take(const metering::Reading& reading) {
  if (reading.start < next_ || reading.start >= span_.end) return;
  if (reading.start > next_) in_block_ = 0;
  next_ = reading.start + meter_.interval;
  const bool counts_in_energy = reading.validity == Validity::ok ||
                                reading.validity == Validity::filled ||
                                reading.validity == Validity::scaled;
  if (counts_in_energy && std::isfinite(reading.mean_kW)) {
    sum_kW_ += reading.mean_kW;
    ++known_;
  }
  take_block(reading);
}

void MonthSoFar::take_block(const metering::Reading& reading) {
  if (reading.validity != Validity::ok) {
    in_block_ = 0;
    return;
  }
  if (in_block_ == 0) {
    const std::chrono::minutes time{calendar_.local_time(reading.start).minute_of_day};
    const auto window = block_length_ * meter_.interval;
    if (block_length_ > 1 && time % window != std::chrono::seconds{0}) return;
    block_sum_kW_ = 0.0;
  }
  block_sum_kW_ += reading.mean_kW;
  if (++in_block_ < block_length_) return;
  peak_kW_ = std::fmax(peak_kW_, block_sum_kW_ / block_length_);
  in_block_ = 0;
}

double MonthSoFar::daily_average_kWh() const {
  constexpr double kHoursPerDay = 24.0;
  return known_ == 0 ? kAbsent : kHoursPerDay * sum_kW_ / known_;
}

}  // namespace recald::daemon
