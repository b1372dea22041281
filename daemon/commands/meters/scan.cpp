/// `recald scan`: what is on a bus, for whoever writes a site file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/text/nearest.hpp"
#include "core/text/printable.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/meters/scan_bus.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> meters_of(const SiteConfig& site, const std::string& bus, int unit) {
  std::vector<std::string> ids;
  for (const auto* const list : {&site.meters, &site.sensors}) {
    for (const MeterConfig& meter : *list) {
      if (meter.live && meter.live->bus == bus && meter.live->unit == unit) {
        ids.push_back(meter.meter.id);
      }
    }
  }
  return ids;
}

/// What devices send need not be text.
std::string words_of(const modbus::DeviceIdentity& identity) {
  return printable(fmt::format("{} {} {}", identity.vendor, identity.product, identity.revision));
}

void print_unit(const FoundUnit& found, const std::vector<std::string>& meters,
                const Console& console) {
  const auto or_silent = [](const std::string& text) { return text.empty() ? "silent" : text; };
  console.out << fmt::format("unit {:<4} function 3: {}; function 4: {}\n", found.unit,
                             or_silent(found.holding_registers), or_silent(found.input_registers));
  if (found.identity) console.out << fmt::format("  {}\n", words_of(*found.identity));
  if (!found.models.empty()) {
    std::vector<std::string> models;
    for (const modbus::SunSpecModel& model : found.models) {
      models.push_back(fmt::format("{} @{}", model.id, model.address));
    }
    console.out << fmt::format("  SunSpec models {}\n", fmt::join(models, ", "));
  }
  if (!meters.empty()) {
    console.out << fmt::format("  in the site file: {}\n", fmt::join(meters, ", "));
  }
}

Json json_of(const FoundUnit& found, const std::vector<std::string>& meters) {
  const auto or_null = [](const std::string& text) { return text.empty() ? Json() : Json(text); };
  Json models = Json::array();
  for (const modbus::SunSpecModel& model : found.models) {
    models.push_back({{"id", model.id}, {"address", model.address}, {"length", model.length}});
  }
  Json identity;
  if (found.identity) {
    identity = {{"vendor", printable(found.identity->vendor)},
                {"product", printable(found.identity->product)},
                {"revision", printable(found.identity->revision)}};
  }
  return {{"unit", found.unit},
          {"holding_registers", or_null(found.holding_registers)},
          {"input_registers", or_null(found.input_registers)},
          {"identity", identity},
          {"sunspec_models", models},
          {"meters", meters}};
}

/// Drawn over itself, and gone at the end.
class ScanProgress {
 public:
  ScanProgress(const Console& console, const UnitRange& units) : console_(console), units_(units) {}
  ~ScanProgress() {
    if (console_.is_terminal) console_.err << kLineOver << std::flush;
  }
  ScanProgress(const ScanProgress&) = delete;
  ScanProgress& operator=(const ScanProgress&) = delete;

  void show(int unit, std::size_t found) const {
    if (!console_.is_terminal) return;
    console_.err << fmt::format("\r\033[Kunit {} of {} to {}, {} found", unit, units_.first,
                                units_.last, found)
                 << std::flush;
  }

 private:
  const Console& console_;
  UnitRange units_;
};

BusScan scan_aloud(const BusConfig& bus, const UnitRange& units, const Console& console) {
  const ScanProgress progress{console, units};
  return scan_bus(bus, units, [&](int unit, std::size_t found) { progress.show(unit, found); });
}

std::string no_such_bus(const SiteConfig& site, const std::string& name) {
  std::vector<std::string_view> names;
  for (const BusConfig& bus : site.buses) names.push_back(bus.name);
  const std::string_view nearest = nearest_name(name, names);
  const std::string meant =
      !nearest.empty() ? fmt::format("did you mean '{}'?", nearest)
      : names.empty()  ? std::string{"the site has no bus"}
                       : fmt::format("the buses of the site are {}", fmt::join(names, ", "));
  return fmt::format("{}: there is no [bus.{}]; {}", site.file.filename().string(), printable(name),
                     meant);
}

}  // namespace

int run_scan(const ScanArguments& arguments, const Console& console) {
  const auto units = parse_units(arguments.units);
  if (!units) return console.misused(units.error().message);
  const auto site = load_site(arguments.site);
  if (!site) return console.fail(site.error());
  const auto bus = std::ranges::find(site->buses, arguments.bus, &BusConfig::name);
  if (bus == site->buses.end()) return console.fail(no_such_bus(*site, arguments.bus));
  if (const auto taken = why_bus_is_taken(*bus)) return console.fail(*taken);

  const BusScan scan = scan_aloud(*bus, *units, console);
  Json found = Json::array();
  for (const FoundUnit& unit : scan.found) {
    const auto meters = meters_of(*site, bus->name, unit.unit);
    if (!arguments.json) print_unit(unit, meters, console);
    found.push_back(json_of(unit, meters));
  }
  if (arguments.json) {
    const Json result{{"bus", bus->name},
                      {"endpoint", modbus::to_string(bus->endpoint)},
                      {"first_unit", units->first},
                      {"last_unit", units->last},
                      {"found", found}};
    console.out << result.dump(2) << "\n";
  }
  if (scan.ended_by) return console.fail(*scan.ended_by);
  if (scan.found.empty()) {
    const auto* const tcp = std::get_if<modbus::TcpEndpoint>(&bus->endpoint);
    const bool may_be_rtu = tcp != nullptr && !tcp->has_rtu_frames;
    return console.fail(fmt::format(
        "no unit from {} to {} answers at {}{}", units->first, units->last,
        modbus::to_string(bus->endpoint),
        may_be_rtu
            ? fmt::format(", which accepts the connection, as a serial server does that passes "
                          "RTU frames on; if it is one, set framing = \"rtu\" in [bus.{}]",
                          bus->name)
            : ""));
  }
  return kSuccess;
}

}  // namespace recald::daemon
