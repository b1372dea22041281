#include "adapters/table/containers/json_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/adapters/table/read_text.hpp"

namespace recald::table::json_rows_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

Result<std::unique_ptr<RowSource>> open(const std::string& text) {
  return json_rows([&]() -> Result<csv::ByteSource> { return csv::bytes_of(text); });
}

std::vector<std::vector<std::string>> cells_of(const std::string& text) {
  const auto rows = open(text);
  if (!rows) return {{rows.error().message}};
  std::vector<std::vector<std::string>> cells;
  for (KeptRow& row : testing::kept_rows(**rows)) cells.push_back(std::move(row.cells));
  return cells;
}

/// Of a column; as many as there are if there is none.
std::size_t place_of(const std::vector<std::vector<std::string>>& cells, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(cells[0], name) - cells[0].begin());
}

std::string refusal(const std::string& text) {
  const auto rows = open(text);
  return rows ? "read" : rows.error().message;
}

/// The same readings at the top, at a key, at one within, line by line.
TEST(JsonRows, AListOfObjectsWhereverItStands) {
  const std::string one = R"({"start": "2024-01-01T00:00:00Z", "value": 1.50})";
  const std::string other = R"({"start": "2024-01-01T00:15:00Z", "value": null})";
  const std::string list = "[" + one + ",\n " + other + "]";
  for (const std::string& text :
       {list, R"({"count": 2, "results": )" + list + "}",
        R"({"data": {"node": {"readings": )" + list + "}}, \"ok\": true}",
        one + "\n" + other + "\n", "\xEF\xBB\xBF" + list, "[" + list + "]"}) {
    SCOPED_TRACE(text);
    const auto cells = cells_of(text);
    ASSERT_THAT(cells, SizeIs(3));
    const std::size_t start = place_of(cells, "start");
    const std::size_t value = place_of(cells, "value");
    ASSERT_LT(std::max(start, value), cells[0].size());
    EXPECT_EQ(cells[1][start], "2024-01-01T00:00:00Z");
    EXPECT_EQ(cells[1][value], "1.50");
    EXPECT_EQ(cells[2][value], "");
  }
}

TEST(JsonRows, WhatStandsAroundReadingsIsTheirsToo) {
  const auto cells = cells_of(
      R"({"site": "X", "meters": [
          {"id": "A", "type": {"unit": "kWh"}, "readings": [{"t": 1, "v": {"amount": 2}}, {"t": 2, "v": {"amount": 3}}]},
          {"readings": [{"t": 1, "v": {"amount": 4}}], "id": "B", "type": {"unit": "Wh"}}], "end": 5})");
  ASSERT_THAT(cells, SizeIs(4));
  const auto column = [&](const std::string& name) { return place_of(cells, name); };
  ASSERT_LT(column("meters.id"), cells[0].size());
  EXPECT_EQ(cells[1][column("meters.id")], "A");
  EXPECT_EQ(cells[3][column("meters.id")], "B");  // though it comes behind them
  EXPECT_EQ(cells[3][column("meters.type.unit")], "Wh");
  EXPECT_EQ(cells[2][column("v.amount")], "3");
  EXPECT_EQ(cells[2][column("site")], "X");
  EXPECT_EQ(cells[1][column("t")], "1");
  EXPECT_LT(column("v.amount"), column("site"));  // what is of a reading comes first
  EXPECT_EQ(column("end"), cells[0].size());      // a number that is the same for all is idle
}

TEST(JsonRows, ListsBesideEachOtherAreColumns) {
  EXPECT_THAT(
      cells_of(
          R"({"unit": "kWh", "hourly": {"time": ["a", "b", "c"], "use": [1, 2, 3], "other": [1]}})"),
      ElementsAre(ElementsAre("time", "use", "unit"), ElementsAre("a", "1", "kWh"),
                  ElementsAre("b", "2", "kWh"), ElementsAre("c", "3", "kWh")));
}

TEST(JsonRows, PairsHaveNumberedColumns) {
  EXPECT_THAT(cells_of("[[1577836800000, 1.5], [1577836860000, 2]]"),
              ElementsAre(ElementsAre("item 1", "item 2"), ElementsAre("1577836800000", "1.5"),
                          ElementsAre("1577836860000", "2")));
  EXPECT_THAT(
      cells_of(R"({"result": [{"metric": {"name": "A"}, "values": [[1, "2"], [3, "4"]]}]})"),
      ElementsAre(ElementsAre("item 1", "item 2", "result.metric.name"), ElementsAre("1", "2", "A"),
                  ElementsAre("3", "4", "A")));
}

TEST(JsonRows, WhatIsNoListOfReadingsSaysSo) {
  EXPECT_THAT(refusal("{\"a\": 1}"), HasSubstr("no list of readings"));
  EXPECT_THAT(refusal("[1, 2, 3]"), HasSubstr("no list of readings"));
  EXPECT_THAT(refusal(""), HasSubstr("no list of readings"));
  EXPECT_THAT(refusal("[{\"a\": 1, \"b\": 2}, {\"a\": 1"), HasSubstr("no JSON"));
  EXPECT_THAT(refusal("{\"a\": [1 2]}"), HasSubstr("no JSON"));
}

TEST(JsonRows, HoweverDeepAndWideADocumentIs) {
  const std::string deep(500'000, '[');
  EXPECT_THAT(refusal(deep), HasSubstr("64 deep"));
  std::string wide = "[{\"t\": 1";
  for (int i = 0; i < 2000; ++i) wide += ", \"k" + std::to_string(i) + "\": 1";
  wide += "}, {\"t\": 2, \"v\": 3}]";
  EXPECT_THAT(refusal(wide), HasSubstr("1024 keys"));
  std::string kinds = "{";
  for (int i = 0; i < 3000; ++i) {
    kinds += (i == 0 ? "\"" : ", \"") + std::to_string(i) + "\": [{\"a\": 1, \"b\": 2}]";
  }
  EXPECT_THAT(refusal(kinds + "}"), HasSubstr("2000 different"));
}

/// Cut anywhere, it is refused or read as far as it goes.
TEST(JsonRows, CutAnywhere) {
  const std::string text =
      R"({"m": "A", "r": [{"t": 1, "v": 2.5}, {"t": 2, "v": 3}, {"t": 3, "v": 4}], "u": "kWh"})";
  for (std::size_t length = 0; length < text.size(); ++length) {
    EXPECT_FALSE(open(text.substr(0, length)).has_value()) << length;
  }
}

}  // namespace
}  // namespace recald::table::json_rows_test
