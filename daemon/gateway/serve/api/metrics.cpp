#include "daemon/gateway/serve/api/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>

#include "core/absent.hpp"
#include "daemon/gateway/serve/api/prometheus_text.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

double seconds_of(metering::Instant t) { return static_cast<double>(t.time_since_epoch().count()); }

void write_process(PrometheusText& text, const Served& served, const GatewayStatus& status) {
  text.begin("recald_build_info", "gauge", "Always 1; the label has the program's version.");
  text.sample(1.0, {{"version", kVersion}});
  text.begin("process_start_time_seconds", "gauge",
             "Start time of the process, in seconds since 1970.");
  text.sample(seconds_of(served.started));
  text.begin("recald_clock_ok", "gauge",
             "1 while readings can be stamped; 0 until the system clock has been set.");
  text.sample(status.clock_ok ? 1.0 : 0.0);
  text.begin("recald_events_total", "counter", "Events stored, by severity.");
  for (std::size_t i = 0; i < status.events.size(); ++i) {
    text.sample(static_cast<double>(status.events[i]),
                {{"severity", name_of(static_cast<Severity>(i))}});
  }
}

void write_buses(PrometheusText& text, const GatewayStatus& status) {
  text.begin("recald_poll_requests_total", "counter",
             "Requests to a meter by result; timeout includes failed connections.");
  for (const MeterStatus& meter : status.meters) {
    if (!meter.poll) continue;
    for (std::size_t i = 0; i < kRequestResults.size(); ++i) {
      const bool is_usual = static_cast<RequestResult>(i) == RequestResult::ok;
      if (meter.poll->requests[i] == 0 && !is_usual) continue;
      text.sample(static_cast<double>(meter.poll->requests[i]),
                  {{"bus", meter.poll->bus}, {"meter", meter.id}, {"result", kRequestResults[i]}});
    }
  }
  text.begin("recald_poll_duration_seconds", "histogram", "Time from a request to its result.");
  for (const BusStatus& bus : status.buses) text.histogram(bus.duration, {{"bus", bus.name}});
  text.begin("recald_poll_lateness_seconds", "histogram",
             "Delay of a poll's first request after its due time.");
  for (const BusStatus& bus : status.buses) text.histogram(bus.lateness, {{"bus", bus.name}});
}

void write_meters(PrometheusText& text, const GatewayStatus& status) {
  text.begin("recald_unit_state", "gauge", "State of a meter's device: 0 down, 1 degraded, 2 up.");
  for (const MeterStatus& meter : status.meters) {
    if (meter.poll) text.sample(static_cast<double>(meter.poll->state), {{"meter", meter.id}});
  }
  text.begin("recald_last_reading_timestamp_seconds", "gauge",
             "Time of a meter's last answer or pushed reading, in seconds since 1970.");
  for (const MeterStatus& meter : status.meters) {
    if (meter.live.read_at) text.sample(seconds_of(*meter.live.read_at), {{"meter", meter.id}});
  }
  text.begin("recald_month_coverage_ratio", "gauge",
             "Share of measured and valid intervals in the open month so far.");
  for (const MeterStatus& meter : status.meters) {
    if (std::isfinite(meter.open_month_coverage)) {
      text.sample(meter.open_month_coverage, {{"meter", meter.id}});
    }
  }
}

/// The figures themselves, for dashboards.
void write_loads(PrometheusText& text, const Served& served, const GatewayStatus& status) {
  const auto sample = [&](const MeterStatus& meter, double value) {
    const auto index = served.site.meter_index(meter.id);
    if (!index || !std::isfinite(value)) return;  // a weather sensor
    const metering::Utility utility = served.site.meters[*index].meter.utility;
    text.sample(value, {{"meter", meter.id}, {"utility", metering::to_string(utility)}});
  };
  text.begin("recald_power_kilowatts", "gauge", "Power at a polled meter's last answer.");
  for (const MeterStatus& meter : status.meters) {
    sample(meter, meter.live.power_kW.value_or(kAbsent));
  }
  text.begin(
      "recald_register_kilowatthours", "gauge",
      "Energy register at a polled meter's last answer; it starts again when a device does.");
  for (const MeterStatus& meter : status.meters) {
    sample(meter, meter.live.register_kWh.value_or(kAbsent));
  }
  text.begin("recald_interval_mean_kilowatts", "gauge",
             "Mean power of a meter's last stored interval, if it is valid.");
  for (const MeterStatus& meter : status.meters) {
    const auto& last = meter.last_interval;
    const bool is_valid = last && last->validity == metering::Validity::ok;
    sample(meter, is_valid ? last->mean_kW : kAbsent);
  }
}

void write_weather(PrometheusText& text, const GatewayStatus& status) {
  text.begin(
      "recald_weather_known_until_timestamp_seconds", "gauge",
      "End of the last valid interval of a weather sensor's quantity, in seconds since 1970.");
  for (const MeterStatus& meter : status.meters) {
    for (const QuantityStatus& one : meter.weather) {
      if (!one.known_until) continue;
      text.sample(seconds_of(*one.known_until),
                  {{"meter", meter.id}, {"quantity", one.quantity->name}});
    }
  }
}

