#include "core/weather/sensor_quantities.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "core/absent.hpp"

namespace recald::weather::sensor_quantities_test {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using ::testing::HasSubstr;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};

// A reading's unit alone says what was measured.
TEST(SensorQuantities, EachHasAUnitOfItsOwn) {
  std::set<std::string_view> units;
  for (const SensorQuantity& quantity : kSensorQuantities) {
    EXPECT_TRUE(units.insert(quantity.unit).second) << quantity.name;
    EXPECT_EQ(find_quantity_of_unit(quantity.unit), &quantity);
    EXPECT_EQ(find_quantity(quantity.name), &quantity);
    EXPECT_THAT(quantity_units(), HasSubstr(std::string{quantity.unit} + " ("));
  }
  EXPECT_EQ(find_quantity_of_unit("kWh"), nullptr);
  EXPECT_EQ(find_quantity("dni_W_m2"), nullptr);
}

TEST(SensorQuantities, StandInOrderOfTheWeathersColumns) {
  for (std::size_t i = 0; i < kSensorQuantities.size(); ++i) {
    EXPECT_EQ(kSensorQuantities[i].name, kWeatherVariables[i].name);
    EXPECT_EQ(kSensorQuantities[i].member, kWeatherVariables[i].member);
  }
}

TEST(SensorQuantities, WhatCannotBeIsNamed) {
  const SensorQuantity& dry_bulb = kSensorQuantities[0];
  EXPECT_TRUE(is_plausible(dry_bulb, -60.0));
  EXPECT_TRUE(is_plausible(dry_bulb, 60.0));
  EXPECT_FALSE(is_plausible(dry_bulb, 60.1));
  EXPECT_FALSE(is_plausible(dry_bulb, kAbsent));
  EXPECT_TRUE(is_plausible(*find_quantity("rel_humidity_pct"), 105.0));
  EXPECT_FALSE(is_plausible(*find_quantity("ghi_W_m2"), -10.5));
  EXPECT_EQ(why_not_plausible(dry_bulb, 850.0),
            "850 degC cannot be dry_bulb_C, which lies between -60 and 60");
}

std::vector<SensorValue> quarters(int count, double value) {
  std::vector<SensorValue> values;
  for (int i = 0; i < count; ++i) values.push_back({kStart + i * minutes{15}, value});
  return values;
}

int known(const std::vector<SensorValue>& values) {
  return static_cast<int>(
      std::ranges::count_if(values, [](const auto& one) { return std::isfinite(one.value); }));
}

// Six hours of the same value may be fog; a quarter of an hour more is a frozen sensor, all along.
TEST(FrozenSensor, LongerThanSixHoursIsForgotten) {
  auto six_hours = quarters(24, 3.2);
  EXPECT_EQ(forget_frozen(six_hours, minutes{15}), 0U);
  EXPECT_EQ(known(six_hours), 24);
  auto longer = quarters(25, 3.2);
  EXPECT_EQ(forget_frozen(longer, minutes{15}), 25U);
  EXPECT_EQ(known(longer), 0);
}

// Twelve equal hours of whole degrees are a foggy day; twenty-four are none.
TEST(FrozenSensor, OfCoarseDataItTakesMoreThanSixHours) {
  const auto hourly = [](int count) {
    auto values = quarters(count, 3.0);
    for (int i = 0; i < count; ++i) values[static_cast<std::size_t>(i)].start = kStart + hours{i};
    return values;
  };
  auto foggy = hourly(23);
  EXPECT_EQ(forget_frozen(foggy, hours{1}), 0U);
  EXPECT_EQ(known(foggy), 23);
  auto frozen = hourly(24);
  EXPECT_EQ(forget_frozen(frozen, hours{1}), 24U);
}

TEST(FrozenSensor, WhatMovesOnIsLeft) {
  auto values = quarters(60, 3.2);
  for (int i = 0; i < 60; ++i) values[static_cast<std::size_t>(i)].value += i < 20 ? 0.1 * i : 0.0;
  EXPECT_EQ(forget_frozen(values, minutes{15}), 40U);
  EXPECT_EQ(known(values), 20);
}

// The mean of equal samples differs in its last bits.
TEST(FrozenSensor, RoundingIsNoMovement) {
  auto values = quarters(30, 21.3);
  for (std::size_t i = 0; i < values.size(); i += 2) values[i].value += 4e-15;
  EXPECT_EQ(forget_frozen(values, minutes{15}), 30U);
}

TEST(FrozenSensor, AHoleEndsARun) {
  auto values = quarters(40, 3.2);
  for (std::size_t i = 20; i < values.size(); ++i) values[i].start += hours{1};
  EXPECT_EQ(forget_frozen(values, minutes{15}), 0U);
}

}  // namespace
}  // namespace recald::weather::sensor_quantities_test
