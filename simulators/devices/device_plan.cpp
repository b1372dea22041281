#include "simulators/devices/device_plan.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <sstream>

#include "adapters/toml/toml_reader.hpp"
#include "simulators/devices/recorded_load.hpp"

namespace recald::simulators {
namespace {

constexpr double kCopyStep_kWh = 1000.0;
constexpr double kLoadMax_kW = 1e6;
constexpr std::array kTransports{Word<Transport>{"tcp", Transport::tcp},
                                 Word<Transport>{"rtu", Transport::rtu}};

class PlanReader {
 public:
  PlanReader(const std::filesystem::path& file, const FaultScript& faults)
      : folder_(file.parent_path()), faults_(faults) {}

  std::vector<EndpointPlan> read(TomlReader plan) {
    std::vector<EndpointPlan> endpoints;
    for (TomlReader& table : plan.tables("endpoint")) add_endpoints(table, endpoints);
    plan.finish();
    if (endpoints.empty()) plan.problem("there is no [[endpoint]]");
    return endpoints;
  }

 private:
  void add_endpoints(TomlReader& table, std::vector<EndpointPlan>& endpoints) {
    EndpointPlan endpoint{.faults = faults_};
    int port = 0;
    endpoint.transport = table.word("type", kTransports).value_or(endpoint.transport);
    const int repeat = table.whole_number_or("repeat", 1, {1, 1000});
    if (endpoint.transport == Transport::tcp) {
      port = table.whole_number_or("port", 0, {0, 65'536.0 - repeat});
      endpoint.single_connection = table.boolean("single_connection").value_or(false);
    } else {
      endpoint.link = table.required_text("link");
    }
    if (const std::string name = table.text_or("faults", ""); !name.empty()) {
      auto own = read_fault_script(folder_ / name);
      if (own) endpoint.faults = std::move(*own);
      if (!own) table.problem(own.error().message);
    }
    auto tables = table.tables("device");
    table.finish();
    if (tables.empty()) table.problem("there is no [[endpoint.device]]");
    for (int copy = 0; copy < repeat; ++copy) {
      EndpointPlan each = endpoint;
      if (port > 0) each.port = static_cast<std::uint16_t>(port + copy);
      if (!each.link.empty()) {
        each.link = folder_ / each.link;
        if (repeat > 1) each.link += std::to_string(copy);
      }
      for (const TomlReader& device : tables) add_devices(device, copy, each.devices);
      endpoints.push_back(std::move(each));
    }
  }

  void add_devices(TomlReader table, int endpoint_copy, std::vector<SimulatedDevice>& devices) {
    SimulatedDevice device{.layout = read_layout(table)};
    const int repeat = table.whole_number_or("repeat", 1, {1, 247});
    if (!table.has("unit")) table.problem("'unit' is missing");
    const int unit = table.whole_number_or("unit", 0, {0, 256.0 - repeat});
    device.start_kWh = table.number_or("start_kWh", device.start_kWh, {0.0, 1e12});
    device.load = read_load(table);
    table.finish();
    if (table.has_problems()) return;
    for (int copy = 0; copy < repeat; ++copy) {
      SimulatedDevice each = device;
      each.unit = static_cast<std::uint8_t>(unit + copy);
      each.start_kWh += kCopyStep_kWh * static_cast<double>(endpoint_copy * repeat + copy);
      if (std::ranges::find(devices, each.unit, &SimulatedDevice::unit) != devices.end()) {
        table.problem(fmt::format("two devices with unit {}", each.unit));
      }
      devices.push_back(std::move(each));
    }
  }

  const DeviceLayout* read_layout(TomlReader& table) {
    const std::string name = table.required_text("layout");
    const DeviceLayout* layout = find_layout(name);
    if (layout != nullptr) return layout;
    std::string known;
    for (const DeviceLayout& each : layouts()) {
      known += (known.empty() ? "" : ", ") + std::string{each.name};
    }
    table.problem(fmt::format("layout \"{}\" is not known; there are {}", name, known));
    return nullptr;
  }

  std::shared_ptr<const LoadShape> read_load(TomlReader& table) {
    const std::string recording = table.text_or("recording", "");
    const std::string meter = table.text_or("meter", "");
    const NumberRange range{0.0, kLoadMax_kW};
    std::vector<double> load_kW;
    if (table.is_list("load_kW")) {
      load_kW = table.numbers("load_kW", 24, range).value_or(load_kW);
    } else if (const auto constant_kW = table.number("load_kW", range)) {
      load_kW = {*constant_kW};
    }
    if (recording.empty() == load_kW.empty() || recording.empty() != meter.empty()) {
      table.problem("a device needs either load_kW or recording and meter");
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
      table.problem(load.error().message);
    }
    return known;
  }

  static std::shared_ptr<const LoadShape> shared(LoadShape load) {
    return std::make_shared<const LoadShape>(std::move(load));
  }

  std::filesystem::path folder_;
  const FaultScript& faults_;
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const LoadShape>> recordings_;
};

}  // namespace

Result<std::vector<EndpointPlan>> read_device_plan(const std::filesystem::path& file,
                                                   const FaultScript& faults) {
  const auto table = TRY(read_toml(file, "plan"));
  Problems problems;
  auto endpoints = PlanReader{file, faults}.read(TomlReader{table, file.string(), "", problems});
  if (!problems.empty()) return failure(ErrorCode::invalid_value, problems.front());
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
