#include "adapters/table/containers/influx_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/adapters/table/read_text.hpp"

namespace recald::table::influx_csv_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::vector<KeptRow> rows_of(const std::string& text) {
  const auto rows = influx_rows(csv::bytes_of(text));
  EXPECT_FALSE(rows->error().has_value());
  return testing::kept_rows(*rows);
}

const std::string kAnnotations =
    "#group,false,false,true,true,false,false,true,true,true\n"
    "#datatype,string,long,dateTime:RFC3339,dateTime:RFC3339,dateTime:RFC3339,double,string,string,"
    "string\n"
    "#default,_result,,,,,,,,roof\n";
const std::string kHeader = ",result,table,_start,_stop,_time,_value,_field,_measurement,place\n";

TEST(InfluxCsv, SeveralTablesEachWithItsHeader) {
  const std::string row =
      ",,0,2024-01-01T00:00:00Z,2024-02-01T00:00:00Z,2024-01-01T00:15:00Z,1.5,value,kWh,cellar\n";
  const std::string other =
      ",,1,2024-01-01T00:00:00Z,2024-02-01T00:00:00Z,2024-01-01T00:15:00Z,,value,kWh,\n";
  const auto kept =
      rows_of(kAnnotations + kHeader + row + "\r\n\r\n" + kAnnotations + kHeader + other);
  ASSERT_THAT(kept, SizeIs(3));
  EXPECT_THAT(kept[0].cells, ElementsAre("timestamp", "meter", "value", "unit"));
  EXPECT_THAT(kept[1].cells,
              ElementsAre("2024-01-01T00:15:00Z", "value / kWh / cellar", "1.5", "kWh"));
  EXPECT_THAT(kept[2].cells, ElementsAre("2024-01-01T00:15:00Z", "value / kWh / roof", "", "kWh"));
}

TEST(InfluxCsv, UnitsStandInAFieldAMeasurementOrATag) {
  struct Case {
    const char* field;
    const char* measurement;
    const char* unit;
  };
  for (const Case& one : {Case{"kW", "power", "kW"}, Case{"value", "Wh", "Wh"},
                          Case{"energy_kWh", "meters", "kWh"}, Case{"value", "meters", ""}}) {
    const auto kept = rows_of(kHeader + ",,0,,,2024-01-01T00:15:00Z,1.5," + one.field + "," +
                              one.measurement + ",cellar\n");
    ASSERT_THAT(kept, SizeIs(2));
    EXPECT_EQ(kept[1].cells[3], one.unit);
  }
}

TEST(InfluxCsv, FieldsOfAPivotedTableAreMeters) {
  const auto kept = rows_of(
      "#datatype,string,long,dateTime:RFC3339,double,double,string\n#group,false,false,false,false,"
      "false,true\n#default,_result,,,,,\n,result,table,_time,heat_kWh,power_kWh,place\n,,0,"
      "2024-01-01T00:15:00Z,3,4,cellar\n");
  ASSERT_THAT(kept, SizeIs(3));
  EXPECT_THAT(kept[1].cells, ElementsAre("2024-01-01T00:15:00Z", "cellar / heat_kWh", "3", "kWh"));
  EXPECT_THAT(kept[2].cells, ElementsAre("2024-01-01T00:15:00Z", "cellar / power_kWh", "4", "kWh"));
}

TEST(InfluxCsv, AFailedQueryIsRefused) {
  const auto rows = influx_rows(csv::bytes_of(
      "#datatype,string,string\n#group,true,true\n#default,,\n,error,reference\n,failed,897\n"));
  EXPECT_THAT(testing::kept_rows(*rows), SizeIs(1));
  ASSERT_TRUE(rows->error().has_value());
  EXPECT_THAT(rows->error()->message, HasSubstr("failed"));
}

TEST(InfluxCsv, IsKnownByItsFirstLines) {
  EXPECT_TRUE(is_influx_csv(std::vector<std::string>{"#group,false", "#datatype,string"}));
  EXPECT_TRUE(is_influx_csv(std::vector<std::string>{"", kHeader}));
  EXPECT_FALSE(
      is_influx_csv(std::vector<std::string>{"# a comment", "timestamp,meter,value,unit"}));
}

}  // namespace
}  // namespace recald::table::influx_csv_test
