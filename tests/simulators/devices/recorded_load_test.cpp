#include "simulators/devices/recorded_load.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::simulators::recorded_load_test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr SimulatedTime kBegin = std::chrono::sys_days{2021y / 1 / 1};

class RecordedLoad : public ::testing::Test {
 protected:
  Result<LoadShape> read(const std::string& lines, std::string_view meter = "main") {
    recald::testing::write_text(file(), "timestamp,meter,value,unit\n" + lines);
    return read_recorded_load(file(), meter);
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "readings.csv"; }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(RecordedLoad, TakesItsMeterInItsUnit) {
  const auto load = read(
      "2021-01-01T00:00:00Z,main,40,kW\n2021-01-01T00:00:00Z,heat,3,kWh\n"
      "2021-01-01T00:15:00Z,main,80,kW\n2021-01-01T00:15:00Z,heat,5,kWh\n");
  ASSERT_TRUE(load.has_value()) << load.error().message;
  EXPECT_EQ(load->power_kW(kBegin), 40.0);
  EXPECT_EQ(load->power_kW(kBegin + 15min), 80.0);
  const auto heat = read_recorded_load(file(), "heat");
  ASSERT_TRUE(heat.has_value()) << heat.error().message;
  EXPECT_NEAR(heat->power_kW(kBegin + 20min), 20.0, 1e-12);
  EXPECT_NEAR(heat->energy_kWh(kBegin, kBegin + 30min), 8.0, 1e-12);
}

TEST_F(RecordedLoad, AHoleGoesOnWithTheValueBefore) {
  const auto load = read(
      "2021-01-01T00:00:00Z,main,4,kW\n2021-01-01T00:15:00Z,main,,kW\n"
      "2021-01-01T01:00:00Z,main,8,kW\n");
  ASSERT_TRUE(load.has_value()) << load.error().message;
  EXPECT_EQ(load->power_kW(kBegin + 50min), 4.0);
  EXPECT_NEAR(load->energy_kWh(kBegin, kBegin + 75min), 4.0 + 2.0, 1e-12);
}

TEST_F(RecordedLoad, WhatIsWrongIsNamed) {
  const std::string first = "2021-01-01T00:00:00Z,main,4,kW\n";
  const std::vector<std::pair<std::string, std::string>> wrong{
      {first + "2021-01-01T00:15:00Z,main,4\n", "readings.csv:3: a line needs four fields"},
      {first + "2021-01-01T00:15:00Z,main,4,kW,5\n", ":3: a line needs four fields"},
      {first + "2021-01-01T00:15:00,main,4,kW\n", ":3: write a UTC stamp"},
      {first + "2021-01-01T25:15:00Z,main,4,kW\n", ":3: write a UTC stamp"},
      {first + "2021-01-01T00:15:00Z,main,4x,kW\n", ":3: write a UTC stamp"},
      {first + "2021-01-01T00:15:00Z,main,inf,kW\n", ":3: write a UTC stamp"},
      {first + first, ":3: this stamp is not later"},
      {first, "one reading of meter 'main' does not tell"},
      {first + "2021-01-01T00:15:00Z,main,4,furlong\n", "furlong"},
      {"", "there is no meter 'main'"},
  };
  for (const auto& [lines, said] : wrong) {
    const auto load = read(lines);
    ASSERT_FALSE(load.has_value()) << lines;
    EXPECT_THAT(load.error().message, HasSubstr(said)) << lines;
  }
  recald::testing::write_text(file(), "time,meter,value,unit\n");
  EXPECT_THAT(read_recorded_load(file(), "main").error().message, HasSubstr(":1: the header"));
  EXPECT_THAT(read_recorded_load(folder_ / "none.csv", "main").error().message,
              HasSubstr("cannot read the recording"));
}

}  // namespace
}  // namespace recald::simulators::recorded_load_test
