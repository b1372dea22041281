#include "daemon/gateway/serve/api/shapes.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;
using metering::to_string;

Json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json or_null(const std::optional<metering::Instant>& instant) {
  return instant ? Json(to_string(*instant)) : Json();
}

std::string number_or_null(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

double energy_kWh(const metering::Reading& reading, std::chrono::seconds length) {
  return reading.mean_kW * static_cast<double>(length.count()) / 3600.0;
}

/// ["timeout","clock"]
std::string reasons_list(metering::Reason reasons) {
  std::string list = to_string(reasons);
  if (list.empty()) return "[]";
  for (std::size_t bar = 0; (bar = list.find('|', bar)) != std::string::npos; bar += 3) {
    list.replace(bar, 1, "\",\"");
  }
  return "[\"" + list + "\"]";
}

Json refused_json(const std::vector<RefusedRegisters>& all) {
  Json list = Json::array();
  for (const RefusedRegisters& one : all) {
    list.push_back({{"address", one.address},
                    {"count", one.count},
                    {"exception", one.exception},
                    {"since", to_string(one.since)}});
  }
  return list;
}

Json quantities_json(const std::vector<QuantityStatus>& quantities) {
  Json all = Json::object();
  for (const QuantityStatus& one : quantities) {
    Json last;
    if (one.last_interval) {
      last = Json::parse(weather_interval_json({.reading = *one.last_interval}));
      last.erase("revision");
    }
    all[std::string{one.quantity->name}] = {
        {"unit", one.quantity->unit},
        {"now", or_null(one.now)},
        {"known_until", or_null(one.known_until)},
        {"silent_since", or_null(one.state.silent_since)},
        {"frozen_since", or_null(one.state.frozen_since)},
        {"open_month_coverage", or_null(one.open_month_coverage)},
        {"last_interval", last}};
  }
  return all;
}

/// For a weather sensor.
Json sensor_status_json(const MeterStatus& status) {
  Json json;
  if (status.poll) {
    json = {{"state", name_of(status.poll->state)},
            {"skipped_polls", status.poll->skipped},
            {"refused", refused_json(status.poll->refused)}};
  }
  json["read_at"] = or_null(status.live.read_at);
  json["open_month_coverage"] = or_null(status.open_month_coverage);
  json["weather"] = quantities_json(status.weather);
  return json;
}

Json status_json(const MeterStatus& status, std::chrono::seconds length) {
  Json last;
  if (status.last_interval) {
    last = Json::parse(interval_json({.reading = *status.last_interval}, length));
    last.erase("revision");  // the latest commit does not report it
  }
  Json json;
  if (status.poll) {
    json = {{"state", name_of(status.poll->state)},
            {"power_kW", or_null(status.live.power_kW)},
            {"register_kWh", or_null(status.live.register_kWh)},
            {"skipped_polls", status.poll->skipped},
            {"refused", refused_json(status.poll->refused)}};
  }
  json["read_at"] = or_null(status.live.read_at);
  json["open_month_coverage"] = or_null(status.open_month_coverage);
  json["last_interval"] = last;
  return json;
}

}  // namespace

std::string_view name_of(UnitState state) {
  constexpr std::array<std::string_view, 3> kNames{"down", "degraded", "up"};
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view name_of(Severity severity) {
  constexpr std::array<std::string_view, 3> kNames{"info", "warning", "error"};
  return kNames.at(static_cast<std::size_t>(severity));
}

Json meter_json(const MeterConfig& config, const MeterStatus* status) {
  const bool is_weather = config.role == MeterRole::weather;
  Json json = {{"id", config.meter.id}};
  if (is_weather) {
    json["role"] = "weather";
  } else {
    json["utility"] = to_string(config.meter.utility);
  }
  json["interval_s"] = config.meter.interval.count();
  if (!is_weather) json["rated_kW"] = or_null(config.meter.rated_kW);
  json["source"] = name_of(config.source);
  if (config.live) {
    json["bus"] = config.live->bus;
    json["unit"] = config.live->unit;
    json["poll_s"] = config.live->poll.count();
  }
  if (status != nullptr) {
    json.update(is_weather ? sensor_status_json(*status)
                           : status_json(*status, config.meter.interval));
  }
  return json;
}

std::string weather_interval_json(const StoredInterval& interval) {
  const metering::Reading& reading = interval.reading;
  return fmt::format(
      R"({{"start":"{}","mean":{},"validity":"{}","late":{},"reasons":{},"revision":{}}})",
      to_string(reading.start), number_or_null(reading.mean_kW), to_string(reading.validity),
      reading.late, reasons_list(reading.reasons), interval.revision);
}

std::string interval_json(const StoredInterval& interval, std::chrono::seconds length) {
  const metering::Reading& reading = interval.reading;
  return fmt::format(
      R"({{"start":"{}","mean_kW":{},"energy_kWh":{},"validity":"{}","late":{},"reasons":{},)"
      R"("revision":{}}})",
      to_string(reading.start), number_or_null(reading.mean_kW),
      number_or_null(energy_kWh(reading, length)), to_string(reading.validity), reading.late,
      reasons_list(reading.reasons), interval.revision);
}

std::string history_point_json(const HistoryPoint& point) {
  return fmt::format(R"({{"start":"{}","least":{},"mean":{},"most":{},"valid_share":{:.4g}}})",
                     to_string(point.start), number_or_null(point.least_kW),
                     number_or_null(point.mean_kW), number_or_null(point.most_kW),
                     point.valid_share);
}

Json month_json(const std::string& meter, const metering::MonthlyFigure& figure) {
  Json slots;
  for (std::size_t i = 0; i < figure.slots_by_validity.size(); ++i) {
    slots[std::string{to_string(static_cast<metering::Validity>(i))}] = figure.slots_by_validity[i];
  }
  Json peak;
  if (figure.peak) {
    peak = {{"peak_kW", figure.peak->kW},
            {"start", to_string(figure.peak->start)},
            {"window_s", figure.peak_window.count()},
            {"could_be_exceeded", figure.peak->could_be_exceeded}};
  }
  return {{"meter", meter},
          {"month", to_string(figure.month)},
          {"daily_average_kWh", or_null(figure.daily_average_kWh)},
          {"daily_average_variance_kWh2", or_null(figure.daily_average_variance_kWh2)},
          {"peak", peak},
          {"coverage", figure.coverage},
          {"filled_share", figure.filled_share},
          {"slots", figure.slots},
          {"slots_by_validity", slots},
          {"usable", figure.usable},
          {"unusable_because", figure.unusable_because},
          {"reasons", Json::parse(reasons_list(figure.reasons))},
          {"revision", figure.revision}};
}

Json event_json(const StoreEvent& event) {
  return {{"time", to_string(event.time)},
          {"severity", name_of(event.severity)},
          {"kind", event.kind},
          {"subject", event.subject},
          {"text", event.text},
          {"count", event.count},
          {"last_time", or_null(event.last)}};
}

Json job_json(const StoredJob& job) {
  return {{"id", job.number},
          {"kind", recald::name_of(job.kind)},
          {"state", recald::name_of(job.state)},
          {"asked_by", job.asked_by},
          {"asked_at", to_string(job.asked)},
          {"started_at", or_null(job.started)},
          {"ended_at", or_null(job.ended)},
          {"accepted", job.accepted},
          {"message", job.message}};
}

}  // namespace recald::daemon
