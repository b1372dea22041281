#include "adapters/csv/weather_csv.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::csv::weather_csv_test {
namespace {

using std::chrono::hours;
using std::chrono::minutes;

const metering::Instant kStart = std::chrono::sys_days{std::chrono::year{2016} / 3 / 1};

const WeatherCsvOptions kMeans{.values = weather::RecordedValues::mean};

Result<WeatherCsv> read(std::string_view text, const WeatherCsvOptions& options = {}) {
  return read_weather_text(text, "weather.csv", options);
}

const std::string kHead =
    "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2\n";

TEST(WeatherCsv, PlainFileWithBlanks) {
  const auto csv = read(kHead +
                        "2016-03-01T00:00:00Z,5.5,87,3.1,210,0\n"
                        "2016-03-01T01:00:00Z,6.5,,,,\n");
  ASSERT_TRUE(csv.has_value()) << csv.error().message;
  EXPECT_EQ(csv->step, hours{1});
  EXPECT_EQ(csv->issues.total, 0u);
  ASSERT_EQ(csv->series.hours.size(), 2u);
  EXPECT_EQ(csv->series.hours[0].rel_humidity_pct, 87.0);
  EXPECT_NEAR(csv->series.hours[0].wind_dir_deg, 210.0, 1e-9);
  EXPECT_TRUE(std::isnan(csv->series.hours[1].ghi_W_m2));
}

TEST(WeatherCsv, ColumnsInAnyOrderOthersIgnoredByName) {
  const auto csv = read(
      "timestamp,ghi_W_m2,dew_point_C,dry_bulb_C,pressure_Pa\n"
      "2016-03-01T00:00:00Z,400,1,5,101300\n2016-03-01T00:15:00Z,200,1,7,101500\n"
      "2016-03-01T00:30:00Z,300,1,6,\n");
  ASSERT_TRUE(csv.has_value()) << csv.error().message;
  EXPECT_EQ(csv->ignored_columns, std::vector<std::string>{"dew_point_C"});
  EXPECT_EQ(csv->step, minutes{15});
  EXPECT_DOUBLE_EQ(csv->series.hours.at(0).ghi_W_m2, 300.0);
  EXPECT_DOUBLE_EQ(csv->series.hours.at(0).pressure_Pa, 101400.0);
}

TEST(WeatherCsv, TemperaturesMayBeInFahrenheit) {
  const auto csv = read(
      "timestamp,dry_bulb_F\n2016-03-01T00:00:00Z,50\n2016-03-01T01:00:00Z,-4\n"
      "2016-03-01T02:00:00Z,500\n",
      kMeans);
  ASSERT_TRUE(csv.has_value()) << csv.error().message;
  EXPECT_NEAR(csv->series.hours.at(0).dry_bulb_C, 10.0, 1e-9);
  EXPECT_NEAR(csv->series.hours.at(1).dry_bulb_C, -20.0, 1e-9);
  ASSERT_EQ(csv->issues.total, 1u);
  EXPECT_EQ(csv->issues.listed[0].reason, "dry_bulb_F 500 is impossible; taken as blank");
  const auto both = read("timestamp,dry_bulb_C,dry_bulb_F\n");
  ASSERT_FALSE(both.has_value());
  EXPECT_NE(both.error().message.find("'dry_bulb_F' comes twice"), std::string::npos);
}

TEST(WeatherCsv, EndStampsAreMovedToTheStart) {
  WeatherCsvOptions options;
  options.stamps = Stamps::end;
  options.values = weather::RecordedValues::mean;
  const auto csv = read(kHead +
                            "2016-03-01T00:00:00Z,5,,,,\n"
                            "2016-03-01T01:00:00Z,6,,,,\n",
                        options);
  ASSERT_TRUE(csv.has_value());
  EXPECT_EQ(csv->series.begin, kStart - hours{1});
  EXPECT_EQ(csv->series.hours[1].dry_bulb_C, 6.0);
}

/// Three rows of 5, 6 and 7 °C.
std::string three_rows(std::chrono::seconds step) {
  std::string text = kHead;
  for (int i = 0; i < 3; ++i) {
    text += metering::to_string(kStart + i * step) + "," + std::to_string(5 + i) + ",,,,\n";
  }
  return text;
}

// Instants become means of the hour after their stamp, or before it. Where nothing is said and
// nothing shows it, hourly rows are instants, as weather services report, shorter ones means.
TEST(WeatherCsv, ValuesAreInstantsOrMeans) {
  using weather::KnownBy;
  using weather::RecordedValues;
  WeatherCsvOptions options;
  options.values = RecordedValues::instant;
  EXPECT_EQ(read(three_rows(hours{1}), options)->series.hours[0].dry_bulb_C, 5.5);
  EXPECT_EQ(read(three_rows(hours{1}), options)->values,
            (weather::ValuesTaken{RecordedValues::instant, KnownBy::declared}));
  options.stamps = Stamps::end;
  EXPECT_EQ(read(three_rows(hours{1}), options)->series.find(kStart)->dry_bulb_C, 5.5);
  options.values = RecordedValues::mean;
  EXPECT_EQ(read(three_rows(hours{1}), options)->series.find(kStart)->dry_bulb_C, 6.0);
  EXPECT_EQ(read(three_rows(hours{1}))->series.hours[0].dry_bulb_C, 5.5);
  EXPECT_EQ(read(three_rows(hours{1}))->values,
            (weather::ValuesTaken{RecordedValues::instant, KnownBy::usage}));
  EXPECT_EQ(read(three_rows(minutes{15}))->series.hours[0].dry_bulb_C, 6.0);
  EXPECT_EQ(read(three_rows(minutes{15}))->values,
            (weather::ValuesTaken{RecordedValues::mean, KnownBy::usage}));
}

TEST(WeatherCsv, ImpossibleValuesAreBlanksSlightExcessIsCut) {
  const auto csv = read(kHead +
                            "2016-03-01T00:00:00Z,5,105,1,200,-4\n"
                            "2016-03-01T01:00:00Z,155,50,1,200,0\n",
                        kMeans);
  ASSERT_TRUE(csv.has_value());
  EXPECT_EQ(csv->series.hours[0].rel_humidity_pct, 100.0);
  EXPECT_EQ(csv->series.hours[0].ghi_W_m2, 0.0);
  EXPECT_TRUE(std::isnan(csv->series.hours[1].dry_bulb_C));
  EXPECT_EQ(csv->series.hours[1].rel_humidity_pct, 50.0);
  ASSERT_EQ(csv->issues.total, 1u);
  EXPECT_EQ(csv->issues.listed[0].reason, "dry_bulb_C 155 is impossible; taken as blank");
}

TEST(WeatherCsvBadInput, EachHasItsSentence) {
  const std::string good =
      "2016-03-01T00:00:00Z,5,,,,\n2016-03-01T01:00:00Z,6,,,,\n2016-03-01T02:00:00Z,7,,,,\n";
  const auto only_issue = [&](const std::string& row) {
    const auto csv = read(kHead + good + row);
    if (!csv || csv->issues.total != 1) return std::string{"not one issue"};
    EXPECT_EQ(csv->issues.listed[0].line, 5u);
    return csv->issues.listed[0].reason;
  };
  EXPECT_EQ(only_issue("2016-03-01T03:00:00Z,5\n"), "2 fields instead of 6");
  EXPECT_NE(only_issue("2016-03-01T03:00:00,5,,,,\n").find("no offset"), std::string::npos);
  EXPECT_EQ(only_issue("2016-03-01T03:00:00Z,\"5,5\",,,,\n"),
            "dry_bulb_C '5,5' has a decimal comma; write 5.5");
  EXPECT_NE(only_issue("2016-03-01T02:00:00Z,5,,,,\n").find("comes twice"), std::string::npos);
  EXPECT_NE(only_issue("2016-03-01T01:30:00Z,5,,,,\n").find("after a later row"),
            std::string::npos);
  EXPECT_NE(only_issue("2016-03-01T03:00:00Z,5,,,,12").find("may be cut"), std::string::npos);
}

TEST(WeatherCsvBadInput, Headers) {
  for (const char* header : {"", "time,dry_bulb_C\n", "timestamp,ghi_W_m2\n",
                             "timestamp;dry_bulb_C\n", "timestamp,dry_bulb_C,dry_bulb_C\n"}) {
    const auto csv = read(header);
    ASSERT_FALSE(csv.has_value()) << header;
    EXPECT_EQ(csv.error().code, ErrorCode::malformed);
    EXPECT_NE(csv.error().message.find("the header must be like 'timestamp,dry_bulb_C"),
              std::string::npos);
  }
  EXPECT_EQ(read_weather("/no/such/weather.csv", {}).error().message,
            "weather file '/no/such/weather.csv' does not exist");
  EXPECT_EQ(read(kHead).error().code, ErrorCode::not_enough_data);
}

TEST(WeatherCsvBadInput, CutAtEveryByteNothingIsInvented) {
  std::string text = kHead;
  for (int i = 0; i < 6; ++i) {
    text += metering::to_string(kStart + hours{i}) + "," + std::to_string(10 + i) +
            ".5,50,3,200,1" + std::to_string(i) + "0\n";
  }
  const auto whole = read(text, kMeans);
  for (std::size_t cut = 0; cut < text.size(); ++cut) {
    const auto csv = read(std::string_view{text}.substr(0, cut), kMeans);
    if (!csv) continue;
    for (std::size_t i = 0; i < csv->series.hours.size(); ++i) {
      EXPECT_EQ(csv->series.hours[i].dry_bulb_C, whole->series.hours.at(i).dry_bulb_C);
      EXPECT_EQ(csv->series.hours[i].ghi_W_m2, whole->series.hours.at(i).ghi_W_m2);
    }
  }
}

}  // namespace
}  // namespace recald::csv::weather_csv_test
