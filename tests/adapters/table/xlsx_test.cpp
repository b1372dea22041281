#include "adapters/table/xlsx.hpp"

#include <gtest/gtest.h>

#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/zip_file.hpp"

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

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// A workbook whose parts are given, where they are not the usual ones.
std::filesystem::path workbook_of(const recald::testing::TemporaryFolder& folder,
                                  std::map<std::string, std::string> parts) {
  parts.emplace("xl/workbook.xml",
                "<workbook><sheets><sheet name=\"S\" r:id=\"a\"/></sheets></workbook>");
  parts.emplace("xl/_rels/workbook.xml.rels",
                "<Relationships><Relationship Id=\"a\" Target=\"s.xml\"/></Relationships>");
  parts.emplace("xl/s.xml",
                "<worksheet><sheetData><row r=\"1\"><c t=\"s\"><v>0</v></c><c t=\"s\">"
                "<v>1</v></c></row></sheetData></worksheet>");
  recald::testing::write_zip(folder / "a.xlsx", parts);
  return folder / "a.xlsx";
}

std::vector<std::string> first_row(const std::filesystem::path& file) {
  const auto rows = open_sheet(file, "");
  if (!rows) return {rows.error().message};
  TableRow row;
  if (!(*rows)->next(row)) return {};
  return {row.cells.begin(), row.cells.end()};
}

// Half a million elements in each other are 15 kB of a file.
TEST(Xlsx, ATextMayLieAsDeepAsItLikes) {
  const recald::testing::TemporaryFolder folder;
  constexpr int kDeep = 500'000;
  const std::string deep = repeated("<r>", kDeep) + "<t>x</t>" + repeated("</r>", kDeep);
  EXPECT_EQ(
      first_row(workbook_of(folder, {{"xl/sharedStrings.xml",
                                      "<sst><si>" + deep +
                                          "</si><si><t>a</t><rPh><t>no</t></rPh><r><t>b</t></r>"
                                          "</si></sst>"}})),
      (std::vector<std::string>{"x", "ab"}));
  EXPECT_EQ(first_row(workbook_of(folder, {{"xl/s.xml",
                                            "<worksheet><sheetData><row r=\"1\"><c "
                                            "t=\"inlineStr\"><is>" +
                                                deep +
                                                "</is></c></row></sheetData>"
                                                "</worksheet>"}})),
            std::vector<std::string>{"x"});
}

// As each of the sheets with each of the relations, and each of the styles with each of the
// formats.
TEST(Xlsx, WhatAFileHasManyOfIsGoneThroughOnce) {
  const recald::testing::TemporaryFolder folder;
  constexpr int kMany = 100'000;
  const std::string texts = "<sst><si><t>x</t></si><si><t>y</t></si></sst>";
  EXPECT_EQ(
      first_row(workbook_of(
          folder,
          {{"xl/workbook.xml", "<workbook><sheets><sheet name=\"S\" r:id=\"a\"/>" +
                                   repeated("<sheet name=\"t\" r:id=\"zz\"/>", kMany) +
                                   "</sheets></workbook>"},
           {"xl/_rels/workbook.xml.rels",
            "<Relationships><Relationship Id=\"a\" Target=\"s.xml\"/>" +
                repeated("<Relationship Id=\"q\" Target=\"t\"/>", kMany) + "</Relationships>"},
           {"xl/sharedStrings.xml", texts}})),
      (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(first_row(workbook_of(
                folder, {{"xl/styles.xml",
                          "<styleSheet><numFmts>" +
                              repeated("<numFmt numFmtId=\"9999\" formatCode=\"0\"/>", kMany) +
                              "</numFmts><cellXfs>" + repeated("<xf numFmtId=\"1\"/>", kMany) +
                              "</cellXfs></styleSheet>"},
                         {"xl/sharedStrings.xml", texts}})),
            (std::vector<std::string>{"x", "y"}));
  const auto many = sheet_names(workbook_of(
      folder, {{"xl/workbook.xml", "<workbook><sheets>" +
                                       repeated("<sheet name=\"t\" r:id=\"a\"/>", 1'001) +
                                       "</sheets></workbook>"}}));
  ASSERT_FALSE(many.has_value());
  EXPECT_TRUE(many.error().message.ends_with("the workbook has more than 1000 sheets"));
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
