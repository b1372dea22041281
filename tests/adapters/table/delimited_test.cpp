#include "adapters/table/delimited.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace recald::table::delimited_test {
namespace {

struct Row {
  std::uint64_t number;
  std::vector<std::string> cells;
  std::string problem;
};

std::vector<Row> rows_of(std::string_view text, char separator = ',') {
  const auto source = delimited_rows(csv::bytes_of(text), separator);
  std::vector<Row> rows;
  for (TableRow row; source->next(row);) {
    rows.push_back({row.number, {row.cells.begin(), row.cells.end()}, std::string{row.problem}});
  }
  return rows;
}

using Cells = std::vector<std::string>;

TEST(Delimited, ALineBreakWithinQuotesIsABlank) {
  const auto rows = rows_of("\"Time\",\"Main meter\r\n(kW)\",\"a\n\nb\"\r\n1,2,3\r\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].cells, (Cells{"Time", "Main meter (kW)", "a  b"}));
  EXPECT_EQ(rows[0].number, 1u);
  EXPECT_EQ(rows[1].cells, (Cells{"1", "2", "3"}));
  EXPECT_EQ(rows[1].number, 5u);
}

// The lines below a stray quote are rows as before.
TEST(Delimited, AQuoteThatStaysOpenCostsItsOwnLine) {
  std::string text = "a,b\n\"1,2\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(i) + ",x\n";
  const auto rows = rows_of(text);
  ASSERT_EQ(rows.size(), 42u);
  EXPECT_FALSE(rows[1].problem.empty());
  EXPECT_EQ(rows[1].number, 2u);
  for (std::size_t i = 2; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].cells, (Cells{std::to_string(i - 2), "x"}));
    EXPECT_EQ(rows[i].number, i + 1);
  }
  EXPECT_EQ(rows_of("a\n\"b").size(), 2u);
  EXPECT_EQ(rows_of("\"b\n\"c\nd\n").size(), 3u);
}

TEST(Delimited, CellsAreFreeOfWhatIsAroundThem) {
  const auto rows = rows_of(
      "\xEF\xBB\xBF\xEF\xBB\xBFTime;=\"0123\";\"=\"\"0456\"\"\";\xC2\xA0"
      "7,5\xE2\x80\xAF; \"x\" ;y\n",
      ';');
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].cells, (Cells{"Time", "0123", "0456", "7,5", "x", "y"}));
}

TEST(Delimited, TextOfOtherMachines) {
  std::string wide;
  for (const char c : std::string{"a;b\n1;2\n"}) wide += {c, '\0'};
  EXPECT_EQ(rows_of(wide, ';').at(1).cells, (Cells{"1", "2"}));  // UTF-16 without a mark
  EXPECT_EQ(rows_of("a;b\r1;2\r3;4\r", ';').at(2).cells, (Cells{"3", "4"}));
  EXPECT_EQ(rows_of("a;b\r\n1;2\r\n", ';').size(), 2u);
}

}  // namespace
}  // namespace recald::table::delimited_test
