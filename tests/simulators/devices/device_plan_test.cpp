#include "simulators/devices/device_plan.hpp"

#include <gmock/gmock.h>

#include <set>
#include <span>

#include "tests/support/temporary_folder.hpp"

namespace recald::simulators::device_plan_test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr SimulatedTime kNoon = std::chrono::sys_days{2026y / 1 / 30} + 12h;

class DevicePlan : public ::testing::Test {
 protected:
  Result<std::vector<EndpointPlan>> read(const std::string& text, const FaultScript& faults = {}) {
    recald::testing::write_text(folder_ / "plan.toml", text);
    return read_device_plan(folder_ / "plan.toml", faults);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(DevicePlan, SaysWhatStandsWhere) {
  recald::testing::write_text(folder_ / "own.faults", "1m..2m all silent\n");
  recald::testing::write_text(folder_ / "readings.csv",
                              "timestamp,meter,value,unit\n2026-01-30T12:00:00Z,main,40,kW\n"
                              "2026-01-30T12:15:00Z,main,50,kW\n");
  const auto plan = read(R"([[endpoint]]
port = 1502
single_connection = true
[[endpoint.device]]
unit = 7
layout = "abb-b23"
load_kW = [1,1,1,1,1,1,1,1,1,1,1,1,9,1,1,1,1,1,1,1,1,1,1,1]
start_kWh = 20.5
[[endpoint]]
type = "rtu"
link = "line"
faults = "own.faults"
[[endpoint.device]]
unit = 1
layout = "eastron-sdm630"
recording = "readings.csv"
meter = "main"
)",
                         parse_fault_script("1m..2m all refuse\n3m..4m all refuse").value());
  ASSERT_TRUE(plan.has_value()) << plan.error().message;
  ASSERT_THAT(*plan, SizeIs(2));
  const EndpointPlan& tcp = plan->at(0);
  EXPECT_EQ(tcp.transport, Transport::tcp);
  EXPECT_EQ(tcp.port, 1502);
  EXPECT_TRUE(tcp.single_connection);
  EXPECT_THAT(tcp.faults.faults, SizeIs(2));
  ASSERT_THAT(tcp.devices, SizeIs(1));
  EXPECT_EQ(tcp.devices[0].unit, 7);
  EXPECT_EQ(tcp.devices[0].layout->name, "abb-b23");
  EXPECT_EQ(tcp.devices[0].start_kWh, 20.5);
  EXPECT_EQ(tcp.devices[0].load->power_kW(kNoon), 9.0);
  const EndpointPlan& line = plan->at(1);
  EXPECT_EQ(line.transport, Transport::rtu);
  EXPECT_EQ(line.link, folder_ / "line");
  EXPECT_THAT(line.faults.faults, SizeIs(1));
  EXPECT_EQ(line.devices.at(0).load->power_kW(kNoon + 15min), 50.0);
}

TEST_F(DevicePlan, CopiesHaveTheirOwnPortUnitAndCounter) {
  const auto plan = read(R"([[endpoint]]
port = 20000
repeat = 250
[[endpoint.device]]
unit = 1
repeat = 4
layout = "abb-b23"
load_kW = 5
[[endpoint]]
type = "rtu"
link = "line"
repeat = 8
[[endpoint.device]]
unit = 9
layout = "abb-b23"
load_kW = 5
)");
  ASSERT_TRUE(plan.has_value()) << plan.error().message;
  ASSERT_THAT(*plan, SizeIs(258));
  EXPECT_EQ(plan->at(249).port, 20'249);
  ASSERT_THAT(plan->at(249).devices, SizeIs(4));
  EXPECT_EQ(plan->at(249).devices[3].unit, 4);
  EXPECT_EQ(plan->at(257).link.filename(), "line7");
  std::set<double> starts;
  for (const EndpointPlan& endpoint : std::span{*plan}.first(250)) {
    for (const SimulatedDevice& device : endpoint.devices) starts.insert(device.start_kWh);
  }
  EXPECT_THAT(starts, SizeIs(1000));
}

TEST_F(DevicePlan, TheFirstMistakeIsNamed) {
  recald::testing::write_text(folder_ / "wrong.faults", "1m..2m all sleepy\n");
  const std::string device = "[[endpoint.device]]\nunit = 1\nlayout = \"abb-b23\"\nload_kW = 5\n";
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"", "plan.toml:1: there is no [[endpoint]]"},
      {"[[endpoint]\n", "plan.toml:1: not valid TOML"},
      {"endpoint = 3\n", ":1: 'endpoint' must be a list of tables, each headed [[endpoint]]"},
      {"[[endpoint]]\n" + device + "[[endpiont]]\n",
       "unknown key 'endpiont'; did you mean 'endpoint'?"},
      {"[[endpoint]]\n", ":1: [endpoint] there is no [[endpoint.device]]"},
      {"[[endpoint]]\ntype = \"udp\"\n" + device,
       ":2: [endpoint] 'type' is \"udp\"; it must be one of tcp, rtu"},
      {"[[endpoint]]\nport = 70000\n" + device,
       ":2: [endpoint] 'port' is 70000; it must be between 0 and 65535"},
      {"[[endpoint]]\nport = 65000\nrepeat = 600\n" + device,
       ":2: [endpoint] 'port' is 65000; it must be between 0 and 64936"},
      {"[[endpoint]]\nlink = \"x\"\n" + device, ":2: [endpoint] unknown key 'link'"},
      {"[[endpoint]]\ntype = \"rtu\"\n" + device, ":1: [endpoint] 'link' is missing"},
      {"[[endpoint]]\nsingle_connection = 1\n" + device,
       ":2: [endpoint] 'single_connection' must be true or false"},
      {"[[endpoint]]\nfaults = \"wrong.faults\"\n" + device, "wrong.faults: line 1: 'sleepy'"},
      {"[[endpoint]]\nfaults = \"none.faults\"\n" + device, "cannot read the fault script"},
      {"[[endpoint]]\n" + device + device, ":6: [endpoint.device] two devices with unit 1"},
      {"[[endpoint]]\n" + device + "repeat = 300\n",
       ":6: [endpoint.device] 'repeat' is 300; it must be"},
      {"[[endpoint]]\n" + device + "start_kWh = -1\n",
       ":6: [endpoint.device] 'start_kWh' is -1; it must be"},
      {"[[endpoint]]\n" + device + "colour = 1\n", ":6: [endpoint.device] unknown key 'colour'"},
      {"[[endpoint]]\n" + device + "recording = \"r.csv\"\n",
       ":2: [endpoint.device] a device needs either load_kW"},
      {"[[endpoint]]\n[[endpoint.device]]\nunit = 1\nlayout = \"abb-b23\"\nrecording = \"r.csv\"\n"
       "meter = \"main\"\n",
       "cannot read the recording"},
      {"[[endpoint]]\n[[endpoint.device]]\nunit = 1\nlayout = \"abb-b23\"\nload_kW = [1, 2]\n",
       ":5: [endpoint.device] 'load_kW' must be a list of 24 numbers"},
      {"[[endpoint]]\n[[endpoint.device]]\nunit = 1\nlayout = \"abb-b99\"\nload_kW = 5\n",
       ":2: [endpoint.device] layout \"abb-b99\" is not known; there are abb-b23, "},
      {"[[endpoint]]\n[[endpoint.device]]\nlayout = \"abb-b23\"\nload_kW = 5\n",
       ":2: [endpoint.device] 'unit' is missing"},
  };
  for (const auto& [text, said] : wrong) {
    const auto plan = read(text);
    ASSERT_FALSE(plan.has_value()) << text;
    EXPECT_THAT(plan.error().message, HasSubstr(said)) << text;
  }
  EXPECT_THAT(read_device_plan(folder_ / "none.toml", {}).error().message,
              HasSubstr("cannot read the plan"));
}

}  // namespace
}  // namespace recald::simulators::device_plan_test
