// Factors from NIST SP 811, appendix B: 1 Btu_IT = 1.055056 kJ, 1 ton of refrigeration = 3.516853
// kW, 1 ft = 0.3048 m, 1 US gallon = 3.785412 l. Six digits are given there.
#include "core/display/unit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::display {
namespace {

using metering::Utility;

void expect_ip(const char* si_unit, Utility utility, const char* name, double shown_of_100) {
  SCOPED_TRACE(si_unit);
  const Unit unit = unit_of(UnitSystem::ip, si_unit, utility);
  EXPECT_EQ(unit.name, name);
  EXPECT_NEAR(unit.shown(100.0), shown_of_100, 2e-6 * std::abs(shown_of_100));
}

TEST(DisplayUnit, IpByUtility) {
  expect_ip("kWh", Utility::electricity, "kWh", 100.0);
  expect_ip("MWh", Utility::electricity, "kWh", 100'000.0);
  expect_ip("kW", Utility::electricity, "kW", 100.0);
  expect_ip("kWh/day", Utility::chilled_water, "ton-hours/day", 100.0 / 3.516853);
  expect_ip("kW", Utility::chilled_water, "tons", 100.0 / 3.516853);
  expect_ip("kWh", Utility::heating, "MMBtu", 0.3412142);
  expect_ip("MWh", Utility::steam, "MMBtu", 341.2142);
  expect_ip("kW", Utility::steam, "MBH", 341.2142);
  expect_ip("kWh/day", Utility::gas, "therms/day", 3.412142);
}

TEST(DisplayUnit, IpOfBuildings) {
  constexpr auto any = Utility::electricity;
  expect_ip("degC", any, "°F", 212.0);
  expect_ip("K", any, "°F", 180.0);
  expect_ip("m/s", any, "mph", 223.6936);
  expect_ip("m2", any, "ft²", 1076.391);
  expect_ip("m3/s", any, "cfm", 211'888.0);
  expect_ip("m3/day", any, "gal/day", 26'417.21);
  expect_ip("W/m2", any, "W/ft²", 9.290304);
  expect_ip("W/m2K", any, "Btu/(h·ft²·°F)", 17.61102);
  expect_ip("kJ/m2K", any, "Btu/(ft²·°F)", 4.891949);
  expect_ip("person/m2", any, "persons/1,000 ft²", 9290.304);
  expect_ip("cm2/m2", any, "in²/100 ft²", 144.0);
  expect_ip("kWh/day per K", Utility::heating, "MMBtu/day per °F", 0.3412142 / 1.8);
}

TEST(DisplayUnit, ATemperatureAndADifferenceDiffer) {
  const Unit fahrenheit = unit_of(UnitSystem::ip, "degC");
  EXPECT_DOUBLE_EQ(fahrenheit.shown(20.0), 68.0);
  EXPECT_DOUBLE_EQ(fahrenheit.shown_difference(20.0), 36.0);
}

TEST(DisplayUnit, SiShowsValuesAsTheyAre) {
  for (const char* unit : {"kWh", "MWh", "kWh/day", "kWh/day per K", "kW"}) {
    const Unit si = unit_of(UnitSystem::si, unit, Utility::chilled_water);
    EXPECT_EQ(si.name, unit);
    EXPECT_EQ(si.shown(1.5), 1.5);
  }
  EXPECT_EQ(unit_of(UnitSystem::si, "degC").name, "°C");
  EXPECT_EQ(unit_of(UnitSystem::si, "m2").name, "m²");
  EXPECT_EQ(unit_of(UnitSystem::si, "-").name, "");
  EXPECT_EQ(unit_of(UnitSystem::si, "degC").shown(20.0), 20.0);
}

TEST(DisplayUnit, WhatIsNotKnownIsShownAsItIs) {
  const Unit unit = unit_of(UnitSystem::ip, "1/(m/s)^n");
  EXPECT_EQ(unit.name, "1/(m/s)^n");
  EXPECT_EQ(unit.shown(3.0), 3.0);
}

}  // namespace
}  // namespace recald::display
