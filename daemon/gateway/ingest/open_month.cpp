#include "daemon/gateway/ingest/open_month.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/absent.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::seconds kUntilBooked{60};

}  // namespace

OpenMonth::OpenMonth(metering::LocalCalendar calendar, std::chrono::seconds interval)
    : calendar_(std::move(calendar)), interval_(interval) {}

void OpenMonth::observe(const metering::Reading& reading) {
  if (reading.start < span_.begin) return;  // of an earlier month
  if (reading.start >= span_.end) {
    span_ = calendar_.month_span(calendar_.month_of(reading.start));
    is_measured_.assign(static_cast<std::size_t>(span_.length() / interval_ + 1), false);
  }
  // A measured value replaces a stored filled one, but not the other way round.
  if (reading.validity == metering::Validity::ok) {
    is_measured_[static_cast<std::size_t>((reading.start - span_.begin) / interval_)] = true;
  }
}

double OpenMonth::coverage(metering::Instant now) const {
  const metering::TimeSpan span = calendar_.month_span(calendar_.month_of(now));
  const auto ended = (now - kUntilBooked - span.begin) / interval_;
  if (ended <= 0) return kAbsent;
  if (span != span_) return 0.0;
  const auto end = is_measured_.begin() + std::min<std::ptrdiff_t>(ended, std::ssize(is_measured_));
  return static_cast<double>(std::count(is_measured_.begin(), end, true)) /
         static_cast<double>(ended);
}

}  // namespace recald::daemon
