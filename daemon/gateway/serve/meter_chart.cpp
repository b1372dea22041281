#include "daemon/gateway/serve/meter_chart.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/report/zoomable_chart.hpp"
#include "core/display/unit.hpp"
#include "daemon/gateway/serve/history.hpp"
#include "daemon/gateway/serve/page_frame.hpp"

namespace recald::daemon {
namespace {

constexpr int kChartPoints = 400;  // A chart is some 700 pixels wide.

std::string step_words(std::chrono::seconds step) {
  const auto s = step.count();
  if (s % 86'400 == 0) return s == 86'400 ? "a day" : fmt::format("{} days", s / 86'400);
  if (s % 3'600 == 0) return s == 3'600 ? "an hour" : fmt::format("{} hours", s / 3'600);
  return fmt::format("{} minutes", s / 60);
}

}  // namespace

void write_meter_chart(report::Html& html, const Served& served, const metering::Meter& meter,
                       const weather::SensorQuantity* quantity, const metering::TimeSpan& span,
                       ChartKind kind) {
  const auto number = served.store.find_meter(meter.id);
  if (!number) {
    html.element("p", "✖ The readings cannot be read: " + number.error().message, "bad");
    return;
  }
  const auto history =
      *number ? read_history(served.store, **number, meter.interval, span, kChartPoints)
              : Result<History>{History{meter.interval, {}}};
  if (!history) {
    html.element("p", "✖ The readings cannot be read: " + history.error().message, "bad");
    return;
  }
  const bool is_empty = std::ranges::all_of(
      history->points, [](const HistoryPoint& point) { return point.valid_share == 0.0; });
  if (is_empty) {
    html.element("p", "No valid readings in this time.", "muted");
    return;
  }
  const display::Unit unit = quantity != nullptr
                                 ? display::unit_of(served.site.units, quantity->unit)
                                 : display::unit_of(served.site.units, "kW", meter.utility);
  report::TimeChart chart{
      .title = fmt::format("{}, mean of {}", meter.id, step_words(history->step)),
      .unit = unit.name,
      .span = span,
      .points = {}};
  for (const HistoryPoint& point : history->points) {
    chart.points.push_back({point.start, unit.shown(point.least_kW), unit.shown(point.mean_kW),
                            unit.shown(point.most_kW), point.start + history->step});
  }
  if (kind == ChartKind::zoomable) {
    const report::FinerValues finer{.address = "/api/v1/history?meter=" + meter.id,
                                    .interval = meter.interval,
                                    .points = kChartPoints,
                                    .factor = unit.factor,
                                    .offset = unit.offset};
    report::write_zoomable_chart(html, chart,
                                 {.line = "Mean", .band = "Lowest and highest interval"}, finer,
                                 served.calendar);
  } else {
    report::write_chart(html, chart, served.calendar);
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
