#include "simulators/devices/device_plan.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <sstream>

#include "simulators/devices/recorded_load.hpp"
#include "simulators/toml/toml_table.hpp"

namespace recald::simulators {
namespace {

constexpr double kCopyStep_kWh = 1000.0;
constexpr double kLoadMax_kW = 1e6;
constexpr std::array kTransports{Word<Transport>{"tcp", Transport::tcp},
                                 Word<Transport>{"rtu", Transport::rtu}};

class PlanReader {
 public:
  PlanReader(const std::filesystem::path& file, const FaultScript& faults, Complaint& complaint)
      : folder_(file.parent_path()), faults_(faults), complaint_(complaint) {}

  std::vector<EndpointPlan> read(const toml::table& file) {
    TomlTable plan{&file, "", complaint_};
    std::vector<EndpointPlan> endpoints;
    for (TomlTable& table : plan.tables("endpoint")) add_endpoints(table, endpoints);
    plan.no_other_keys();
    if (endpoints.empty()) complaint_.about(nullptr, "there is no [[endpoint]]");
    return endpoints;
  }

 private:
  void add_endpoints(TomlTable& table, std::vector<EndpointPlan>& endpoints) {
    EndpointPlan endpoint{.faults = faults_};
    std::int64_t port = 0;
    std::int64_t repeat = 1;
    table.word("type", kTransports, endpoint.transport);
    table.whole("repeat", 1, 1000, repeat);
    if (endpoint.transport == Transport::tcp) {
      table.whole("port", 0, 65'536 - repeat, port);
      table.flag("single_connection", endpoint.single_connection);
    } else if (endpoint.link = table.text("link"); endpoint.link.empty()) {
      complaint_.about(table.node(), "an [[endpoint]] of type \"rtu\" needs a link");
    }
    if (const std::string name = table.text("faults"); !name.empty()) {
      auto own = read_fault_script(folder_ / name);
      if (own) endpoint.faults = std::move(*own);
      if (!own) complaint_.about(table.node(), own.error().message);
    }
    auto tables = table.tables("device");
    table.no_other_keys();
    if (tables.empty()) complaint_.about(table.node(), "an [[endpoint]] without devices");
    for (std::int64_t copy = 0; copy < repeat; ++copy) {
      EndpointPlan each = endpoint;
      if (port > 0) each.port = static_cast<std::uint16_t>(port + copy);
      if (!each.link.empty()) {
        each.link = folder_ / each.link;
        if (repeat > 1) each.link += std::to_string(copy);
      }
      for (TomlTable& device : tables) add_devices(device, copy, each.devices);
      endpoints.push_back(std::move(each));
    }
  }

  void add_devices(TomlTable& table, std::int64_t endpoint_copy,
                   std::vector<SimulatedDevice>& devices) {
    SimulatedDevice device{.layout = read_layout(table)};
    std::int64_t unit = -1;
    std::int64_t repeat = 1;
    table.whole("repeat", 1, 247, repeat);
    table.whole("unit", 0, 256 - repeat, unit);
    if (unit < 0) complaint_.about(table.node(), "a device needs a unit, 0 to 255");
    table.number("start_kWh", 0.0, 1e12, device.start_kWh);
    device.load = read_load(table);
    table.no_other_keys();
    if (!complaint_.empty()) return;
    for (std::int64_t copy = 0; copy < repeat; ++copy) {
      SimulatedDevice each = device;
      each.unit = static_cast<std::uint8_t>(unit + copy);
      each.start_kWh += kCopyStep_kWh * static_cast<double>(endpoint_copy * repeat + copy);
      if (std::ranges::find(devices, each.unit, &SimulatedDevice::unit) != devices.end()) {
        complaint_.about(table.node(), fmt::format("two devices with unit {}", each.unit));
      }
      devices.push_back(std::move(each));
    }
  }

  const DeviceLayout* read_layout(TomlTable& table) {
    const std::string name = table.text("layout");
    const DeviceLayout* layout = find_layout(name);
    if (layout != nullptr) return layout;
    std::string known;
    for (const DeviceLayout& each : layouts()) {
      known += (known.empty() ? "" : ", ") + std::string{each.name};
    }
    complaint_.about(table.node(),
                     fmt::format("layout \"{}\" is not known; there are {}", name, known));
    return nullptr;
  }

  std::shared_ptr<const LoadShape> read_load(TomlTable& table) {
    const std::string recording = table.text("recording");
    const std::string meter = table.text("meter");
    const auto load_kW = table.one_or_numbers("load_kW", 24, 0.0, kLoadMax_kW);
    if (recording.empty() == load_kW.empty() || recording.empty() != meter.empty()) {
      complaint_.about(table.node(), "a device needs either load_kW or recording and meter");
      return nullptr;
    }
    if (load_kW.size() == 1) return shared(LoadShape::constant(load_kW[0]));
    if (!load_kW.empty()) return shared(LoadShape::daily(load_kW));
    auto& known = recordings_[{recording, meter}];
    if (known) return known;
    auto load = read_recorded_load(folder_ / recording, meter);
    if (load) {
      known = shared(std::move(*load));
    } else {
      complaint_.about(table.node(), load.error().message);
    }
    return known;
  }

  static std::shared_ptr<const LoadShape> shared(LoadShape load) {
    return std::make_shared<const LoadShape>(std::move(load));
  }

  std::filesystem::path folder_;
  const FaultScript& faults_;
  Complaint& complaint_;
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const LoadShape>> recordings_;
};

}  // namespace

Result<std::vector<EndpointPlan>> read_device_plan(const std::filesystem::path& file,
                                                   const FaultScript& faults) {
  const auto table = read_toml(file, "plan");
  if (!table) return tl::unexpected(table.error());
  Complaint complaint{file.string()};
  auto endpoints = PlanReader{file, faults, complaint}.read(*table);
  if (!complaint.empty()) return failure(ErrorCode::invalid_value, complaint.sentence());
  return endpoints;
}

Result<FaultScript> read_fault_script(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    return failure(ErrorCode::not_found,
                   fmt::format("cannot read the fault script {}; check its path", file.string()));
  }
  auto script = parse_fault_script(text.str());
  if (!script) {
    return failure(script.error().code,
                   fmt::format("{}: {}", file.string(), script.error().message));
  }
  return script;
}

}  // namespace recald::simulators
