#include "simulators/devices/load_shape.hpp"

#include <gtest/gtest.h>

namespace recald::simulators::load_shape_test {
namespace {

using namespace std::chrono_literals;

constexpr SimulatedTime kMidnight = std::chrono::sys_days{2026y / 1 / 30};

TEST(LoadShape, ConstantLoadCountsItsHours) {
  const LoadShape load = LoadShape::constant(40.0);
  EXPECT_EQ(load.power_kW(kMidnight + 13h), 40.0);
  EXPECT_NEAR(load.energy_kWh(kMidnight + 1ms, kMidnight + 90min + 1ms), 60.0, 1e-6);
  EXPECT_NEAR(load.energy_kWh(kMidnight, kMidnight + 24h * 365), 40.0 * 8760.0, 1e-6);
}

TEST(LoadShape, DailyShapeRepeatsEachDay) {
  std::vector<double> hours(24, 10.0);
  hours[13] = 70.0;
  const LoadShape load = LoadShape::daily(hours);
  for (const int day : {-20'000, -1, 0, 3}) {
    SCOPED_TRACE(day);
    const SimulatedTime noon = kMidnight + 24h * day + 12h;
    EXPECT_EQ(load.power_kW(noon + 59min), 10.0);
    EXPECT_EQ(load.power_kW(noon + 1h), 70.0);
    EXPECT_NEAR(load.energy_kWh(noon + 30min, noon + 90min), 5.0 + 35.0, 1e-6);
    EXPECT_NEAR(load.energy_kWh(noon, noon + 24h), 300.0, 1e-6);
  }
}

TEST(LoadShape, RecordingIsPlayedOnce) {
  const LoadShape load =
      LoadShape::recorded(std::chrono::sys_days{2026y / 1 / 30}, 900s, {4.0, 8.0});
  EXPECT_EQ(load.power_kW(kMidnight - 1ms), 0.0);
  EXPECT_EQ(load.power_kW(kMidnight), 4.0);
  EXPECT_EQ(load.power_kW(kMidnight + 15min), 8.0);
  EXPECT_EQ(load.power_kW(kMidnight + 30min), 0.0);
  EXPECT_NEAR(load.energy_kWh(kMidnight, kMidnight + 20min), 1.0 + 8.0 / 12.0, 1e-12);
  EXPECT_NEAR(load.energy_kWh(kMidnight - 240h, kMidnight + 240h), 3.0, 1e-12);
  EXPECT_NEAR(load.energy_kWh(kMidnight + 20min, kMidnight), -1.0 - 8.0 / 12.0, 1e-12);
}

}  // namespace
}  // namespace recald::simulators::load_shape_test
