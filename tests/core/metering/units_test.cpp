#include "core/metering/units.hpp"

#include <gtest/gtest.h>

namespace recald::metering::units_test {
namespace {

using std::chrono::seconds;

double mean_kW(std::string_view unit, double value, Utility utility = Utility::electricity,
               seconds interval = seconds{900}, const UnitFactors& factors = {}) {
  const auto conversion = find_unit(unit, utility, factors);
  EXPECT_TRUE(conversion.has_value()) << unit;
  return conversion ? conversion->mean_kW(value, interval) : 0.0;
}

TEST(Units, PowerIsTheMeanWhateverTheInterval) {
  EXPECT_DOUBLE_EQ(mean_kW("W", 1500.0), 1.5);
  EXPECT_DOUBLE_EQ(mean_kW("kW", 7.0, Utility::electricity, seconds{3600}), 7.0);
  EXPECT_DOUBLE_EQ(mean_kW("MW", 0.2), 200.0);
}

TEST(Units, EnergyOfAQuarterHourIsFourTimesAsManyKilowatts) {
  EXPECT_DOUBLE_EQ(mean_kW("kWh", 2.5), 10.0);
  EXPECT_DOUBLE_EQ(mean_kW("kWh", 2.5, Utility::electricity, seconds{3600}), 2.5);
  EXPECT_DOUBLE_EQ(mean_kW("Wh", 2500.0), 10.0);
  EXPECT_DOUBLE_EQ(mean_kW("MWh", 0.0025), 10.0);
}

// ASHRAE Fundamentals, chapter "Units and Conversions": 1 BTU(IT) = 1055.056 J, 1 ton of
// refrigeration = 12 000 BTU/h = 3.516853 kW, 1 therm = 105.5056 MJ.
TEST(Units, BritishThermalUnitsAndTons) {
  EXPECT_NEAR(mean_kW("kBtu/h", 1.0), 0.293071, 5e-7);
  EXPECT_NEAR(mean_kW("kBtu", 1.0, Utility::gas, seconds{3600}), 0.293071, 5e-7);
  EXPECT_NEAR(mean_kW("BTU/h", 12'000.0), 3.516853, 5e-7);
  EXPECT_NEAR(mean_kW("ton", 1.0, Utility::chilled_water), 3.516853, 5e-7);
  EXPECT_NEAR(mean_kW("ton-hour", 1.0, Utility::chilled_water), 4.0 * 3.516853, 2e-6);
  EXPECT_NEAR(mean_kW("therm", 1.0, Utility::gas, seconds{3600}), 29.30711, 5e-6);
  EXPECT_NEAR(mean_kW("MBtu", 1.0, Utility::gas, seconds{3600}), 293.0711, 5e-5);
  EXPECT_NEAR(mean_kW("MBH", 1.0), 0.293071, 5e-7);
}

TEST(Units, SteamMassTakesTheSitesEnthalpy) {
  EXPECT_NEAR(mean_kW("lb", 1000.0, Utility::steam, seconds{3600}), 305.0, 1e-9);
  UnitFactors factors;
  factors.steam_kWh_per_kg = 0.7;
  EXPECT_DOUBLE_EQ(mean_kW("kg", 10.0, Utility::steam, seconds{3600}, factors), 7.0);
}

TEST(Units, GasVolumeNeedsItsHeatingValue) {
  UnitFactors factors;
  factors.gas_kWh_per_m3 = 11.2;
  EXPECT_DOUBLE_EQ(mean_kW("m3", 10.0, Utility::gas, seconds{3600}, factors), 112.0);
  const auto without = find_unit("m3", Utility::gas, {});
  ASSERT_FALSE(without.has_value());
  EXPECT_EQ(without.error().code, ErrorCode::unsupported);
  EXPECT_NE(without.error().message.find("heating value"), std::string::npos);
}

// 1 lb = 0.45359237 kg, 1 ft3 = 0.028316846592 m3, 1 ton-day = 24 ton-hours: by definition.
TEST(Units, AsPeopleWriteThem) {
  const seconds hour{3600};
  for (const char* unit : {"lbs", "pounds", "LB"}) {
    EXPECT_NEAR(mean_kW(unit, 1000.0, Utility::steam, hour), 305.0, 1e-9) << unit;
  }
  EXPECT_NEAR(mean_kW("klb", 1.0, Utility::steam, hour), 305.0, 1e-9);
  EXPECT_NEAR(mean_kW("klbs/hr", 1.0, Utility::steam), 305.0, 1e-9);
  EXPECT_NEAR(mean_kW("tonnes", 1.0, Utility::steam, hour), 305.0 / 0.45359237, 1e-9);
  for (const char* unit : {"ton-hours", "Ton Hours", "tonhrs", "ton-hr", "TRh", "RTh"}) {
    EXPECT_NEAR(mean_kW(unit, 1.0, Utility::chilled_water, hour), 3.516853, 5e-7) << unit;
  }
  EXPECT_NEAR(mean_kW("ton-days", 1.0, Utility::chilled_water, hour), 24.0 * 3.516853, 1e-5);
  EXPECT_NEAR(mean_kW("tons", 1.0, Utility::chilled_water), 3.516853, 5e-7);
  EXPECT_NEAR(mean_kW("therms", 1.0, Utility::gas, hour), 29.30711, 5e-6);
  EXPECT_NEAR(mean_kW("Dth", 1.0, Utility::gas, hour), 293.0711, 5e-5);
  EXPECT_NEAR(mean_kW("MMBTU/hr", 1.0, Utility::heating), 293.0711, 5e-5);
  EXPECT_NEAR(mean_kW("BTUH", 12'000.0, Utility::chilled_water), 3.516853, 5e-7);
  EXPECT_DOUBLE_EQ(mean_kW("kWh/h", 7.0), 7.0);
  EXPECT_NEAR(mean_kW("GJ", 3.6, Utility::heating, hour), 1000.0, 1e-9);
  EXPECT_NEAR(mean_kW("Gcal", 1.0, Utility::heating, hour), 1163.0, 1e-9);
}

TEST(Units, VolumesOfGasInMetresAndFeet) {
  UnitFactors factors;
  factors.gas_kWh_per_m3 = 10.0;
  const auto hourly_kW = [&](const char* unit) {
    return mean_kW(unit, 1.0, Utility::gas, seconds{3600}, factors);
  };
  for (const char* unit : {"m3", "m\xC2\xB3", "m^3", "cbm", "Nm3"}) {
    EXPECT_DOUBLE_EQ(hourly_kW(unit), 10.0) << unit;
  }
  EXPECT_NEAR(hourly_kW("CCF"), 28.316846592, 1e-9);
  EXPECT_NEAR(hourly_kW("MCF"), 283.16846592, 1e-9);
  EXPECT_NEAR(hourly_kW("ft\xC2\xB3"), 0.28316846592, 1e-9);
  const auto without = find_unit("CCF", Utility::gas, {});
  ASSERT_FALSE(without.has_value());
  EXPECT_NE(without.error().message.find("gas_kWh_per_m3"), std::string::npos);
}

TEST(Units, CaseDoesNotMatterButMilliIsNotMega) {
  EXPECT_DOUBLE_EQ(mean_kW("KWH", 1.0, Utility::electricity, seconds{3600}), 1.0);
  EXPECT_NEAR(mean_kW("kBTU/h", 1.0), 0.293071, 5e-7);
  const auto milli = find_unit("mWh", Utility::electricity, {});
  ASSERT_FALSE(milli.has_value());
  EXPECT_NE(milli.error().message.find("milli"), std::string::npos);
}

TEST(Units, WhatIsNotEnergySaysWhatToDo) {
  const auto flow = find_unit("l/s", Utility::chilled_water, {});
  ASSERT_FALSE(flow.has_value());
  EXPECT_EQ(flow.error().code, ErrorCode::unsupported);
  EXPECT_NE(flow.error().message.find("temperature difference"), std::string::npos);
  EXPECT_FALSE(find_unit("m3", Utility::water, {}).has_value());
  EXPECT_EQ(find_unit("kg", Utility::gas, {}).error().code, ErrorCode::invalid_value);
  const auto unknown = find_unit("kvarh", Utility::electricity, {});
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().code, ErrorCode::invalid_value);
  EXPECT_NE(unknown.error().message.find("'kvarh'"), std::string::npos);
  EXPECT_FALSE(find_unit("", Utility::electricity, {}).has_value());
}

TEST(Units, AMessageHasNoControlCharactersOfAUnit) {
  const auto unknown = find_unit("kW\x7Fh", Utility::electricity, {});
  ASSERT_FALSE(unknown.has_value());
  EXPECT_NE(unknown.error().message.find("'kW\\x7Fh'"), std::string::npos)
      << unknown.error().message;
}

}  // namespace
}  // namespace recald::metering::units_test
