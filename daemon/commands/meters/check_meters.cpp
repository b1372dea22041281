#include "daemon/commands/meters/check_meters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/commands/meters/bus_access.hpp"

namespace recald::daemon {
namespace {

MeterTrial try_on(const BusConfig& bus, BusAccess& access, const MeterConfig& meter) {
  const auto timeout = timeout_of(bus, meter.live->timeout);
  return try_meter(
      meter, [&](const modbus::ReadRequest& request) { return access.ask(request, timeout); });
}

}  // namespace

std::vector<TriedMeter> try_meters(const SiteConfig& site,
                                   const std::function<void(const TriedMeter&)>& report) {
  std::vector<TriedMeter> tried;
  for (const BusConfig& bus : site.buses) {
    const auto taken = why_bus_is_taken(bus);
    BusAccess access{bus};
    for (const auto* const list : {&site.meters, &site.sensors}) {
      for (const MeterConfig& meter : *list) {
        if (!meter.live || meter.live->bus != bus.name) continue;
        tried.push_back({&meter, &bus,
                         taken ? MeterTrial{.failures = {"was not tried: " + *taken}}
                               : try_on(bus, access, meter)});
        report(tried.back());
      }
    }
  }
  return tried;
}

void print_trial(const TriedMeter& tried, const Console& console) {
  const LiveMeterConfig& live = *tried.meter->live;
  console.out << fmt::format("meter {}: unit {} at {}, {}\n", tried.meter->meter.id, live.unit,
                             modbus::to_string(tried.bus->endpoint), live.map.title);
  for (const std::string& note : tried.trial.notes) console.out << "  " << note << "\n";
  for (const FieldTrial& one : tried.trial.fields) {
    console.out << fmt::format("  {} {:<24} {:<24} {:>5} ms\n", one.is_metered ? '*' : ' ',
                               one.found.field->name, describe(one.found), one.duration.count());
  }
  for (const std::string& warning : tried.trial.warnings) {
    console.out << "  ! " << warning << "\n";
  }
  for (const std::string& failure : tried.trial.failures) {
    console.out << "  ! " << failure << "\n";
  }
}

nlohmann::ordered_json json_of(const TriedMeter& tried) {
  using Json = nlohmann::ordered_json;
  Json fields = Json::array();
  for (const FieldTrial& one : tried.trial.fields) {
    Json field{{"name", one.found.field->name},
               {"metered", one.is_metered},
               {"value", nullptr},
               {"unit", one.found.field->unit},
               {"duration_ms", one.duration.count()}};
    if (one.found.value) {
      field["value"] = one.found.value->value;
    } else {
      field["why_none"] = one.found.value.error();
    }
    fields.push_back(std::move(field));
  }
  return {{"meter", tried.meter->meter.id},     {"bus", tried.bus->name},
          {"unit", tried.meter->live->unit},    {"map", tried.meter->live->map.name},
          {"ok", tried.trial.failures.empty()}, {"fields", fields},
          {"notes", tried.trial.notes},         {"warnings", tried.trial.warnings},
          {"failures", tried.trial.failures}};
}

std::vector<std::string> problems_of(const TriedMeter& tried) {
  std::vector<std::string> problems;
  for (const std::string& failure : tried.trial.failures) {
    problems.push_back(fmt::format("meter '{}' (unit {} at {}): {}", tried.meter->meter.id,
                                   tried.meter->live->unit, modbus::to_string(tried.bus->endpoint),
                                   failure));
  }
  return problems;
}

}  // namespace recald::daemon
