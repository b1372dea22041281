/// Simulated devices against the daemon's maps: two descriptions of the same documents, written
/// apart, must agree.
#include "simulators/devices/device_registers.hpp"

#include <gmock/gmock.h>

#include "daemon/site/config/register_map_file.hpp"

namespace recald::simulators::device_registers_test {
namespace {

using ::testing::ElementsAre;

/// What the daemon reads from a simulated device: its energy and its power, in the maps' units.
std::map<std::string, double> read_by_map(const DeviceLayout& layout, const MeterReadout& readout) {
  const auto map = daemon::find_register_map(std::string{layout.name}, ".");
  EXPECT_TRUE(map.has_value());
  EXPECT_EQ(static_cast<int>(map->function), layout.function);
  const auto fields = metered_fields(*map);
  std::map<std::string, double> values;
  const auto reads = plan_reads(fields, map->function, map->limits);
  for (const auto& read : *reads) {
    const auto registers = registers_of(layout, readout, read.address, read.count);
    EXPECT_TRUE(registers.has_value()) << layout.name << " " << read.address << " " << read.count;
    if (!registers) continue;
    for (const auto& found : decode_read(fields, read, *registers)) {
      EXPECT_TRUE(found.value.has_value()) << fields[found.field].name;
      const double to_kilo = fields[found.field].unit.starts_with('k') ? 1.0 : 1e-3;
      if (found.value) values[fields[found.field].name] = found.value->value * to_kilo;
    }
  }
  return values;
}

TEST(SimulatedDevices, AreReadByTheMapsOfTheirNames) {
  EXPECT_EQ(layouts().size(), 6u);
  for (const DeviceLayout& layout : layouts()) {
    SCOPED_TRACE(std::string{layout.name});
    const auto map = daemon::find_register_map(std::string{layout.name}, ".");
    const auto values = read_by_map(layout, {123'456.75, 87.5, 1});
    double energy_kWh = 0.0;
    for (const std::string& field : map->energy) energy_kWh += values.at(field);
    EXPECT_NEAR(energy_kWh, 123'456.75, 1.0);  // a Belimo counts whole kWh
    EXPECT_NEAR(values.at(*map->power), 87.5, 1e-3);
  }
}

TEST(SimulatedDevices, SignedPowerIsSigned) {
  const auto values = read_by_map(*find_layout("abb-b23"), {0.0, -2.0, 1});
  EXPECT_NEAR(values.at("power"), -2.0, 1e-6);
}

TEST(SimulatedDevices, OutsideItsRegistersThereIsNothing) {
  const DeviceLayout& device = *find_layout("abb-b23");
  EXPECT_THAT(*registers_of(device, {1000.0, 0.0, 1}, 0x5000, 4), ElementsAre(0, 0, 1, 0x86A0));
  EXPECT_FALSE(registers_of(device, {}, 0x4FFF, 4).has_value());
  EXPECT_FALSE(registers_of(device, {}, 0x5B14, 3).has_value());
  EXPECT_EQ(find_layout("abb-b99"), nullptr);
}

}  // namespace
}  // namespace recald::simulators::device_registers_test
