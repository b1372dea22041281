#include "daemon/gateway/serve/pages/meter_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "adapters/views/frame/zoomable_chart.hpp"
#include "core/display/unit.hpp"
#include "daemon/gateway/serve/api/history.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"

namespace recald::daemon {
namespace {

constexpr int kChartPoints = 400;  // A chart is some 700 pixels wide.

std::string step_words(std::chrono::seconds step) {
  const auto s = step.count();
  if (s % 86'400 == 0) return s == 86'400 ? "a day" : fmt::format("{} days", s / 86'400);
  if (s % 3'600 == 0) return s == 3'600 ? "an hour" : fmt::format("{} hours", s / 3'600);
  return fmt::format("{} minutes", s / 60);
}

/// Nothing if there is nothing to draw, which is then said.
std::optional<History> history_of(views::Html& html, const Served& served,
                                  const metering::Meter& meter, const metering::TimeSpan& span) {
  const auto number = served.store.find_meter(meter.id);
  if (!number) {
    html.element("p", "✖ The readings cannot be read: " + number.error().message, "bad");
    return std::nullopt;
  }
  auto history = *number ? read_history(served.store, **number, meter.interval, span, kChartPoints)
                         : Result<History>{History{meter.interval, {}}};
  if (!history) {
    html.element("p", "✖ The readings cannot be read: " + history.error().message, "bad");
    return std::nullopt;
  }
  const bool is_empty = std::ranges::all_of(
      history->points, [](const HistoryPoint& point) { return point.valid_share == 0.0; });
  if (is_empty) {
    html.element("p", "No valid readings in this time.", "muted");
    return std::nullopt;
  }
  return std::move(*history);
}

views::TimeChart chart_of(const metering::Meter& meter, const History& history,
                          const metering::TimeSpan& span, const display::Unit& unit) {
  views::TimeChart chart{.title = fmt::format("{}, mean of {}", meter.id, step_words(history.step)),
                         .unit = unit.name,
                         .span = span,
                         .points = {}};
  for (const HistoryPoint& point : history.points) {
    chart.points.push_back({point.start, unit.shown(point.least_kW), unit.shown(point.mean_kW),
                            unit.shown(point.most_kW), point.start + history.step});
  }
  return chart;
}

/// How many of the last hours with a band the measured mean was outside it.
struct Outside {
  int hours = 0;
  int of = 0;
};

/// Puts the model's band in the place of the lowest and highest interval.
Outside put_band(views::TimeChart& chart, const ExpectedMeter& expected,
                 const display::Unit& unit) {
  const metering::Instant last = std::chrono::floor<std::chrono::hours>(chart.span.end);
  const metering::TimeSpan recent{last - std::chrono::hours{24}, last};  // whole hours
  Outside outside;
  for (views::ChartPoint& point : chart.points) {
    const auto hour =
        std::ranges::lower_bound(expected.hours, point.start, {}, &ExpectedHour::start);
    point.low = point.high = point.mean;
    if (hour == expected.hours.end() || hour->start != point.start) continue;
    point.low = unit.shown(hour->load.q05_kW);
    point.high = unit.shown(hour->load.q95_kW);
    const bool counts =
        std::isfinite(point.mean) && recent.begin <= point.start && point.start < recent.end;
    if (!counts) continue;
    ++outside.of;
    if (point.mean < point.low || point.mean > point.high) ++outside.hours;
  }
  return outside;
}

}  // namespace

void write_expected_chart(views::Html& html, const Served& served, const metering::Meter& meter,
                          const ExpectedMeter& expected, const metering::TimeSpan& span) {
  metering::Meter by_hours = meter;  // as the model has them
  by_hours.interval = std::max<std::chrono::seconds>(meter.interval, std::chrono::hours{1});
  const auto history = history_of(html, served, by_hours, span);
  if (!history) return;
  const display::Unit unit = display::unit_of(served.site.units, "kW", meter.utility);
  views::TimeChart chart = chart_of(meter, *history, span, unit);
  const Outside outside = put_band(chart, expected, unit);
  chart.title += "; the band is what the model of the drawings expects";
  views::write_chart(html, chart, served.calendar);
  constexpr int kFewestHours = 12;
  if (outside.of < kFewestHours) return;
  constexpr int kUsually = 10;  // one hour in ten is outside a 90 % band
  const bool is_much = outside.hours * kUsually > 3 * outside.of;
  html.element(
      "p",
      fmt::format("{}{} of the last {} hours were outside the band of what the model of the "
                  "drawings expects; one in ten is usual.",
                  is_much ? "▲ " : "", outside.hours, outside.of),
      is_much ? "warn" : "muted");
}

void write_meter_chart(views::Html& html, const Served& served, const metering::Meter& meter,
                       const weather::SensorQuantity* quantity, const metering::TimeSpan& span,
                       ChartKind kind) {
  const auto history = history_of(html, served, meter, span);
  if (!history) return;
  const display::Unit unit = quantity != nullptr
                                 ? display::unit_of(served.site.units, quantity->unit)
                                 : display::unit_of(served.site.units, "kW", meter.utility);
  const views::TimeChart chart = chart_of(meter, *history, span, unit);
  if (kind == ChartKind::zoomable) {
    const views::FinerValues finer{.address = "/api/v1/history?meter=" + meter.id,
                                   .interval = meter.interval,
                                   .points = kChartPoints,
                                   .factor = unit.factor,
                                   .offset = unit.offset};
    views::write_zoomable_chart(html, chart,
                                {.line = "Mean", .band = "Lowest and highest interval"}, finer,
                                served.calendar);
  } else {
    views::write_chart(html, chart, served.calendar);
  }
  if (history->step > meter.interval) {
    html.element("p",
                 fmt::format("The line is the mean of {}; the band reaches from the lowest to the "
                             "highest interval in it.",
                             step_words(history->step)),
                 "muted");
  }
}

}  // namespace recald::daemon
