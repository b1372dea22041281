#include "adapters/table/cells/header_units.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace recald::table::header_units_test {
namespace {

TEST(HeaderUnits, StandInManyPlaces) {
  for (const auto& [header, name, unit] :
       std::vector<std::tuple<const char*, const char*, const char*>>{
           {"Main (kWh)", "Main", "kWh"},
           {"Main [kWh]", "Main", "kWh"},
           {"Main {kWh}", "Main", "kWh"},
           {"Main_kWh", "Main", "kWh"},
           {"main.kwh", "main", "kwh"},
           {"Main, ton-hours", "Main", "ton-hours"},
           {"Main / kWh", "Main", "kWh"},
           {"Main|kWh", "Main", "kWh"},
           {"kW", "", "kW"},
           {"(kWh) Main", "Main", "kWh"},
           {"kWh delivered", "delivered", "kWh"},
           {"import_kWh_total", "import total", "kWh"},
           {"Value (kW-hr)", "Value", "kW-hr"},
           {"Usage(Real energy in kilowatt-hours)", "Usage", "kilowatt-hours"},
           {"Verbrauch in kWh", "Verbrauch", "kWh"},
           {"Verbrauch (Kilowattstunden)", "Verbrauch", "Kilowattstunden"},
           {"Consumo (kilovatios-hora)", "Consumo", "kilovatios-hora"},
           {"Consumo registado, Ativa (kW)", "Consumo registado, Ativa", "kW"},
           {"Gas (m\xC2\xB3)", "Gas", "m\xC2\xB3"},
           {"Meter 12345 (kWh)", "Meter 12345", "kWh"},
           {"AHU 2 kWh", "AHU 2", "kWh"},
           {"power_W", "power", "W"},
           {"Main (east) (kW)", "Main (east)", "kW"},
       }) {
    EXPECT_EQ(split_unit(header).name, name) << header;
    EXPECT_EQ(split_unit(header).unit, unit) << header;
  }
}

// A price for each kWh, a factor, a wing of the building: a unit that would be wrong.
TEST(HeaderUnits, WhatOnlyLooksLikeOneIsNone) {
  for (const char* header :
       {"Wing W", "Main (east)", "Price per kWh", "ct/kWh", "EUR / kWh", "Preis (ct/kWh)",
        "cost_kWh", "Energy (kWh/m2)", "kg CO2 per kWh", "100 kWh", "Main (x10 kWh)",
        "Main (100 kWh)", "kWh x 100", "kWh*10", "today_mwh", "Prix kWh"}) {
    EXPECT_EQ(split_unit(header).unit, "") << header;
  }
}

TEST(HeaderUnits, RowsAboveATableSayThem) {
  const auto said = [](std::vector<std::string> cells) { return unit_said(cells); };
  EXPECT_EQ(said({"Einheit: kWh"}), "kWh");
  EXPECT_EQ(said({"Einheit", "kWh", ""}), "kWh");
  EXPECT_EQ(said({"Unit\xC3\xA9", "W"}), "W");
  EXPECT_EQ(said({"Units", "[MWh]"}), "MWh");
  EXPECT_EQ(said({"Messwerte in kW"}), "kW");
  EXPECT_EQ(said({"Valeurs en kWh"}), "kWh");
  EXPECT_EQ(said({"Load profile (kWh)"}), "kWh");
  EXPECT_EQ(said({"Contracted power 90 kW"}), "");
  EXPECT_EQ(said({"Building", "W"}), "");
  EXPECT_EQ(said({"Total", "1234"}), "");
}

// Any name, any unit, any way to put the one behind the other.
TEST(HeaderUnits, ComeBackFromAnyForm) {
  const std::vector<std::string> names{"Main",     "Z\xC3\xA4hler Ost", "AHU-1",   "L1",
                                       "Compteur", "Energy delivered",  "Gebouw 3"};
  const std::vector<std::string> units{"kWh", "kW",   "MWh",    "Wh",
                                       "GJ",  "kBtu", "therms", "kilowatt hours"};
  const std::vector<std::pair<std::string, std::string>> forms{
      {" (", ")"},  {" [", "]"}, {" {", "}"}, {"\n(", ")"},
      {" in ", ""}, {" - ", ""}, {"_", ""},   {", ", ""}};
  for (const std::string& name : names) {
    for (const std::string& unit : units) {
      for (const auto& [before, behind] : forms) {
        const std::string header = name + before + unit + behind;
        EXPECT_EQ(split_unit(header).unit, unit) << header;
        EXPECT_EQ(split_unit(header).name, name) << header;
      }
    }
  }
}

TEST(HeaderUnits, UnitsOfOtherQuantities) {
  for (const char* unit : {"kvarh", "kvar", "V", "A", "Hz",
                           "\xC2\xB0"
                           "C",
                           "EUR", "kgCO2", "%", "kVA"}) {
    EXPECT_TRUE(is_unit_of_others(unit)) << unit;
  }
  for (const char* unit : {"kWh", "W", "therm", "", "Register", "F1"}) {
    EXPECT_FALSE(is_unit_of_others(unit)) << unit;
  }
}

}  // namespace
}  // namespace recald::table::header_units_test
