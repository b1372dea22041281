/// Weather that is sent, and what is served of sensors.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include "tests/daemon/gateway/serve/prometheus_parser.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"
#include "tests/daemon/gateway/weather_station.hpp"

namespace recald::daemon::pushed_weather_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class PushedWeather : public ServedSite {
 protected:
  /// @param more  Of the sensor's table.
  explicit PushedWeather(const std::string& more = "")
      : ServedSite(
            "\n[[meter]]\nid = \"roof\"\nrole = \"weather\"\nsource = \"http\"\n"
            "interval = \"15m\"\n" +
            more) {}

  http::Response post(const std::string& body) {
    return answer(served_,
                  {.method = http::Method::post, .path = "/api/v1/readings", .body = body});
  }
  Json taken(const std::string& body) {
    const http::Response response = post(body);
    EXPECT_EQ(response.status, 200) << response.body;
    return Json::parse(response.body);
  }
  static std::string body_of(const std::string& unit, const std::string& values) {
    return fmt::format(R"({{"meter":"roof","unit":"{}","readings":[{}]}})", unit, values);
  }
  static std::string at_ten(double value) {
    return fmt::format(R"({{"time":"2024-03-30T10:00:00Z","value":{}}})", value);
  }
  Json intervals(const std::string& quantity) {
    return get_json("/api/v1/intervals", {{"meter", "roof." + quantity}});
  }
};

TEST_F(PushedWeather, TheUnitSaysWhatItIs) {
  EXPECT_EQ(taken(body_of("degC", at_ten(7.5)))["stored"], 1);
  EXPECT_EQ(taken(body_of("%", at_ten(61)))["stored"], 1);
  EXPECT_EQ(taken(body_of("m/s", at_ten(3.2)))["stored"], 1);
  EXPECT_EQ(taken(body_of("deg", at_ten(270)))["stored"], 1);
  EXPECT_EQ(taken(body_of("W/m2", at_ten(-4)))["stored"], 1);
  const Json dry_bulb = intervals("dry_bulb_C");
  EXPECT_EQ(dry_bulb["unit"], "degC");
  ASSERT_THAT(dry_bulb["intervals"], SizeIs(1));
  EXPECT_EQ(dry_bulb["intervals"][0]["mean"], 7.5);
  EXPECT_FALSE(dry_bulb["intervals"][0].contains("energy_kWh"));
  EXPECT_EQ(intervals("ghi_W_m2")["intervals"][0]["mean"], -4.0);
  EXPECT_EQ(intervals("wind_dir_deg")["intervals"][0]["mean"], 270.0);
  EXPECT_EQ(taken(body_of("degC", at_ten(7.5)))["known"], 1);
  EXPECT_THAT(taken(body_of("degC", at_ten(8.5)))["conflicts"],
              ElementsAre("2024-03-30T10:00:00Z"));
}

TEST_F(PushedWeather, AWrongUnitIsRefusedAndTheRightOnesAreNamed) {
  for (const char* unit : {"kWh", "F", "C", ""}) {
    const http::Response response = post(body_of(unit, at_ten(7.5)));
    EXPECT_EQ(in_short(response), "400 invalid_value unit") << unit;
    EXPECT_THAT(response.body, HasSubstr("degC (dry_bulb_C), % (rel_humidity_pct), m/s"));
  }
  EXPECT_THAT(post(R"({"meter":"roof","readings":[]})").body, HasSubstr("such as degC"));
  EXPECT_THAT(intervals("dry_bulb_C")["intervals"], IsEmpty());
}

TEST_F(PushedWeather, WhatCannotBeIsSuspectAndGivesWay) {
  const Json said = taken(body_of("degC", at_ten(85)));
  ASSERT_THAT(said["suspect"], SizeIs(1));
  EXPECT_EQ(said["suspect"][0]["start"], "2024-03-30T10:00:00Z");
  EXPECT_EQ(said["suspect"][0]["why"],
            "85 degC cannot be dry_bulb_C, which lies between -60 and 60; check the unit, and the "
            "sensor");
  EXPECT_EQ(intervals("dry_bulb_C")["intervals"][0]["validity"], "suspect");
  EXPECT_EQ(intervals("dry_bulb_C")["intervals"][0]["reasons"], Json::array({"range"}));
  EXPECT_EQ(taken(body_of("degC", at_ten(8.5)))["stored"], 1);
  EXPECT_EQ(intervals("dry_bulb_C")["intervals"][0]["mean"], 8.5);
  for (const auto& [unit, value] : {std::pair{"%", 106.0}, std::pair{"m/s", -1.0},
                                    std::pair{"deg", 361.0}, std::pair{"W/m2", 1601.0}}) {
    EXPECT_THAT(taken(body_of(unit, at_ten(value)))["suspect"], SizeIs(1)) << unit;
  }
}

TEST_F(PushedWeather, IntervalsAreThoseOfAQuantity) {
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "roof"}}), "400 invalid_value meter");
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "roof.dew_point_C"}}), "404 not_found meter");
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "cellar.dry_bulb_C"}}), "404 not_found meter");
  EXPECT_THAT(get_json("/api/v1/months", {{"meter", "roof"}})["months"], IsEmpty());
}

TEST_F(PushedWeather, IsOneOfTheMeters) {
  taken(body_of("degC", at_ten(7.5)));
  const Json meters = get_json("/api/v1/meters")["meters"];
  const Json& roof = meters.back();
  EXPECT_EQ(roof["id"], "roof");
  EXPECT_EQ(roof["role"], "weather");
  EXPECT_FALSE(roof.contains("utility"));
  EXPECT_EQ(roof["weather"]["dry_bulb_C"]["last_interval"]["mean"], 7.5);
  EXPECT_EQ(roof["weather"]["dry_bulb_C"]["known_until"], "2024-03-30T10:15:00Z");
  EXPECT_FALSE(roof["weather"].contains("ghi_W_m2"));  // it never came
  EXPECT_EQ(get_json("/api/v1/meters/roof"), roof);
}

