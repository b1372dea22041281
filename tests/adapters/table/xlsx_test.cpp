#include "adapters/table/xlsx.hpp"

#include <gtest/gtest.h>

#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::table::xlsx_test {
namespace {

using recald::testing::write_workbook;

TEST(Xlsx, RowsHaveTextsDatesAndNumbers) {
  const recald::testing::TemporaryFolder folder;
  write_workbook(folder / "a.xlsx", {"Time", "Main &amp; more"},
                 {{45'292.25, {12.5}}, {45'293, {7}}});
  EXPECT_EQ(sheet_names(folder / "a.xlsx").value(), std::vector<std::string>{"Meters"});
  const auto rows = open_sheet(folder / "a.xlsx", "");
  ASSERT_TRUE(rows.has_value()) << rows.error().message;
  std::vector<std::vector<std::string>> read;
  for (TableRow row; (*rows)->next(row);) {
    EXPECT_EQ(row.number, read.size() + 1);
    read.emplace_back(row.cells.begin(), row.cells.end());
  }
  EXPECT_FALSE((*rows)->error().has_value());
  EXPECT_EQ(read, (std::vector<std::vector<std::string>>{{"Time", "Main & more"},
                                                         {"2024-01-01 06:00:00", "12.5"},
                                                         {"2024-01-02 00:00:00", "7"}}));
}

TEST(Xlsx, WhatIsNoWorkbookSaysSo) {
  const recald::testing::TemporaryFolder folder;
  recald::testing::write_text(folder / "text.xlsx", "Time,Main\n");
  const auto text = open_sheet(folder / "text.xlsx", "");
  ASSERT_FALSE(text.has_value());
  EXPECT_EQ(text.error().code, ErrorCode::malformed);
  EXPECT_NE(text.error().message.find("is not .xlsx"), std::string::npos);
  EXPECT_EQ(open_sheet(folder / "none.xlsx", "").error().code, ErrorCode::not_found);
  write_workbook(folder / "a.xlsx", {"Time"}, {});
  EXPECT_NE(open_sheet(folder / "a.xlsx", "Other").error().message.find("it has Meters"),
            std::string::npos);
}

// A workbook cut short is refused, wherever the cut is.
TEST(Xlsx, CutAnywhereItIsRefusedOrReadAsFarAsItGoes) {
  const recald::testing::TemporaryFolder folder;
  write_workbook(folder / "a.xlsx", {"Time", "Main"}, {{45'292, {12.5}}});
  const std::string whole = recald::testing::read_text(folder / "a.xlsx");
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    recald::testing::write_text(folder / "cut.xlsx", whole.substr(0, length));
    EXPECT_FALSE(open_sheet(folder / "cut.xlsx", "").has_value()) << length;
  }
}

}  // namespace
}  // namespace recald::table::xlsx_test
