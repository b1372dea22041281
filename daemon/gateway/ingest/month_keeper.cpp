#include "daemon/gateway/ingest/month_keeper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "core/metering/closing_rules.hpp"

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
  const auto read = store.for_each_interval(meter.number, span, [&](const StoredInterval& stored) {
    metering::Reading reading = stored.reading;
    reading.meter = 0;
    closer.add(reading);
  });
  if (!read) return tl::unexpected(read.error());
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
  const auto reopened = store_.put_closing_rules(
      meter.number, metering::closing_rules(options_.closing, meter.meter));
  if (!reopened) return tl::unexpected(reopened.error());
  if (*reopened == 0) return {};
  const auto told =
      store_.commit({.events = {{now, Severity::info, "rules_changed", meter.meter.id,
                                 fmt::format("the rules for closing months have changed: {} closed "
                                             "month{} of {} {} closed again",
                                             *reopened, *reopened == 1 ? "" : "s", meter.meter.id,
                                             *reopened == 1 ? "is" : "are")}}});
  if (!told) return tl::unexpected(told.error());
  return {};
}

Result<std::vector<Month>> MonthKeeper::due(const StoredMeter& meter,
                                            std::span<const MeterMonth> reopened,
                                            Instant now) const {
  std::vector<Month> months;
  const auto extent = store_.interval_extent(meter.number);
  if (!extent) return tl::unexpected(extent.error());
  if (!*extent) return months;
  const auto closed = store_.months(meter.number);
  if (!closed) return tl::unexpected(closed.error());
  for (Month month = calendar_.month_of((*extent)->begin);
       calendar_.month_span(month).end + options_.watermark <= now;
       month = metering::next_month(month)) {
    const bool is_closed = std::ranges::any_of(
        *closed, [&](const StoredMonth& one) { return one.figure.month == month; });
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
    if (auto taken = take_rules(meter, now); !taken) return tl::unexpected(taken.error());
  }
  const auto reopened = store_.reopened();
  if (!reopened) return tl::unexpected(reopened.error());
  std::vector<ClosedFigure> figures;
  for (const StoredMeter& meter : meters) {
    const auto months = due(meter, *reopened, now);
    if (!months) return tl::unexpected(months.error());
    for (const Month month : *months) {
      if (figures.size() == at_most) return figures;
      auto made = stored_figure(store_, calendar_, options_, meter, month);
      if (!made) return tl::unexpected(made.error());
      const auto revision = store_.put_month(meter.number, *made, time_zone_release_, now);
      if (!revision) return tl::unexpected(revision.error());
      made->revision = *revision;
      figures.push_back({meter.number, std::move(*made)});
      if (on_closed) on_closed(figures.back());
    }
  }
  return figures;
}

}  // namespace recald::daemon
