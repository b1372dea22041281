#include "adapters/views/frame/zoomable_chart.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "adapters/views/frame/script_json.hpp"

namespace recald::views {
namespace {

using metering::Instant;
using nlohmann::json;
using std::chrono::seconds;

json seconds_since_1970(Instant t) { return t.time_since_epoch().count(); }

/// The first instant after `begin` with the offset of `end`. @pre their offsets differ
Instant change_between(Instant begin, Instant end, const metering::LocalCalendar& calendar) {
  const seconds before = calendar.utc_offset(begin);
  while (end - begin > seconds{1}) {
    const Instant middle = begin + (end - begin) / 2;
    (calendar.utc_offset(middle) == before ? begin : end) = middle;
  }
  return end;
}

/// [since, local minus UTC] of each stretch. No zone changes its clocks twice within a day.
json offsets_json(const metering::TimeSpan& span, const metering::LocalCalendar& calendar) {
  json offsets = json::array();
  const auto add = [&](Instant since) {
    offsets.push_back({seconds_since_1970(since), calendar.utc_offset(since).count()});
  };
  const Instant last = span.end - seconds{1};  // The calendar may end where the chart does.
  add(span.begin);
  for (Instant at = span.begin; at < last;) {
    const Instant next = std::min(at + std::chrono::days{1}, last);
    if (calendar.utc_offset(at) != calendar.utc_offset(next)) {
      add(change_between(at, next, calendar));
    }
    at = next;
  }
  return offsets;
}

json finer_json(const FinerValues& finer) {
  return {{"address", finer.address},
          {"interval_s", finer.interval.count()},
          {"points", finer.points},
          {"factor", finer.factor},
          {"offset", finer.offset}};
}

json chart_json(const TimeChart& chart, const ChartWords& words,
                const std::optional<FinerValues>& finer, const metering::LocalCalendar& calendar) {
  json points = json::array();
  for (const ChartPoint& point : chart.points) {
    points.push_back({seconds_since_1970(point.start), seconds_since_1970(point.end),
                      json_number(point.low), json_number(point.mean), json_number(point.high)});
  }
  json marks = json::array();
  for (const ChartMark& mark : chart.marks) {
    if (const json value = json_number(mark.value); !value.is_null()) {
      marks.push_back(
          {seconds_since_1970(mark.span.begin), seconds_since_1970(mark.span.end), value});
    }
  }
  return {{"title", chart.title},
          {"unit", chart.unit},
          {"span", {seconds_since_1970(chart.span.begin), seconds_since_1970(chart.span.end)}},
          {"offsets", offsets_json(chart.span, calendar)},
          {"words", {{"line", words.line}, {"band", words.band}, {"mark", words.mark}}},
          {"finer", finer ? finer_json(*finer) : json{}},
          {"points", points},
          {"marks", marks}};
}

}  // namespace

void write_zoomable_chart(Html& html, const TimeChart& chart, const ChartWords& words,
                          const std::optional<FinerValues>& finer,
                          const metering::LocalCalendar& calendar) {
  html.markup(kZoomableMarkup);
  write_chart(html, chart, calendar);
  html.markup("<script type=\"application/json\">")
      .markup(script_safe_text(chart_json(chart, words, finer, calendar)))
      .markup("</script></div>");
}

}  // namespace recald::views
