#include "daemon/gateway/ingest/month_keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "core/metering/months/closing_rules.hpp"

namespace recald::daemon {

using metering::Instant;
using metering::Month;
using metering::MonthlyFigure;

Result<MonthlyFigure> stored_figure(Store& store, const metering::LocalCalendar& calendar,
                                    const metering::CloserOptions& closing,
                                    const StoredMeter& meter, Month month, Instant known_until) {
  std::optional<MonthlyFigure> made;
  metering::CloserOptions options = closing;
  options.period = metering::MonthRange{month, month};
  metering::MonthCloser closer{
      calendar, {meter.meter}, options, [&](metering::ClosedMonth&& closed) {
        if (closed.figure.month == month) made = closed.figure;
      }};
  metering::TimeSpan span = metering::span_judged_by({month, month}, calendar);
  span.end = std::min(span.end, known_until);
  TRY(store.for_each_interval(meter.number, span, [&](const StoredInterval& stored) {
    metering::Reading reading = stored.reading;
    reading.meter = 0;
    closer.add(reading);
  }));
  closer.finish();
  assert(made && "a closer hands out its whole period");
  return *made;
}

std::vector<Month> months_that_depend_on(Instant start, const metering::LocalCalendar& calendar) {
  const Month month = calendar.month_of(start);
  std::vector<Month> months;
  const Month before = metering::previous_month(month);
  if (start < calendar.month_span(before).end + metering::kJudgedAfterwards)
    months.push_back(before);
  months.push_back(month);
  months.push_back(metering::next_month(month));
  return months;
}

MonthKeeper::MonthKeeper(Store& store, metering::LocalCalendar calendar,
                         metering::CloserOptions options, std::string time_zone_release)
    : store_(store),
      calendar_(std::move(calendar)),
      options_(std::move(options)),
      time_zone_release_(std::move(time_zone_release)) {}

Result<void> MonthKeeper::take_rules(const StoredMeter& meter, Instant now) {
  const auto reopened = TRY(store_.put_closing_rules(
      meter.number, metering::closing_rules(options_.closing, meter.meter)));
  if (reopened == 0) return {};
  TRY(store_.commit({.events = {{now, Severity::info, "rules_changed", meter.meter.id,
                                 fmt::format("the rules for closing months have changed: {} closed "
                                             "month{} of {} {} closed again",
                                             reopened, reopened == 1 ? "" : "s", meter.meter.id,
                                             reopened == 1 ? "is" : "are")}}}));
  return {};
}

Result<std::vector<Month>> MonthKeeper::due(const StoredMeter& meter,
                                            std::span<const MeterMonth> reopened,
                                            Instant now) const {
  std::vector<Month> months;
  const auto extent = TRY(store_.interval_extent(meter.number));
  if (!extent) return months;
  const auto closed = TRY(store_.months(meter.number));
  for (Month month = calendar_.month_of(extent->begin);
       calendar_.month_span(month).end + options_.watermark <= now;
       month = metering::next_month(month)) {
    const bool is_closed = std::ranges::any_of(
        closed, [&](const StoredMonth& one) { return one.figure.month == month; });
    const bool is_reopened =
        std::ranges::find(reopened, MeterMonth{meter.number, month}) != reopened.end();
    if (!is_closed || is_reopened) months.push_back(month);
  }
  return months;
}

Result<std::vector<ClosedFigure>> MonthKeeper::close_due(
    std::span<const StoredMeter> meters, Instant now,
    const std::function<void(const ClosedFigure&)>& on_closed, std::size_t at_most) {
  for (const StoredMeter& meter : meters) {
    TRY(take_rules(meter, now));
  }
  const auto reopened = TRY(store_.reopened());
  std::vector<ClosedFigure> figures;
  for (const StoredMeter& meter : meters) {
    const auto months = TRY(due(meter, reopened, now));
    for (const Month month : months) {
      if (figures.size() == at_most) return figures;
      auto made = TRY(stored_figure(store_, calendar_, options_, meter, month));
      made.revision = TRY(store_.put_month(meter.number, made, time_zone_release_, now));
      figures.push_back({meter.number, std::move(made)});
      if (on_closed) on_closed(figures.back());
    }
  }
  return figures;
}

}  // namespace recald::daemon