// The silence shows wherever people and programs look, and makes nothing unready.
TEST_F(PushedWeather, SilenceIsSeenEverywhere) {
  taken(body_of("degC", at_ten(7.5)));
  loop_.run_for(days{2});
  const Json ready = get_json("/readyz");
  EXPECT_EQ(ready["status"], "ready");
  ASSERT_THAT(ready["look_at"], SizeIs(1));
  EXPECT_EQ(ready["look_at"][0],
            "weather sensor 'roof' has sent no dry_bulb_C since 2024-03-30T10:15:00Z");
  EXPECT_THAT(get("/").body, AllOf(HasSubstr("has sent no dry_bulb_C since"), HasSubstr("roof"),
                                   HasSubstr("7.5 °C")));
  EXPECT_EQ(get_json("/api/v1/meters/roof")["weather"]["dry_bulb_C"]["silent_since"],
            "2024-03-30T10:15:00Z");
  EXPECT_EQ(get_json("/api/v1/events")["events"][0]["kind"], "weather_silent");
  const auto metrics = recald::testing::parse_prometheus(get("/metrics").body);
  EXPECT_THAT(metrics.problems, IsEmpty());
  EXPECT_EQ(
      metrics.sample(
          "recald_weather_known_until_timestamp_seconds{meter=\"roof\",quantity=\"dry_bulb_C\"}"),
      1711793700.0);
  EXPECT_EQ(metrics.sample("recald_intervals_total{meter=\"roof\",validity=\"ok\"}"), 1);
}

TEST_F(PushedWeather, AReasonPutsItRight) {
  taken(body_of("degC", at_ten(7.5)));
  std::string body = body_of("degC", at_ten(5.5));
  body.insert(1, R"("reason":"in the sun","author":"Ada",)");
  EXPECT_EQ(taken(body)["stored"], 1);
  EXPECT_EQ(intervals("dry_bulb_C")["intervals"][0]["mean"], 5.5);
  EXPECT_EQ(intervals("dry_bulb_C")["intervals"][0]["revision"], 1);
}

TEST_F(PushedWeather, WhatIsTooOldBelongsInAFile) {
  const http::Response response =
      post(body_of("degC", R"({"time":"2022-03-30T10:00:00Z","value":7.5})"));
  EXPECT_EQ(in_short(response), "400 invalid_value readings[0].time");
  EXPECT_THAT(response.body, AllOf(HasSubstr("belongs in the file named by [weather] file"),
                                   Not(HasSubstr("recald import"))));
}

class PushedInstants : public PushedWeather {
 protected:
  PushedInstants() : PushedWeather("values = \"instant\"\n") {}
};

TEST_F(PushedInstants, StandAtTheirTime) {
  // It is noon: the quarter of an hour that begins has not passed, but the value is there.
  EXPECT_EQ(taken(body_of("degC", R"({"time":"2024-03-30T12:00:00Z","value":7.5})"))["stored"], 1);
  const http::Response early =
      post(body_of("degC", R"({"time":"2024-03-30T12:15:00Z","value":7.5})"));
  EXPECT_EQ(in_short(early), "400 invalid_value readings[0].time");
  EXPECT_THAT(early.body, HasSubstr("after now"));
  std::string body = body_of("degC", at_ten(5.5));
  body.insert(1, R"("stamps":"end",)");
  EXPECT_EQ(in_short(post(body)), "400 invalid_value stamps");
  EXPECT_THAT(post(body).body, HasSubstr("leave out 'stamps'"));
}

/// A station on the bus beside the meters.
class PolledWeather : public ServedSite {
 protected:
  PolledWeather() {
    recald::testing::write_text(folder_ / "station.toml", testing::kStationMap);
    devices_[3].registers = [](std::chrono::milliseconds t) {
      return testing::station_registers(testing::usual_weather(testing::hours_of(t)));
    };
    site_ = load(served_site() + testing::station());
    begin();
  }
};

TEST_F(PolledWeather, IsServedLikeAMeter) {
  loop_.run_for(hours{2} + minutes{1});
  const Json roof = get_json("/api/v1/meters/roof");
  EXPECT_EQ(roof["state"], "up");
  EXPECT_EQ(roof["unit"], 3);
  EXPECT_EQ(roof["poll_s"], 60);
  EXPECT_GT(roof["open_month_coverage"].get<double>(), 0.0);
  EXPECT_NEAR(roof["weather"]["dry_bulb_C"]["now"].get<double>(),
              testing::usual_weather(2.0).dry_bulb_C, 0.1);
  EXPECT_THAT(get_json("/api/v1/intervals", {{"meter", "roof.ghi_W_m2"}})["intervals"], SizeIs(8));
  EXPECT_THAT(get("/").body, HasSubstr("°C, "));
  // A channel that its map does not give is none, and asking makes none.
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "roof.dni_W_m2"}}), "404 not_found meter");
  const http::Response response =
      answer(served_, {.method = http::Method::post,
                       .path = "/api/v1/readings",
                       .body = R"({"meter":"roof","unit":"degC","readings":[
                               {"time":"2024-03-30T10:00:00Z","value":7.5}]})"});
  EXPECT_EQ(response.status, 409);
  EXPECT_THAT(response.body, HasSubstr("has source = \\\"modbus\\\""));
}

}  // namespace
}  // namespace recald::daemon::pushed_weather_test
