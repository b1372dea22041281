#include "adapters/table/sniff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

namespace recald::table::sniff_test {
namespace {

using ::testing::HasSubstr;

std::vector<KeptRow> rows_of(const std::vector<std::vector<std::string>>& cells) {
  std::vector<KeptRow> rows;
  for (const auto& row : cells) rows.push_back({rows.size() + 1, row});
  return rows;
}

std::string padded(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

/// Hours from the first of a month on: "DD/MM/2024 HH:00" or with month and day exchanged.
std::vector<std::vector<std::string>> hours(int month, int first_day, int count,
                                            bool is_month_first, const std::string& value) {
  std::vector<std::vector<std::string>> cells{{"when", "Main (kWh)"}};
  for (int hour = 0; hour < count; ++hour) {
    const std::string date = padded(first_day + hour / 24);
    const std::string parts =
        is_month_first ? padded(month) + "/" + date : date + "/" + padded(month);
    cells.push_back({parts + "/2024 " + padded(hour % 24) + ":00", value});
  }
  return cells;
}

TableGuess guess(const std::vector<std::vector<std::string>>& cells) {
  auto guessed = guess_table(rows_of(cells));
  EXPECT_TRUE(guessed.has_value()) << guessed.error().message;
  return guessed ? *guessed : TableGuess{};
}

std::string refusal(const std::vector<std::vector<std::string>>& cells) {
  const auto guessed = guess_table(rows_of(cells));
  return guessed ? "understood" : guessed.error().message;
}

TEST(Sniff, ADayAfterTheTwelfthDecides) {
  const TableGuess days = guess(hours(3, 10, 120, false, "1.5"));
  EXPECT_EQ(days.shape.time_format, TimeFormat::day_first);
  EXPECT_THAT(days.time_format_because, HasSubstr("'13/03/2024 00:00' in row 74 decides"));
  EXPECT_EQ(guess(hours(3, 10, 120, true, "1.5")).shape.time_format, TimeFormat::month_first);
}

// 1 to 5 March: the other way round the days would be months apart.
TEST(Sniff, DaysThatFollowEachOtherDecide) {
  const TableGuess days = guess(hours(3, 1, 120, false, "1.5"));
  EXPECT_EQ(days.shape.time_format, TimeFormat::day_first);
  EXPECT_FALSE(days.is_time_format_open);
  EXPECT_EQ(guess(hours(3, 1, 120, true, "1.5")).shape.time_format, TimeFormat::month_first);
  EXPECT_TRUE(guess(hours(3, 4, 24, false, "1.5")).is_time_format_open);
}

TEST(Sniff, CountedDaysAndSecondsAreTimes) {
  // From 1998, 2024, 2045 and 2100.
  for (const std::int64_t begin_s :
       {883'612'800LL, 1'704'067'200LL, 2'366'841'600LL, 4'102'444'800LL}) {
    SCOPED_TRACE(begin_s);
    std::vector<std::vector<std::string>> cells{{"Date", "kW"}};
    const double begin_days = 25'569.0 + static_cast<double>(begin_s) / 86'400.0;
    for (int i = 0; i < 20; ++i) cells.push_back({std::to_string(begin_days + i / 24.0), "5"});
    EXPECT_EQ(guess(cells).shape.time_format, TimeFormat::excel);
    for (int i = 0; i < 20; ++i) cells[i + 1][0] = std::to_string(begin_s + 900 * i);
    EXPECT_EQ(guess(cells).shape.time_format, TimeFormat::unix);
    EXPECT_TRUE(guess(cells).has_offsets);
  }
}

TEST(Sniff, TheDecimalSignIsWhatSomeValueShows) {
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1,5")).shape.decimal, ',');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1,234.5")).shape.decimal, '.');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1.234,5")).shape.decimal, ',');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "0,125")).shape.decimal, ',');
  EXPECT_THAT(guess(hours(3, 10, 120, false, "1,234")).decimal_because, HasSubstr("would decide"));
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1,234")).shape.decimal, ',');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1.234")).shape.decimal, '.');
  auto thousands = hours(3, 10, 120, false, "1,234");
  for (std::size_t i = 1; i < thousands.size(); i += 2) thousands[i][1] = "975";
  EXPECT_EQ(guess(thousands).shape.decimal, '.');
  auto mixed = hours(3, 10, 120, false, "1,5");
  for (std::size_t i = 1; i < mixed.size(); i += 2) mixed[i][1] = "1.5";
  EXPECT_THAT(refusal(mixed), HasSubstr("change their decimal sign: row"));
}

TEST(Sniff, UnitsStandInHeadersOrBelowThem) {
  for (const auto& [header, name, unit] :
       {std::tuple{"Main (kWh)", "Main", "kWh"}, std::tuple{"Main [kWh]", "Main", "kWh"},
        std::tuple{"Main_kWh", "Main", "kWh"}, std::tuple{"Main, ton-hours", "Main", "ton-hours"},
        std::tuple{"kW", "", "kW"}, std::tuple{"Wing W", "Wing W", ""},
        std::tuple{"Main (east)", "Main (east)", ""}, std::tuple{"(kWh) Main", "Main", "kWh"}}) {
    EXPECT_EQ(split_unit(header).name, name) << header;
    EXPECT_EQ(split_unit(header).unit, unit) << header;
  }
  auto cells = hours(3, 10, 48, false, "1.5");
  cells[0][1] = "Main";
  cells.insert(cells.begin() + 1, {"", "MWh"});
  const TableGuess below = guess(cells);
  EXPECT_EQ(below.values.at(0).name, "Main");
  EXPECT_EQ(below.values.at(0).unit, "MWh");
  EXPECT_EQ(below.shape.time_column, "when");
}

TEST(Sniff, ColumnsOfTextAreNoMeters) {
  auto cells = hours(3, 10, 48, false, "1.5");
  cells[0].insert(cells[0].end(), {"Status", "Main (kWh)", "Nothing",
                                   "Outdoor (\xC2\xB0"
                                   "C)"});
  for (std::size_t i = 1; i < cells.size(); ++i) {
    cells[i].insert(cells[i].end(), {i % 2 == 0 ? "A" : "E", "2", "", "21.5"});
  }
  const TableGuess found = guess(cells);
  ASSERT_EQ(found.values.size(), 2u);
  EXPECT_EQ(found.values[1].column, "#4");  // the second of that name
  EXPECT_EQ(found.shape.flag_column, "Status");
  EXPECT_EQ(found.ignored, (std::vector<std::string>{"Nothing (empty)",
                                                     "Outdoor (\xC2\xB0"
                                                     "C) (no energy)"}));
}

TEST(Sniff, SeparatorsAreWhatCutsMostLines) {
  EXPECT_EQ(guess_separator(std::vector<std::string>{"a;b", "1,5;2,5", "1,5;3,5"}), ';');
  EXPECT_EQ(guess_separator(std::vector<std::string>{"Report", "", "a,b", "1,2", "3,4", "5,6"}),
            ',');
  EXPECT_EQ(guess_separator(std::vector<std::string>{"a\tb", "1,5\t2"}), '\t');
}

TEST(Sniff, WhatIsNoTableSaysWhy) {
  EXPECT_EQ(refusal({}), "it is empty");
  EXPECT_THAT(refusal({{"a", "b"}, {"1", "2"}}), HasSubstr("no column has dates and times"));
  EXPECT_THAT(refusal(hours(3, 10, 48, false, "on")), HasSubstr("no column has numbers"));
}

}  // namespace
}  // namespace recald::table::sniff_test