void write_intervals(PrometheusText& text, const GatewayStatus& status) {
  text.begin("recald_intervals_total", "counter", "Intervals committed, by validity.");
  for (const MeterStatus& meter : status.meters) {
    for (std::size_t i = 0; i < meter.counters.intervals.size(); ++i) {
      const auto validity = static_cast<metering::Validity>(i);
      if (meter.counters.intervals[i] == 0 && validity != metering::Validity::ok) continue;
      text.sample(static_cast<double>(meter.counters.intervals[i]),
                  {{"meter", meter.id}, {"validity", metering::to_string(validity)}});
    }
  }
  text.begin("recald_late_intervals_total", "counter",
             "Intervals committed after their month had closed.");
  for (const MeterStatus& meter : status.meters) {
    text.sample(static_cast<double>(meter.counters.late), {{"meter", meter.id}});
  }
  text.begin("recald_counter_events_total", "counter",
             "Irregular events of a meter's counter: resets, jumps, bounces.");
  for (const MeterStatus& meter : status.meters) {
    for (const auto& [event, count] : meter.counters.events) {
      text.sample(static_cast<double>(count), {{"meter", meter.id}, {"event", event}});
    }
  }
}

/// The database and its write-ahead log.
double store_bytes(const std::filesystem::path& file) {
  double bytes = 0.0;
  for (const char* ending : {"", "-wal"}) {
    std::error_code missing;
    const auto size = std::filesystem::file_size(file.string() + ending, missing);
    if (!missing) bytes += static_cast<double>(size);
  }
  return bytes;
}

void write_store(PrometheusText& text, const Served& served, const GatewayStatus& status) {
  text.begin("recald_store_commit_seconds", "histogram", "Time the store takes for a commit.");
  text.histogram(status.store.durations);
  text.begin("recald_store_bytes", "gauge", "Size of the store with its write-ahead log.");
  text.sample(store_bytes(served.site.store.file));
}

void write_destinations(PrometheusText& text, const GatewayStatus& status) {
  if (status.destinations.empty()) return;
  text.begin("recald_outbox_entries", "gauge",
             "Intervals and months that a broker or database has not been sent yet.");
  for (const DestinationStatus& one : status.destinations) {
    text.sample(static_cast<double>(one.waiting), {{"destination", one.name}});
  }
}

/// Rises before an alarm does.
void write_evidence(PrometheusText& text, const DriftSummary& drift, const std::string& model) {
  text.begin("recald_drift_evidence_ratio", "gauge",
             "Log evidence that something has changed, divided by the alarm threshold, by month "
             "and by day; 1 raises an alarm.");
  for (const OutputDrift& one : drift.outputs) {
    const auto sample = [&](double ratio, const char* grain) {
      if (!std::isfinite(ratio)) return;
      text.sample(ratio, {{"model", model}, {"output", one.output}, {"grain", grain}});
    };
    sample(one.log_evidence / one.log_threshold, "month");
    if (one.daily) sample(one.daily->log_evidence / one.daily->log_threshold, "day");
  }
}

void write_drift(PrometheusText& text, const DriftSummary& drift, const std::string& model) {
  write_evidence(text, drift, model);
  text.begin(
      "recald_drift_pvalue", "gauge",
      "Agreement of the newest month with the calibration in use; a small value means drift.");
  for (const OutputDrift& one : drift.outputs) {
    if (!std::isfinite(one.pvalue)) continue;
    text.sample(one.pvalue, {{"model", model}, {"output", one.output}});
  }
}

/// Alerting should watch this.
void write_alarms(PrometheusText& text, const DriftSummary& drift, const std::string& model) {
  std::map<std::string, int> alarms;
  for (const DriftAlarm& one : drift.alarms) ++alarms[one.output];
  text.begin("recald_drift_alarms", "gauge",
             "Alarms in the months followed so far: the building or a meter has changed.");
  for (const auto& [output, count] : alarms) {
    text.sample(count, {{"model", model}, {"output", output}});
  }
}

/// The calibration in use. Nothing is written without one, or while the store cannot be read.
void write_calibration(PrometheusText& text, const Served& served) {
  const auto job = served.store.last_accepted(JobKind::calibration);
  if (!job || !*job || !(*job)->ended) return;
  const JobResult& result = (*job)->result;
  const std::string model{served.site.model ? name_of(served.site.model->kind) : ""};
  text.begin("recald_calibration_age_seconds", "gauge", "Age of the calibration in use.");
  text.sample(static_cast<double>((served.now() - *(*job)->ended).count()), {{"model", model}});
  if (std::isfinite(result.rhat_max)) {
    text.begin("recald_calibration_rhat_max", "gauge",
               "Largest R-hat of the calibration in use; near 1 if its chains agree.");
    text.sample(result.rhat_max, {{"model", model}});
  }
  if (!result.drift) return;
  write_drift(text, *result.drift, model);
  write_alarms(text, *result.drift, model);
}

}  // namespace

http::Response metrics(const Served& served) {
  const GatewayStatus status = served.status();
  PrometheusText text;
  write_process(text, served, status);
  write_buses(text, status);
  write_meters(text, status);
  write_loads(text, served, status);
  write_weather(text, status);
  write_intervals(text, status);
  write_store(text, served, status);
  write_destinations(text, status);
  write_calibration(text, served);
  return {.content_type = "text/plain; version=0.0.4; charset=utf-8", .body = text.str()};
}

}  // namespace recald::daemon
