#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/html.hpp"
#include "core/absent.hpp"
#include "core/display/unit.hpp"
#include "core/text/number_text.hpp"
#include "daemon/gateway/serve/api/readiness.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"
#include "daemon/gateway/serve/pages/meter_chart.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"

namespace recald::daemon {
namespace {

using views::Cell;
using views::Html;
using views::Table;

constexpr int kEventsShown = 20;
constexpr int kJobsShown = 3;
constexpr int kChartsMax = 8;  // More meters are looked at one by one.
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
  if (status->live.power_kW) return views::amount_text(*status->live.power_kW, power);
  if (!status->last_interval) return "–";
  return views::amount_text(status->last_interval->mean_kW, power);
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
  return {(coverage < kCoverageGood ? "▲ " : "") + views::percent_text(coverage),
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
      table.row({{config.meter.id, "", "/meters/" + config.meter.id},
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

/// Null: the model says nothing of this meter.
const ExpectedMeter* expected_of(const Served& served, const std::string& meter) {
  if (!served.expected) return nullptr;
  const std::vector<ExpectedMeter>& all = served.expected();
  const auto found = std::ranges::find(all, meter, &ExpectedMeter::meter);
  return found == all.end() || found->hours.empty() ? nullptr : &*found;
}

/// The last seven days of each meter, or nothing if there are too many.
void write_week(Html& html, const Served& served) {
  const auto stored = std::ranges::count_if(served.site.meters, &MeterConfig::is_stored);
  if (stored == 0 || stored > kChartsMax) return;
  html.markup("<section aria-labelledby=\"week\">").markup("<h2 id=\"week\">Last seven days</h2>");
  html.markup("<div class=\"charts\">");
  // On the hour, like what the model expects.
  const metering::TimeSpan week{
      std::chrono::floor<std::chrono::hours>(served.now() - std::chrono::days{7}), served.now()};
  for (const MeterConfig& meter : served.site.meters) {
    if (!meter.is_stored()) continue;
    html.markup("<figure>").markup("<figcaption>");
    html.link("/meters/" + meter.meter.id, meter.meter.id).markup("</figcaption>");
    if (const ExpectedMeter* const expected = expected_of(served, meter.meter.id)) {
      write_expected_chart(html, served, meter.meter, *expected, week);
    } else {
      write_meter_chart(html, served, meter.meter, nullptr, week, ChartKind::still);
    }
    html.markup("</figure>");
  }
  html.markup("</div></section>");
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

http::Response now_page(const Served& served) {
  const GatewayStatus status = served.status();
  Html html;
  html.element("h1", "Now");
  write_verdict(html, served, status);
  write_job_now(html, served);
  write_alarms(html, served);
  write_meters(html, served, status);
  write_week(html, served);
  write_jobs(html, served, JobKind::calibration, "Last calibrations", kJobsShown);
  write_jobs(html, served, JobKind::diagnosis, "Last diagnoses", kJobsShown);
  write_events(html, served);
  return page_of(served, PageKind::now, "", html);
}

}  // namespace recald::daemon
