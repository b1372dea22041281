#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/zoomable_chart.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"

namespace recald::daemon {
namespace {

using views::Html;
using views::Table;

/// The first forecast of each month: the one from before its figure was known.
std::map<std::string, std::vector<StoredForecast>> first_forecasts(
    const std::vector<StoredForecast>& all) {
  std::map<std::string, std::vector<StoredForecast>> by_output;
  for (const StoredForecast& one : all) {
    std::vector<StoredForecast>& months = by_output[one.output];
    if (months.empty() || months.back().month != one.month) months.push_back(one);
  }
  return by_output;
}

/// Of "main_daily_kWh" or "main_peak_kW".
display::Unit unit_of_output(const Served& served, const std::string& output) {
  const bool is_peak = output.ends_with("_kW");
  const std::size_t end = output.rfind(is_peak ? "_peak_kW" : "_daily_kWh");
  const auto meter = served.site.meter_index(output.substr(0, end));
  const metering::Utility utility =
      meter ? served.site.meters[*meter].meter.utility : metering::Utility::electricity;
  const display::MeterUnits units = display::meter_units(served.site.units, utility);
  return is_peak ? units.power : units.daily;
}

void write_chart_of(Html& html, const Served& served, const std::string& output,
                    const std::vector<StoredForecast>& months) {
  const display::Unit unit = unit_of_output(served, output);
  views::TimeChart chart{.title = display::output_words(output) + ", forecast and measured",
                         .unit = unit.name,
                         .span = {served.calendar.month_span(months.front().month).begin,
                                  served.calendar.month_span(months.back().month).end},
                         .points = {},
                         .marks = {}};
  for (const StoredForecast& one : months) {
    const metering::TimeSpan span = served.calendar.month_span(one.month);
    chart.points.push_back(
        {span.begin, unit.shown(one.q05), unit.shown(one.mean), unit.shown(one.q95), span.end});
    chart.marks.push_back({span, unit.shown(one.measured)});
  }
  views::write_zoomable_chart(html, chart,
                              {.line = "Forecast", .band = "90 % of it", .mark = "Measured"},
                              std::nullopt, served.calendar);
}

void write_table_of(Html& html, const Served& served, const std::string& output,
                    const std::vector<StoredForecast>& months) {
  const display::Unit unit = unit_of_output(served, output);
  Table table{"The same in numbers, the newest first"};
  table.with_labels().columns(
      {"Month", "Measured", "Forecast", "90 % interval", "Measured is in it", "Made"});
  for (auto one = months.rbegin(); one != months.rend(); ++one) {
    const bool is_inside = one->q05 <= one->measured && one->measured <= one->q95;
    table.row(
        {{views::month_text(one->month)},
         {views::amount_text(one->measured, unit), "number"},
         {views::amount_text(one->mean, unit), "number"},
         {views::number_text(unit.shown(one->q05)) + " to " + views::amount_text(one->q95, unit),
          "number"},
         {is_inside ? "✔ yes" : "▲ no", is_inside ? "good" : "warn"},
         {site_time_text(served.calendar, one->made)}});
  }
  table.write(html);
}

}  // namespace

http::Response months_page(const Served& served) {
  Html html;
  html.element("h1", "Months");
  const auto stored = served.store.forecasts();
  if (!stored) {
    html.element("p", "✖ The forecasts cannot be read: " + stored.error().message, "bad");
    return page_of(served, PageKind::months, "Months", html);
  }
  const auto by_output = first_forecasts(*stored);
  if (by_output.empty()) {
    html.element("p",
                 "There are no forecasts yet. They begin with the first calibration that has more "
                 "than a year of months. A meter's own months are on its page.",
                 "muted");
  } else {
    html.element(
        "p",
        "The band has 90 % of what was expected of a month before it was measured, the line "
        "is its mean, and the short thick lines are what was measured.",
        "muted");
  }
  for (const auto& [output, months] : by_output) {
    html.element("h2", display::capitalised(display::output_words(output)));
    write_chart_of(html, served, output, months);
    write_table_of(html, served, output, months);
  }
  return page_of(served, PageKind::months, "Months", html);
}

}  // namespace recald::daemon
