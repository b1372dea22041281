#include "daemon/commands/meters/check_meters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/commands/meters/bus_access.hpp"

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Between two reads of a counter: at any load that matters it has risen by some steps of a Wh.
constexpr milliseconds kBetweenReads{3'000};

MeterTrial try_on(const BusConfig& bus, BusAccess& access, const MeterConfig& meter) {
  const auto timeout = timeout_of(bus, meter.live->timeout);
  return try_meter(
      meter, [&](const modbus::ReadRequest& request) { return access.ask(request, timeout); });
}

/// What accepts a connection and never answers may be a serial server that passes RTU frames on.
void try_rtu_frames(const BusConfig& bus, BusAccess& access, const MeterConfig& meter,
                    MeterTrial& trial) {
  const auto* const tcp = std::get_if<modbus::TcpEndpoint>(&bus.endpoint);
  if (tcp == nullptr || tcp->has_rtu_frames || !trial.is_silent) return;
  access.connection().close();  // some serve one connection
  BusConfig as_rtu = bus;
  std::get<modbus::TcpEndpoint>(as_rtu.endpoint).has_rtu_frames = true;
  BusAccess other{as_rtu};
  const bool answers = !try_on(as_rtu, other, meter).is_silent;
  const std::string where = modbus::to_string(bus.endpoint);
  trial.failures.push_back(
      answers
          ? fmt::format("{} answers RTU frames, as a serial server passes them on; set framing = "
                        "\"rtu\" in [bus.{}]",
                        where, bus.name)
          : fmt::format("{} accepts the connection, as a serial server does that passes RTU "
                        "frames on; if it is one, set framing = \"rtu\" in [bus.{}], and check "
                        "unit, baud and parity",
                        where, bus.name));
}

/// A meter that was read, and when.
struct FirstTrial {
  TriedMeter tried;
  BusAccess* access;  ///< Null: its bus was left alone.
  steady_clock::time_point at;
};

void read_again(FirstTrial& first) {
  const MeterConfig& meter = *first.tried.meter;
  const bool has_counter = !meter.live->map.energy.empty() && meter.meter.rated_kW;
  if (first.access == nullptr || !has_counter || !first.tried.trial.failures.empty()) return;
  std::this_thread::sleep_until(first.at + kBetweenReads);
  const MeterTrial second = try_on(*first.tried.bus, *first.access, meter);
  const auto between = std::chrono::duration_cast<milliseconds>(steady_clock::now() - first.at);
  for (std::string& sentence : impossible_rises(meter, first.tried.trial, second, between)) {
    first.tried.trial.failures.push_back(std::move(sentence));
  }
}

}  // namespace

std::vector<TriedMeter> try_meters(const SiteConfig& site,
                                   const std::function<void(const TriedMeter&)>& report) {
  std::deque<BusAccess> accesses;
  std::vector<FirstTrial> first;
  for (const BusConfig& bus : site.buses) {
    const auto taken = why_bus_is_taken(bus);
    BusAccess& access = accesses.emplace_back(bus);
    for (const auto* const list : {&site.meters, &site.sensors}) {
      for (const MeterConfig& meter : *list) {
        if (!meter.live || meter.live->bus != bus.name) continue;
        MeterTrial trial = taken ? MeterTrial{.failures = {"was not tried: " + *taken}}
                                 : try_on(bus, access, meter);
        try_rtu_frames(bus, access, meter, trial);
        first.push_back(
            {{&meter, &bus, std::move(trial)}, taken ? nullptr : &access, steady_clock::now()});
      }
    }
  }
  std::vector<TriedMeter> tried;
  for (FirstTrial& one : first) {
    read_again(one);
    tried.push_back(std::move(one.tried));
    report(tried.back());
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
