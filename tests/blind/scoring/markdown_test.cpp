#include "tests/blind/scoring/markdown.hpp"

#include <gtest/gtest.h>

namespace recald::blind {
namespace {

TEST(Markdown, ATableHasItsRowsAndABlankLine) {
  MarkdownTable table({"a", "b"});
  EXPECT_EQ(table.text(), "");
  table.add({"1", "2"});
  EXPECT_EQ(table.text(), "| a | b |\n| --- | --- |\n| 1 | 2 |\n\n");
}

// A unit or a version is free text and may hold what would end a cell.
TEST(Markdown, BarsAndLineEndsStayInsideTheirCell) {
  MarkdownTable table({"unit"});
  table.add({"kW | h\nx"});
  EXPECT_EQ(table.text(), "| unit |\n| --- |\n| kW \\| h x |\n\n");
}

TEST(Markdown, SharesAreWholePerCentsUnlessThatWouldMislead) {
  EXPECT_EQ(share_cell(share_score(45, 60)), "45 of 60: 75 % (62 to 85)");
  EXPECT_EQ(share_cell(share_score(0, 60)), "0 of 60: 0 % (0 to 6)");
  EXPECT_EQ(share_cell(share_score(38, 40)), "38 of 40: 95 % (83 to 99.4)");
  EXPECT_EQ(share_cell(std::nullopt), "-");
  EXPECT_EQ(share_cell(Score{.value = 0.25, .cases = 3}), "25 %");
}

TEST(Markdown, FiguresCarryTheirIntervalOrTheirNumber) {
  EXPECT_EQ(number_cell(Score{.value = 0.625, .cases = 9, .interval = Interval{0.41, 0.8}}, 3),
            "0.625 (0.410 to 0.800)");
  EXPECT_EQ(number_cell(Score{.value = 0.5, .cases = 3}), "0.50 (n = 3)");
  EXPECT_EQ(number_cell(std::nullopt), "-");
}

}  // namespace
}  // namespace recald::blind
