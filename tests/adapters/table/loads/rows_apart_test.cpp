#include "adapters/table/loads/rows_apart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/table/loads/named_rows.hpp"
#include "tests/adapters/table/read_text.hpp"

namespace recald::table::rows_apart_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

std::string hour(int i) {
  return metering::to_string(
      metering::Instant{std::chrono::sys_days{std::chrono::year{2024} / 3 / 4}} +
      std::chrono::hours{i});
}

std::optional<ColumnsApart> found(const std::string& text,
                                  const std::vector<std::string>& values = {"v"}) {
  const TableShape shape{.separator = ',', .time_column = "t"};
  const auto open = [&]() -> Result<std::unique_ptr<RowSource>> {
    return delimited_rows(csv::bytes_of(text), ',');
  };
  return columns_that_tell_apart(open, shape, values).value();
}

/// Rows of each combination of texts, hour by hour or one after the other.
std::string table(const std::string& header, const std::vector<std::string>& kinds,
                  bool are_one_after_another) {
  std::string text = header + "\n";
  const int hours = 60;
  const auto count = static_cast<int>(kinds.size());
  for (int i = 0; i < hours * count; ++i) {
    const int at = are_one_after_another ? i % hours : i / count;
    const std::string& kind =
        kinds[static_cast<std::size_t>(are_one_after_another ? i / hours : i % count)];
    text += hour(at) + "," + kind + "," + std::to_string(i) + "\n";
  }
  return text;
}

TEST(RowsApart, ByOneColumnWhereverItStands) {
  for (const bool after : {false, true}) {
    const auto apart = found(
        table("t,ean,kind,status,v", {"5414,use,ok", "5414,return,ok", "5414,heat,ok"}, after));
    ASSERT_TRUE(apart.has_value());
    EXPECT_THAT(apart->columns, ElementsAre("kind"));
    EXPECT_EQ(apart->groups, 3u);
  }
}

TEST(RowsApart, WordsAreBetterThanNumbers) {
  const auto apart = found(table("t,ean,kind,v", {"5414,use", "5415,return"}, true), {});
  ASSERT_TRUE(apart.has_value());
  EXPECT_THAT(apart->columns, ElementsAre("kind"));
  EXPECT_THAT(apart->alike, UnorderedElementsAre("ean", "kind"));  // but not v
}

TEST(RowsApart, BySeveralColumnsTogether) {
  for (const bool after : {false, true}) {
    const auto apart =
        found(table("t,meter,kind,v", {"A,use", "A,return", "B,use", "B,return"}, after));
    ASSERT_TRUE(apart.has_value());
    EXPECT_THAT(apart->columns, UnorderedElementsAre("meter", "kind"));
    EXPECT_EQ(apart->groups, 4u);
  }
}

/// An estimate and the value that replaced it are of one meter.
TEST(RowsApart, NotByHowAValueCameAbout) {
  EXPECT_FALSE(found(table("t,quality,v", {"estimated", "measured"}, false)).has_value());
  EXPECT_FALSE(found(table("t,day,v", {"x", "x"}, false)).has_value());
}

TEST(NamedRows, TextsOfSeveralColumnsAreOneName) {
  const std::string text = "t,meter,kind,v\n2024-01-01 00:00,A,use,1\n2024-01-01 00:00,A,,2\n";
  const TableShape shape{
      .time_column = "t", .meter_column = "meter", .further_meter_columns = {"kind"}};
  const auto rows = joined_names(delimited_rows(csv::bytes_of(text), ','), shape);
  const auto kept = testing::kept_rows(*rows);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_THAT(kept[1].cells, ElementsAre("2024-01-01 00:00", "A / use", "use", "1"));
  EXPECT_THAT(kept[2].cells, ElementsAre("2024-01-01 00:00", "A", "", "2"));
}

TEST(NamedRows, ALineAboveABlockNamesItsRows) {
  const std::string text =
      "Meter;East\nt;v\n2024-01-01 00:00;1\n\nMeter;West\nt;v\n2024-01-01 00:00;2\n";
  const TableShape shape{
      .separator = ';', .time_column = "t", .meter_column = std::string{kTitleColumn}};
  const auto rows = layout_rows(delimited_rows(csv::bytes_of(text), ';'), shape, nullptr);
  const auto kept = testing::kept_rows(*rows);
  ASSERT_EQ(kept.size(), 5u);
  EXPECT_THAT(kept[1].cells, ElementsAre("2024-01-01 00:00", "1", "Meter East"));
  EXPECT_THAT(kept[4].cells, ElementsAre("2024-01-01 00:00", "2", "Meter West"));
}

/// Blocks with headers of their own, read in one go; a column that no block has is an error.
TEST(NamedRows, ColumnsMayBeInAnotherBlock) {
  std::string text = "t;East\n";
  for (int i = 0; i < 30; ++i) text += hour(i) + ";1\n";
  text += "\nt;West;Note\n";
  for (int i = 0; i < 30; ++i) text += hour(i) + ";2;x\n";
  const auto calendar = *metering::LocalCalendar::open("Etc/UTC");
  const TableShape shape{.separator = ';', .time_column = "t"};
  const auto meter = [](const std::string& name) {
    return TableMeter{.rows = {.name = name}, .column = name, .unit = "kWh"};
  };
  const auto both = testing::read_text_as(text, shape, {meter("East"), meter("West")}, calendar);
  ASSERT_TRUE(both.report.has_value()) << both.report.error().message;
  EXPECT_DOUBLE_EQ(both.energy(0), 30.0);
  EXPECT_DOUBLE_EQ(both.energy(1), 60.0);
  EXPECT_DOUBLE_EQ(testing::read_text_as(text, shape, {meter("West")}, calendar).energy(), 60.0);
  EXPECT_THAT(testing::read_text_as(text, shape, {meter("East"), meter("Nord")}, calendar)
                  .report.error()
                  .message,
              HasSubstr("no column 'Nord'"));
}

}  // namespace
}  // namespace recald::table::rows_apart_test
