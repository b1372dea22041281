#include "daemon/gateway/serve/status_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "adapters/report/format.hpp"
#include "adapters/report/html.hpp"
#include "core/absent.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/text/number_text.hpp"
#include "daemon/gateway/serve/readiness.hpp"
#include "daemon/gateway/serve/shapes.hpp"
#include "daemon/gateway/serve/status_style.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using report::Cell;
using report::Html;
using report::Table;

constexpr int kEventsShown = 20;
constexpr int kJobsShown = 5;
constexpr double kCoverageGood = 0.9;
constexpr int kWeatherDigits = 3;

/// A sign beside each word, so that the meaning never depends on colour alone.
Cell state_cell(const MeterStatus* status) {
  if (status == nullptr) return {"recorded", "muted"};
  if (!status->poll) return {"pushed", "muted"};
  switch (status->poll->state) {
    case UnitState::up:
      return {"✔ up", "good"};
    case UnitState::degraded:
      return {"▲ degraded", "warn"};
    case UnitState::down:
      break;
  }
  return {"✖ down", "bad"};
}

/// "12.3 °C, 61 %", the last of each that is known.
std::string weather_text(const std::vector<QuantityStatus>& quantities,
                         display::UnitSystem system) {
  std::string text;
  for (const QuantityStatus& one : quantities) {
    const double last = one.last_interval ? one.last_interval->mean_kW : kAbsent;
    const double value = one.now.value_or(last);
    if (!std::isfinite(value)) continue;
    if (!text.empty()) text += ", ";
    const display::Unit unit = display::unit_of(system, one.quantity->unit);
    text += number_text(unit.shown(value), kWeatherDigits) + " " + unit.name;
  }
  return text.empty() ? "–" : text;
}

std::string value_text(const MeterStatus* status, metering::Utility utility,
                       display::UnitSystem system) {
  if (status == nullptr) return "–";
  if (!status->weather.empty()) return weather_text(status->weather, system);
  const display::Unit power = display::unit_of(system, "kW", utility);
  if (status->live.power_kW) return report::amount_text(*status->live.power_kW, power);
  if (!status->last_interval) return "–";
  return report::amount_text(status->last_interval->mean_kW, power);
}

Cell last_interval_cell(const MeterStatus* status, const Served& served) {
  if (status == nullptr) return {"–", "muted"};
  // For a sensor, that of its dry bulb, which comes first.
  const auto& last =
      status->weather.empty() ? status->last_interval : status->weather.front().last_interval;
  if (!last) return {"–", "muted"};
  const metering::Reading& reading = *last;
  const bool is_good = reading.validity == metering::Validity::ok;
  return {fmt::format("{} {}", site_time_text(served.calendar, reading.start),
                      metering::to_string(reading.validity)),
          is_good ? "" : "warn"};
}

Cell coverage_cell(const MeterStatus* status) {
  if (status == nullptr || std::isnan(status->open_month_coverage)) return {"–", "number"};
  const double coverage = status->open_month_coverage;
  return {(coverage < kCoverageGood ? "▲ " : "") + report::percent_text(coverage),
          coverage < kCoverageGood ? "number warn" : "number"};
}

void write_meters(Html& html, const Served& served, const GatewayStatus& status) {
  Table table{"Meters"};
  table.with_labels().columns(
      {"Meter", "State", "Load", "Last answer", "Last interval", "Measured this month"});
  for (const auto* const list : {&served.site.meters, &served.site.sensors}) {
    for (const MeterConfig& config : *list) {
      const auto found = std::ranges::find(status.meters, config.meter.id, &MeterStatus::id);
      const MeterStatus* const meter = found == status.meters.end() ? nullptr : &*found;
      const bool has_answered = meter != nullptr && meter->live.read_at;
      table.row({{config.meter.id},
                 state_cell(meter),
                 {value_text(meter, config.meter.utility, served.site.units), "number"},
                 {has_answered ? age_text(served.now() - *meter->live.read_at) + " ago" : "never"},
                 last_interval_cell(meter, served),
                 coverage_cell(meter)});
    }
  }
  table.write(html);
}

void write_verdict(Html& html, const Served& served, const GatewayStatus& status) {
  const auto reasons = reasons_not_ready(status);
  const auto polled = std::ranges::count_if(
      status.meters, [](const MeterStatus& meter) { return meter.poll.has_value(); });
  const auto silent = std::ranges::count_if(status.meters, [](const MeterStatus& meter) {
    return meter.poll && meter.poll->state != UnitState::up;
  });
  html.markup("<section aria-labelledby=\"verdict\"><h2 id=\"verdict\">Health</h2><ul>");
  html.element("li", fmt::format("✔ The daemon has been running since {}.",
                                 site_time_text(served.calendar, served.started)));
  for (const std::string& reason : reasons) html.element("li", "✖ Not ready: " + reason, "bad");
  if (status.clock_ok) html.element("li", "✔ The clock is set.");
  if (!status.store.is_degraded) {
    html.element("li", fmt::format("✔ The store accepts data ({} commits).", status.store.commits));
  }
  for (const std::string& reason : reasons_to_look(status)) {
    html.element("li", "▲ " + reason + ".", "warn");
  }
  if (silent == 0) {
    html.element("li", fmt::format("✔ All {} polled meters answer.", polled));
  } else {
    html.element("li",
                 fmt::format("▲ {} of {} polled meters answer only sometimes or not at all.",
                             silent, polled),
                 "warn");
  }
  html.markup("</ul></section>");
}

