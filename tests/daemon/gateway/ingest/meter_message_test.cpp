/// Messages of a broker as values of meters.
#include "daemon/gateway/ingest/meter_message.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace recald::daemon::meter_message_test {
namespace {

using metering::Instant;
using std::chrono::hours;
using std::chrono::seconds;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Instant kNoon = std::chrono::sys_days{std::chrono::year{2026} / 2 / 3} + hours{12};

const SiteConfig& site() {
  static const SiteConfig kSite = [] {
    auto site = parse_site(R"(
[site]
id = "depot"
timezone = "Europe/Berlin"
[mqtt]
url = "mqtt://127.0.0.1"
[[meter]]
id = "main"
source = "mqtt"
utility = "electricity"
rated_kW = 100
energy_from = { topic = "plant/main", pointer = "/energy/total", time_pointer = "/time", unit = "MWh" }
power_from = { topic = "plant/main", pointer = "/power", time_pointer = "/time", unit = "W" }
[[meter]]
id = "pump"
source = "mqtt"
utility = "electricity"
power_from = { topic = "plant/pump", unit = "kW" }
[[meter]]
id = "fan"
source = "mqtt"
utility = "electricity"
power_from = { topic = "plant/fan", pointer = "/watts/0", unit = "W" }
)",
                           "/nowhere/site.toml");
    if (!site) throw std::runtime_error(site.error().front());
    return *site;
  }();
  return kSite;
}

MeterMessage read(std::string_view topic, std::string_view payload, bool is_retained = false) {
  return parse_meter_message(site(), topic, payload, is_retained, kNoon);
}

std::vector<double> values(const MeterMessage& told) {
  std::vector<double> all;
  for (const MeterValue& value : told.values) all.push_back(value.value);
  return all;
}

TEST(MeterMessage, NamesItsTopicsOnce) {
  EXPECT_THAT(meter_topics(site()), ElementsAre("plant/fan", "plant/main", "plant/pump"));
}

TEST(MeterMessage, AMessageMayHaveSeveralValuesAndATime) {
  const auto told = read(
      "plant/main", R"({"time":"2026-02-03T12:59:00+01:00","energy":{"total":12.5},"power":850})");
  ASSERT_THAT(values(told), ElementsAre(DoubleEq(12'500.0), DoubleEq(0.85)));
  EXPECT_THAT(told.refusals, IsEmpty());
  EXPECT_TRUE(told.values[0].is_counter);
  EXPECT_FALSE(told.values[1].is_counter);
  EXPECT_EQ(told.values[0].meter, "main");
  EXPECT_EQ(told.values[0].measured, kNoon - seconds{60});
}

TEST(MeterMessage, ThePayloadMayBeTheNumber) {
  EXPECT_THAT(values(read("plant/pump", "4.25")), ElementsAre(4.25));
  EXPECT_THAT(values(read("plant/pump", " -4e0\r\n")), ElementsAre(-4.0));
  EXPECT_EQ(read("plant/pump", "4.25").values.at(0).measured, std::nullopt);
  EXPECT_THAT(values(read("plant/fan", R"({"watts":["1500"]})")), ElementsAre(1.5));
}

TEST(MeterMessage, TimesAreSecondsOrMillisecondsToo) {
  const auto at = kNoon.time_since_epoch().count();
  for (const std::string& time : {std::to_string(at), std::to_string(at) + "000"}) {
    const auto told = read("plant/main", R"({"power":1,"time":)" + time + "}");
    ASSERT_THAT(told.values, SizeIs(1)) << time;
    EXPECT_EQ(told.values[0].measured, kNoon);
  }
}

// It may be of any age: whoever subscribes gets it at once.
TEST(MeterMessage, ARetainedMessageCountsOnlyWithATime) {
  EXPECT_THAT(read("plant/pump", "4.25", true).values, IsEmpty());
  EXPECT_THAT(read("plant/pump", "4.25", true).refusals, IsEmpty());
  EXPECT_THAT(read("plant/main", R"({"power":1,"time":"2026-02-03T11:59:00Z"})", true).values,
              SizeIs(1));
}

TEST(MeterMessage, WhatIsNotThereIsNoFault) {
  for (const char* payload : {"{}", R"({"watts":[]})", R"({"watts":[null]})", R"({"watts":3})"}) {
    EXPECT_THAT(read("plant/fan", payload).values, IsEmpty()) << payload;
    EXPECT_THAT(read("plant/fan", payload).refusals, IsEmpty()) << payload;
  }
  EXPECT_THAT(read("plant/other", "4.25").values, IsEmpty());
}

TEST(MeterMessage, WhatCannotBeReadIsSaid) {
  const auto why = [](std::string_view topic, std::string_view payload) {
    const auto told = read(topic, payload);
    EXPECT_THAT(told.values, IsEmpty()) << payload;
    return told.refusals.empty() ? std::string{"nothing"} : told.refusals.front().why;
  };
  EXPECT_EQ(why("plant/pump", "4,25"), "the message '4,25' of 'plant/pump' is no number");
  EXPECT_THAT(why("plant/pump", ""), HasSubstr("is no number"));
  EXPECT_THAT(why("plant/pump", "NaN"), HasSubstr("is no number"));
  EXPECT_THAT(why("plant/pump", "1e300"), HasSubstr("is more than any meter counts"));
  EXPECT_THAT(why("plant/fan", "{"), HasSubstr("is no JSON"));
  EXPECT_THAT(why("plant/fan", std::string(100'000, '[')), HasSubstr("is no JSON"));
  EXPECT_THAT(why("plant/fan", R"({"watts":[true]})"), HasSubstr("is no number under '/watts/0'"));
  EXPECT_THAT(why("plant/main", R"({"power":1})"), HasSubstr("has no time under '/time'"));
  EXPECT_THAT(
      why("plant/main", R"({"power":1,"time":"2026-02-03T12:06:00Z"})"),
      HasSubstr("is stamped 2026-02-03T12:06:00Z, but the clock says 2026-02-03T12:00:00Z"));
  EXPECT_THAT(why("plant/main", R"({"power":1,"time":5})"), HasSubstr("is stamped 1970-01-01"));
}

}  // namespace
}  // namespace recald::daemon::meter_message_test
