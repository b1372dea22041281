#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using views::Html;
using views::Table;

constexpr int kPageEvents = 200;
constexpr std::array kSeverities{"info", "warning", "error"};

bool contains_ignoring_case(std::string_view text, std::string_view part) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return part.empty() || !std::ranges::search(text, part, {}, lower, lower).empty();
}

/// What is asked of the log; empty: anything.
struct Filter {
  std::string severity;
  std::string subject;
  std::string text;

  [[nodiscard]] bool takes(const StoreEvent& event) const {
    return (severity.empty() || severity == name_of(event.severity)) &&
           (subject.empty() || subject == event.subject) &&
           contains_ignoring_case(event.text, text);
  }
};

void write_filter(Html& html, const Served& served, const Filter& filter) {
  const auto option = [&](std::string_view value, std::string_view shown, std::string_view chosen) {
    html.markup("<option value=\"")
        .text(value)
        .markup(value == chosen ? "\" selected>" : "\">")
        .text(shown)
        .markup("</option>");
  };
  html.markup("<form method=\"get\" class=\"filter\"><label>Severity <select name=\"severity\">");
  option("", "any", filter.severity);
  for (const char* severity : kSeverities) option(severity, severity, filter.severity);
  html.markup("</select></label> <label>About <select name=\"subject\">");
  option("", "anything", filter.subject);
  for (const auto* const list : {&served.site.meters, &served.site.sensors}) {
    for (const MeterConfig& config : *list) {
      option(config.meter.id, config.meter.id, filter.subject);
    }
  }
  html.markup("</select></label> <label>Text <input name=\"text\" value=\"")
      .text(filter.text)
      .markup("\"></label> <button>Show</button></form>");
}

}  // namespace

http::Response events_page(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {"severity", "subject", "text"}); !checked) {
    return checked.error();
  }
  const Filter filter{text_of(request, "severity").value_or(""),
                      text_of(request, "subject").value_or(""),
                      text_of(request, "text").value_or("")};
  Html html;
  html.element("h1", "Events");
  write_filter(html, served, filter);
  Table table{"The newest first"};
  table.with_labels().columns({"When", "Severity", "About", "What", "Times"});
  int shown = 0;
  int found = 0;
  int seen = 0;
  const auto read = served.store.for_each_event(Instant::max(), [&](const StoreEvent& event) {
    ++seen;
    if (!filter.takes(event) || ++found > kPageEvents) return seen < kLimitMax;
    ++shown;
    table.row({{site_time_text(served.calendar, event.last.value_or(event.time))},
               severity_cell(event.severity),
               {event.subject.empty() ? "the site" : event.subject},
               {event.text},
               {std::to_string(event.count), "number"}});
    return seen < kLimitMax;
  });
  if (!read) {
    html.element("p", "✖ The events cannot be read: " + read.error().message, "bad");
    return page_of(served, PageKind::events, "Events", html);
  }
  if (shown == 0) {
    html.element("p", seen == 0 ? "No events yet." : "No event is like that.", "muted");
  } else {
    table.write(html);
  }
  if (found > shown) {
    html.element(
        "p",
        fmt::format("{} older ones are not shown; choose, or ask /api/v1/events.", found - shown),
        "muted");
  }
  return page_of(served, PageKind::events, "Events", html);
}

}  // namespace recald::daemon
