#include "adapters/table/containers/nem12.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/adapters/table/read_text.hpp"

namespace recald::table::nem12_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A day of values that count up from `first`.
std::string day(const std::string& date, int step_min, int first, const std::string& quality) {
  std::string text = "300," + date;
  for (int i = 0; i < 1440 / step_min; ++i) text += "," + std::to_string(first + i);
  return text + "," + quality + ",,,20240301000000,\n";
}

std::string channel(const std::string& suffix, const std::string& unit, int step_min) {
  return "200,6102345678,E1B1Q1,," + suffix + ",N1,MET1," + unit + "," + std::to_string(step_min) +
         ",\n";
}

std::vector<KeptRow> rows_of(const std::string& text, std::vector<std::string>* notes = nullptr) {
  const auto rows = nem12_rows(csv::bytes_of(text));
  auto kept = testing::kept_rows(*rows, 100'000);
  if (notes != nullptr) *notes = rows->notes();
  return kept;
}

TEST(Nem12, ChannelsAndDaysOnTheMarketsClock) {
  for (const int step : {5, 15, 30}) {
    SCOPED_TRACE(step);
    std::vector<std::string> notes;
    const auto kept = rows_of("100,NEM12,202403010000,MDP,RET\n" + channel("E1", "kWh", step) +
                                  day("20240203", step, 1, "A") + channel("Q1", "kVArh", step) +
                                  day("20240203", step, 1, "A") + channel("B1", "Wh", step) +
                                  day("20240203", step, 500, "A") + "900\n",
                              &notes);
    const auto count = static_cast<std::size_t>(1440 / step);
    ASSERT_EQ(kept.size(), 1 + 2 * count);
    EXPECT_THAT(kept[1].cells,
                ElementsAre("2024-02-02T14:00:00Z", "6102345678 / E1", "1", "kWh", "A"));
    EXPECT_EQ(kept[count].cells[0], step == 30   ? "2024-02-03T13:30:00Z"
                                    : step == 15 ? "2024-02-03T13:45:00Z"
                                                 : "2024-02-03T13:55:00Z");
    EXPECT_THAT(kept[count + 1].cells,
                ElementsAre("2024-02-02T14:00:00Z", "6102345678 / B1", "500", "Wh", "A"));
    EXPECT_THAT(notes, ElementsAre(HasSubstr("6102345678 / Q1 (kVArh)")));
  }
}

TEST(Nem12, NamesInNotesArePrintable) {
  std::vector<std::string> notes;
  rows_of(
      channel("Q1", std::string{"kV\x1B\0\tArh", 8}, 30) + day("20240203", 30, 1, "A") + "900\n",
      &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr(R"(Q1 (kV\x1B\x00\x09Arh))")));
}

TEST(Nem12, RangesOfQualityAndMissingValues) {
  const auto kept = rows_of(channel("E1", "kWh", 30) + day("20240203", 30, 1, "V") +
                            "400,1,2,A,,\n400,3,5,S14,51,\n400,6,48,N,,\n" +
                            day("20240204", 30, 1, "A") + "900\n");
  ASSERT_EQ(kept.size(), 97u);
  EXPECT_EQ(kept[2].cells[4], "A");
  EXPECT_EQ(kept[3].cells[4], "S");
  EXPECT_EQ(kept[5].cells[2], "5");
  EXPECT_EQ(kept[6].cells[2], "");  // no data
  EXPECT_EQ(kept[6].cells[4], "N");
  EXPECT_EQ(kept[49].cells[2], "1");
  EXPECT_EQ(kept[49].cells[4], "A");
}

TEST(Nem12, AShortDayAndAWrongDateAreBadRows) {
  const auto rows = nem12_rows(csv::bytes_of(
      "200,6102345678,E1,,E1,,,kWh,30,\n300,20240203,1,2,A,,,,\n300,20241303,1,2,A,,,,\n"));
  TableRow row;
  ASSERT_TRUE(rows->next(row));
  ASSERT_TRUE(rows->next(row));
  EXPECT_THAT(std::string{row.problem}, HasSubstr("fewer than 48 values"));
  ASSERT_TRUE(rows->next(row));
  EXPECT_EQ(row.number, 3u);
  EXPECT_THAT(std::string{row.problem}, HasSubstr("'20241303' is not yyyymmdd"));
  EXPECT_FALSE(rows->next(row));
}

TEST(Nem12, RegistersThatAreReadEveryFewMonthsAreRefused) {
  const auto rows = nem12_rows(csv::bytes_of("100,NEM13,202403010000,MDP,RET\n250,6102345678\n"));
  EXPECT_EQ(testing::kept_rows(*rows).size(), 1u);
  ASSERT_TRUE(rows->error().has_value());
  EXPECT_THAT(rows->error()->message, HasSubstr("NEM12"));
}

TEST(Nem12, IsKnownByItsFirstLine) {
  EXPECT_TRUE(is_nem12("100,NEM12,202403010000,MDP,RET"));
  EXPECT_TRUE(is_nem12("200,6102345678,E1B1,1,E1,N1,MET1,kWh,30,"));
  EXPECT_FALSE(is_nem12("200,6102345678"));
  EXPECT_FALSE(is_nem12("timestamp,meter,value,unit"));
}

}  // namespace
}  // namespace recald::table::nem12_test
