#include "adapters/table/cells/cell_number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace recald::table::cell_number_test {
namespace {

TEST(CellNumber, DecimalPointWithOrWithoutThousands) {
  EXPECT_EQ(parse_cell("12.5", '.'), 12.5);
  EXPECT_EQ(parse_cell("-0.25", '.'), -0.25);
  EXPECT_EQ(parse_cell("+7", '.'), 7.0);
  EXPECT_EQ(parse_cell("1,234.5", '.'), 1234.5);
  EXPECT_EQ(parse_cell("1,234,567", '.'), 1234567.0);
  EXPECT_EQ(parse_cell("1'234.5", '.'), 1234.5);
  EXPECT_EQ(parse_cell(".5", '.'), 0.5);
  EXPECT_EQ(parse_cell("1.5e3", '.'), 1500.0);
}

TEST(CellNumber, DecimalCommaWithOrWithoutThousands) {
  EXPECT_EQ(parse_cell("12,5", ','), 12.5);
  EXPECT_EQ(parse_cell("1.234,5", ','), 1234.5);
  EXPECT_EQ(parse_cell("1 234,5", ','), 1234.5);
  EXPECT_EQ(parse_cell("1\xC2\xA0"
                       "234,5",
                       ','),
            1234.5);
  EXPECT_EQ(parse_cell("-0,125", ','), -0.125);
  EXPECT_EQ(parse_cell("1,5E-2", ','), 0.015);
}

TEST(CellNumber, SignsInOtherPlacesAreNoNumbers) {
  for (const char* cell : {"12,5", "0,125", "1,2345", ",5", "1,23,4", "1.2.3", "12.5 kWh", "", "-",
                           "1e", "--1", "0x1F", "1,234,56"}) {
    EXPECT_FALSE(parse_cell(cell, '.').has_value()) << cell;
  }
  EXPECT_FALSE(parse_cell("12.5", ',').has_value());
  EXPECT_FALSE(parse_cell("1e999", '.').has_value());
}

TEST(CellNumber, BlanksAreWordsForNothing) {
  for (const char* cell : {"", "-", "n/a", "NaN", "NULL", "#N/A", "no data"}) {
    EXPECT_TRUE(is_blank(cell)) << cell;
  }
  for (const char* cell : {"0", "-1", "nano", "off"}) EXPECT_FALSE(is_blank(cell)) << cell;
}

// Any number, any sign of thousands, any unit behind it.
TEST(CellNumber, ComesBackFromAnyForm) {
  const std::vector<std::string> groups{"", " ", "\xC2\xA0", "\xE2\x80\xAF", "'", "\xE2\x80\x99"};
  const std::vector<std::string> units{"", "kWh", "W", "m\xC2\xB3", "kilowatt hours"};
  for (const char decimal : {'.', ','}) {
    for (const std::string& group : groups) {
      for (const double value : {0.0, 0.125, 7.5, 987.0, 1234.5, 1234567.25, -1234.5}) {
        std::string whole = std::to_string(static_cast<long>(std::abs(value)));
        for (int at = static_cast<int>(whole.size()) - 3; at > 0; at -= 3) {
          whole.insert(static_cast<std::size_t>(at), group);
        }
        const auto thousandths = static_cast<int>(std::lround(std::abs(value) * 1000.0)) % 1000;
        std::string text = (value < 0.0 ? "-" : "") + whole;
        if (thousandths > 0) text += decimal + std::to_string(1000 + thousandths).substr(1);
        EXPECT_EQ(parse_cell(text, decimal), value) << text;
        for (const std::string& unit : units) {
          for (const std::string blank : {" ", "", "\xC2\xA0"}) {
            const std::string cell = unit.empty() ? text : text + blank + unit;
            EXPECT_EQ(parse_cell(split_number(cell).number, decimal), value) << cell;
            EXPECT_EQ(split_number(cell).unit, unit) << cell;
          }
        }
      }
    }
  }
  EXPECT_EQ(parse_cell("\xE2\x88\x92"
                       "12.5",
                       '.'),
            -12.5);
  EXPECT_EQ(split_number("1.5e-3 kWh").number, "1.5e-3");
  EXPECT_EQ(split_number("kWh").number, "");
}

TEST(CellNumber, ARefusalNamesTheSignThatWouldDo) {
  EXPECT_EQ(cell_problem("1.234,5", '.'),
            "'1.234,5' is no number with a decimal point; it is one with a decimal comma");
  EXPECT_EQ(cell_problem("many", '.'),
            "'many' is no number with a decimal point; leave the cell blank where nothing was "
            "measured");
}

TEST(CellNumber, AThousandMayBeAThousandth) {
  EXPECT_TRUE(possible_decimal_signs("1,234").point);
  EXPECT_TRUE(possible_decimal_signs("1,234").comma);
  EXPECT_FALSE(possible_decimal_signs("1,23").point);
  EXPECT_FALSE(possible_decimal_signs("0.5").comma);
}

}  // namespace
}  // namespace recald::table::cell_number_test
