#include "adapters/table/loads/meter_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/adapters/table/read_text.hpp"

namespace recald::table::meter_parts_test {
namespace {

using metering::LocalCalendar;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ReadText;

std::string stamp(int quarter) {
  const metering::Instant t =
      metering::Instant{std::chrono::sys_days{std::chrono::year{2024} / 3 / 4}} +
      std::chrono::minutes{15} * quarter;
  std::string text = metering::to_string(t);
  return text;
}

constexpr int kQuarters = 192;
bool is_day(int quarter) { return quarter % 96 >= 28 && quarter % 96 < 84; }

ReadText read(const std::string& text, const TableMeter& meter, const TableShape& shape) {
  return testing::read_text_as(text, shape, {meter}, *LocalCalendar::open("Etc/UTC"));
}

const TableShape kLong{.separator = ',', .time_column = "t", .meter_column = "register"};
const TableShape kWide{.separator = ',', .time_column = "t"};

TableMeter rows_named(const std::string& first, std::vector<std::string> further) {
  return {
      .rows = {.name = first}, .column = "v", .unit = "kWh", .further_names = std::move(further)};
}

double value_at(const ReadText& read, int quarter) {
  for (const metering::Reading& reading : read.readings) {
    if (metering::to_string(reading.start) == stamp(quarter)) return reading.mean_kW / 4.0;
  }
  return -1.0;
}

/// Registers of tariffs: a row of one of them at a time, or one behind the other in the file.
TEST(MeterParts, TariffsThatTakeTurnsAreOneLoad) {
  for (const bool is_sorted_by_register : {false, true}) {
    std::string text = "t,register,v\n";
    const auto add = [&](int from, bool day, bool night) {
      for (int i = from; i < kQuarters; ++i) {
        if (is_day(i) ? day : night) {
          text += stamp(i) + (is_day(i) ? ",day," : ",night,") + std::to_string(i + 1) + "\n";
        }
      }
    };
    if (is_sorted_by_register) {
      add(0, true, false);
      add(0, false, true);
    } else {
      add(0, true, true);
    }
    const auto both = read(text, rows_named("day", {"night"}), kLong);
    ASSERT_TRUE(both.report.has_value()) << both.report.error().message;
    ASSERT_EQ(both.readings.size(), static_cast<std::size_t>(kQuarters));
    for (int i = 0; i < kQuarters; ++i) EXPECT_DOUBLE_EQ(value_at(both, i), i + 1);
    EXPECT_EQ(both.report->meters.size(), 1u);
    EXPECT_EQ(both.report->meters[0].readings, static_cast<std::uint64_t>(kQuarters));
    EXPECT_EQ(both.report->meters[0].span->begin, both.readings.front().start);
  }
}

/// What is missing in the midst of a tariff is missing, though the other has nothing then either.
TEST(MeterParts, AHoleInATariffIsNoTurn) {
  std::string text = "t,day,night\n";
  for (int i = 0; i < kQuarters; ++i) {
    const bool is_hole = i == 50;
    text += stamp(i) + "," + (is_day(i) && !is_hole ? "1" : "") + "," +
            (is_day(i) && !is_hole ? "" : "2") + "\n";
  }
  TableMeter meter{
      .rows = {.name = "use"}, .column = "day", .unit = "kWh", .further_columns = {"night"}};
  const auto both = read(text, meter, kWide);
  EXPECT_TRUE(std::isnan(value_at(both, 50)));  // the day's value is missing between two others
  EXPECT_DOUBLE_EQ(value_at(both, 49), 1.0);
  EXPECT_DOUBLE_EQ(value_at(both, 84), 2.0);
}

TEST(MeterParts, PhasesAreAddedAndNeedEachOther) {
  std::string text = "t,L1,L2,L3\n";
  for (int i = 0; i < kQuarters; ++i) {
    text += stamp(i) + ",1,2," + (i >= 20 && i < 30 ? "" : "4") + "\n";
  }
  TableMeter meter{
      .rows = {.name = "use"}, .column = "L1", .unit = "kWh", .further_columns = {"L2", "L3"}};
  const auto sum = read(text, meter, kWide);
  EXPECT_DOUBLE_EQ(value_at(sum, 0), 7.0);
  EXPECT_TRUE(std::isnan(value_at(sum, 25)));
  EXPECT_EQ(sum.report->meters[0].blanks, 10u);
}

/// Registers are added as what they rose by.
TEST(MeterParts, EachRegisterIsCountedByItself) {
  std::string text = "t,T1,T2\n";
  for (int i = 0; i < kQuarters; ++i) {
    text += stamp(i) + "," + std::to_string(1000 + i) + "," + std::to_string(50'000 + 2 * i) + "\n";
  }
  TableMeter meter{
      .rows = {.name = "use"}, .column = "T1", .unit = "kWh", .further_columns = {"T2"}};
  meter.rows.counter = metering::CounterSettings{.rated_kW = 1000.0};
  const auto sum = read(text, meter, kWide);
  ASSERT_TRUE(sum.report.has_value()) << sum.report.error().message;
  EXPECT_DOUBLE_EQ(value_at(sum, 10), 3.0);
}

TEST(MeterParts, OthersStayAsTheyAre) {
  std::string text = "t,register,v\n";
  for (int i = 0; i < kQuarters; ++i) {
    text += stamp(i) + (is_day(i) ? ",day," : ",night,") + "3\n" + stamp(i) + ",export,5\n";
  }
  const std::vector<TableMeter> meters{rows_named("export", {}), rows_named("day", {"night"})};
  const auto both = testing::read_text_as(text, kLong, meters, *LocalCalendar::open("Etc/UTC"));
  EXPECT_DOUBLE_EQ(both.energy(0), 5.0 * kQuarters);
  EXPECT_DOUBLE_EQ(both.energy(1), 3.0 * kQuarters);
}

TEST(MeterParts, APartThatIsNotThereIsSaid) {
  std::string text = "t,register,v\n";
  for (int i = 0; i < kQuarters; ++i) text += stamp(i) + ",day,3\n";
  EXPECT_THAT(read(text, rows_named("day", {"nigth"}), kLong).report.error().message,
              HasSubstr("no usable row of 'nigth'"));
  for (int i = 0; i < kQuarters; i += 4) text += stamp(i) + ",night,3\n";
  EXPECT_THAT(read(text, rows_named("day", {"night"}), kLong).report.error().message,
              HasSubstr("every 900 s and 'night' every 3600 s"));
}

}  // namespace
}  // namespace recald::table::meter_parts_test