Cell job_state_cell(const StoredJob& job) {
  if (job.state == JobState::done)
    return job.accepted ? Cell{"✔ in use", "good"} : Cell{"▲ not accepted", "warn"};
  if (job.state == JobState::failed) return {"✖ failed", "bad"};
  return {std::string{recald::name_of(job.state)}};
}

void write_jobs(Html& html, const Served& served, JobKind kind, std::string caption) {
  const auto jobs = served.store.jobs(kind, kJobsShown);
  if (!jobs || jobs->empty()) return;
  Table table{std::move(caption)};
  table.with_labels().columns({"Number", "State", "Requested", "By", "Message"});
  for (const StoredJob& job : *jobs) {
    table.row({{std::to_string(job.number)},
               job_state_cell(job),
               {site_time_text(served.calendar, job.asked)},
               {job.asked_by},
               {job.message}});
  }
  table.write(html);
}

/// Alarms from the months after the calibration.
void write_alarms(Html& html, const Served& served) {
  const auto job = served.store.last_accepted(JobKind::calibration);
  if (!job || !*job) return;
  const auto& drift = (*job)->result.drift;
  if (!drift || drift->alarms.empty()) return;
  Table table{"What has changed"};
  table.with_labels().columns({"Since", "What", "Details"});
  for (const DriftAlarm& alarm : drift->alarms) {
    table.row({{alarm.since},
               {display::capitalised(display::output_words(alarm.output))},
               {alarm.sentence}});
  }
  table.write(html);
}

Cell severity_cell(Severity severity) {
  switch (severity) {
    case Severity::info:
      break;
    case Severity::warning:
      return {"▲ warning", "warn"};
    case Severity::error:
      return {"✖ error", "bad"};
  }
  return {"info"};
}

void write_events(Html& html, const Served& served) {
  const auto events = served.store.events(kEventsShown);
  if (!events) {
    html.element("p", "✖ The events cannot be read: " + events.error().message, "bad");
    return;
  }
  Table table{"Last events"};
  table.with_labels().columns({"When", "Severity", "What"});
  for (const StoreEvent& event : *events) {
    table.row({{site_time_text(served.calendar, event.time)},
               severity_cell(event.severity),
               {event.text}});
  }
  if (events->empty()) {
    html.element("p", "No events yet.", "muted");
  } else {
    table.write(html);
  }
}

}  // namespace

std::string site_time_text(const metering::LocalCalendar& calendar, Instant t) {
  if (t < std::chrono::sys_days{std::chrono::year{1971} / 1 / 1} || t >= metering::kLatestInstant) {
    return metering::to_string(t);  // before the clock was set
  }
  const metering::LocalTime local = calendar.local_time(t);
  const auto offset_minutes =
      std::chrono::duration_cast<std::chrono::minutes>(calendar.utc_offset(t)).count();
  const auto size = std::abs(offset_minutes);
  return fmt::format("{} {:02}:{:02} {}{:02}:{:02}", metering::to_string(local.date),
                     local.minute_of_day / 60, local.minute_of_day % 60,
                     offset_minutes < 0 ? "−" : "+", size / 60, size % 60);
}

std::string age_text(std::chrono::seconds age) {
  const auto s = age.count();
  if (s < 0) return "in the future";
  if (s < 120) return fmt::format("{} s", s);
  if (s < 2 * 3600) return fmt::format("{} min", s / 60);
  if (s < 2 * 86'400) return fmt::format("{} h", s / 3600);
  return fmt::format("{} days", s / 86'400);
}

http::Response status_page(const Served& served) {
  const GatewayStatus status = served.status();
  const std::string title = served.site.name.empty() ? served.site.id : served.site.name;
  Html html;
  html.markup(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<link rel=\"stylesheet\" href=\"/style.css\">");
  html.element("title", title + " – recald").markup("</head><body><main>");
  html.element("h1", title);
  html.element("p",
               fmt::format("As of {}; times are in {}.",
                           site_time_text(served.calendar, served.now()), served.site.timezone),
               "muted");
  write_verdict(html, served, status);
  write_meters(html, served, status);
  write_alarms(html, served);
  write_jobs(html, served, JobKind::calibration, "Last calibrations");
  write_jobs(html, served, JobKind::diagnosis, "Last diagnoses");
  write_events(html, served);
  html.markup(
      "</main><footer><nav aria-label=\"For programs\"><a href=\"/api/v1/meters\">meters</a> "
      "<a href=\"/api/v1/months\">months</a> <a href=\"/api/v1/events\">events</a> "
      "<a href=\"/metrics\">metrics</a> <a href=\"/readyz\">readiness</a></nav>");
  html.element("p", fmt::format("recald {}", kVersion), "muted");
  html.markup("</footer></body></html>\n");
  return {.content_type = "text/html; charset=utf-8", .body = html.str()};
}

http::Response status_style(const Served&) {
  http::Response response{.content_type = "text/css; charset=utf-8",
                          .body = std::string{kStatusStyle}};
  response.headers.emplace_back("Cache-Control", "private, max-age=3600");
  return response;
}

}  // namespace recald::daemon
