#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/views/frame/format.hpp"
#include "core/display/unit.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/pages/meter_chart.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {
namespace {

using std::chrono::days;
using std::chrono::sys_days;
using views::Html;
using views::Table;

constexpr days kShownAtFirst{7};

struct Choice {
  const char* text;
  days length;
};
constexpr std::array kChoices{Choice{"1 day", days{1}}, Choice{"7 days", days{7}},
                              Choice{"30 days", days{30}}, Choice{"1 year", days{365}},
                              Choice{"10 years", days{3652}}};

/// Now, or the nearest time that the calendar has: a device without a clock starts in 1970, which
/// at the site may still be 1969.
metering::Instant calendar_now(const Served& served) {
  constexpr metering::Instant kEarliest = sys_days{std::chrono::year{1971} / 1 / 2};
  return std::clamp(served.now(), kEarliest, metering::kLatestInstant - days{2});
}

metering::Day day_of(const Served& served, metering::Instant t) {
  return served.calendar.local_time(t).date;
}

/// The first day of which nothing is shown.
metering::Day day_after(const Served& served, metering::Instant end) {
  const metering::Day day = day_of(served, end);
  return served.calendar.day_span(day).begin < end ? metering::Day{sys_days{day} + days{1}} : day;
}

/// Links to usual spans, and two dates to choose any other.
void write_choice(Html& html, const Served& served, const metering::TimeSpan& shown) {
  html.markup(
          "<form method=\"get\" class=\"filter\"><label>From <input type=\"date\" name=\"from\" "
          "value=\"")
      .text(metering::to_string(day_of(served, shown.begin)))
      .markup("\"></label> <label>to, not included <input type=\"date\" name=\"to\" value=\"")
      .text(metering::to_string(day_after(served, shown.end)))
      .markup("\"></label> <button>Show</button> <span>");
  const metering::Day today = day_of(served, calendar_now(served));
  const metering::Day tomorrow{sys_days{today} + days{1}};
  for (const Choice& choice : kChoices) {
    const metering::Day from{sys_days{tomorrow} - choice.length};
    html.link(
            fmt::format("?from={}&to={}", metering::to_string(from), metering::to_string(tomorrow)),
            choice.text)
        .markup(" ");
  }
  html.markup("</span></form>");
}

void write_csv_link(Html& html, const std::string& meter, std::chrono::seconds interval,
                    const metering::TimeSpan& span) {
  html.markup("<p>").link(
      fmt::format("/api/v1/intervals?meter={}&from={}&to={}&limit={}&format=csv", meter,
                  metering::to_string(span.begin), metering::to_string(span.end), kLimitMax),
      (span.end - span.begin) / interval > kLimitMax ? "The first 10,000 of these intervals as CSV"
                                                     : "These intervals as CSV");
  html.markup("</p>");
}

void write_months_of(Html& html, const Served& served, const MeterConfig& config) {
  const auto number = served.store.find_meter(config.meter.id);
  if (!number || !*number) return;
  const auto months = served.store.months(**number);
  if (!months || months->empty()) return;
  const display::MeterUnits units = display::meter_units(served.site.units, config.meter.utility);
  Table table{"Months, the newest first"};
  table.with_labels().columns(
      {"Month", "Daily average", "Peak", "When", "Measured", "Filled", "Used"});
  for (auto one = months->rbegin(); one != months->rend(); ++one) {
    const metering::MonthlyFigure& figure = one->figure;
    table.row({{views::month_text(figure.month)},
               {views::amount_text(figure.daily_average_kWh, units.daily), "number"},
               {figure.peak ? views::amount_text(figure.peak->kW, units.power) : "–", "number"},
               {figure.peak ? site_time_text(served.calendar, figure.peak->start) : "–"},
               {views::percent_text(figure.coverage), "number"},
               {views::percent_text(figure.filled_share), "number"},
               {figure.usable ? "✔ yes" : "▲ no: " + figure.unusable_because,
                figure.usable ? "good" : "warn"}});
  }
  table.write(html);
}

/// A refusal of the API as a page for a person.
http::Response refused_page(const Served& served, const http::Response& refused) {
  const auto json = nlohmann::json::parse(refused.body, nullptr, false);
  Html html;
  html.element("h1", "This cannot be shown");
  html.element("p", "✖ " + json.at("error").at("message").get<std::string>(), "bad");
  http::Response page = page_of(served, PageKind::other, "This cannot be shown", html);
  page.status = refused.status;
  return page;
}

/// What the request asks for, or the last week from its first midnight on. A date field that was
/// emptied asks for nothing.
Checked<metering::TimeSpan> shown_span(const Served& served, http::Request request) {
  std::erase_if(request.query, [](const auto& one) { return one.second.empty(); });
  auto span = span_of(request, served.calendar);
  if (!span) return span;
  const metering::Instant now = calendar_now(served);
  if (!text_of(request, "to")) span->end = std::max(now, span->begin);
  if (!text_of(request, "from")) {
    const metering::Instant begin = std::min(now, span->end) - kShownAtFirst;
    span->begin = served.calendar.day_span(day_of(served, begin)).begin;  // so that hours are whole
  }
  return span;
}

}  // namespace

http::Response meter_page(const Served& served, const http::Request& request,
                          const std::string& id) {
  const auto config = meter_of(served.site, id);
  if (!config) return refused_page(served, config.error());
  if (const auto checked = has_only(request, {"from", "to"}); !checked) return checked.error();
  const auto span = shown_span(served, request);
  if (!span) return refused_page(served, span.error());

  Html html;
  html.element("h1", id);
  if (!(*config)->is_stored()) {
    html.element(
        "p",
        "Its readings are in files, or are a sum of other meters, so the daemon has none of "
        "its own; recald report shows them.",
        "muted");
    return page_of(served, PageKind::other, id, html);
  }
  write_choice(html, served, *span);
  if ((*config)->role == MeterRole::weather) {
    for (const WeatherChannel& channel : channels_of(**config)) {
      html.element("h2", std::string{channel.quantity->name});
      write_meter_chart(html, served, stored_meter(**config, channel), channel.quantity, *span,
                        ChartKind::zoomable);
      write_csv_link(html, channel.id(), (*config)->meter.interval, *span);
    }
  } else {
    write_meter_chart(html, served, (*config)->meter, nullptr, *span, ChartKind::zoomable);
    write_csv_link(html, id, (*config)->meter.interval, *span);
    write_months_of(html, served, **config);
  }
  return page_of(served, PageKind::other, id, html);
}

}  // namespace recald::daemon
