#include "adapters/table/cell_number.hpp"

#include <gtest/gtest.h>

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

TEST(CellNumber, AThousandMayBeAThousandth) {
  EXPECT_TRUE(possible_decimal_signs("1,234").point);
  EXPECT_TRUE(possible_decimal_signs("1,234").comma);
  EXPECT_FALSE(possible_decimal_signs("1,23").point);
  EXPECT_FALSE(possible_decimal_signs("0.5").comma);
}

}  // namespace
}  // namespace recald::table::cell_number_test
