/// What a broker gets to keep of a site.
#include "daemon/gateway/forward/state_messages.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "daemon/gateway/registers/register_table.hpp"

namespace recald::daemon::state_messages_test {
namespace {

using Json = nlohmann::json;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SiteConfig site_with(const std::string& mqtt) {
  auto site = parse_site("[site]\nid = \"depot\"\ntimezone = \"Europe/Berlin\"\n[mqtt]\n" + mqtt +
                             "[[meter]]\nid = \"main\"\nsource = \"http\"\nutility = "
                             "\"electricity\"\n",
                         "/nowhere/site.toml");
  if (!site) throw std::runtime_error(site.error().front());
  return *site;
}

TEST(StateMessages, HaveWhatTheRegistersHaveInWords) {
  const SiteConfig site = site_with("url = \"mqtt://localhost\"\ntopic = \"buildings/north\"\n");
  SiteFacts facts;
  facts.quality = SiteQuality::to_look_at;
  facts.drift.state = DriftState::alarm;
  facts.drift.alarm = AlarmCode::meter;
  facts.meters.resize(1);
  facts.meters[0].power_kW = 12.5;
  facts.meters[0].open.forecast_kWh.q50 = 240.0;
  const auto messages = state_messages(site, facts);
  ASSERT_THAT(messages, SizeIs(2));
  EXPECT_EQ(messages[0].topic, "buildings/north/depot/state");
  EXPECT_TRUE(messages[0].is_retained);
  const Json whole = Json::parse(messages[0].payload);
  EXPECT_EQ(whole["quality"], "something should be looked at");
  EXPECT_EQ(whole["drift_state"], "an alarm is open");
  EXPECT_EQ(whole["alarm_code"], 4);
  EXPECT_EQ(whole["alarm"], "the meter, not the building");
  EXPECT_EQ(whole["model_age_d"], nullptr);
  EXPECT_FALSE(whole.contains("uptime_s"));
  EXPECT_EQ(messages[1].topic, "buildings/north/depot/meter/main/state");
  const Json meter = Json::parse(messages[1].payload);
  EXPECT_EQ(meter["power_kW"], 12.5);
  EXPECT_EQ(meter["month_forecast_q50_kWh"], 240.0);
  EXPECT_EQ(meter["expected_q50_kW"], nullptr);
  EXPECT_EQ(meter["register_kWh"], nullptr);
}

// The same value twice is not published twice, so nothing in it may only be the time.
TEST(StateMessages, AreTheSameAsLongAsNothingChanges) {
  const SiteConfig site = site_with("url = \"mqtt://localhost\"\n");
  SiteFacts facts;
  facts.meters.resize(1);
  const auto before = state_messages(site, facts);
  facts.uptime += std::chrono::seconds{60};
  facts.time += std::chrono::seconds{60};
  EXPECT_EQ(state_messages(site, facts), before);
  facts.meters[0].power_kW = 1.0;
  EXPECT_NE(state_messages(site, facts), before);
}

TEST(StateMessages, HomeAssistantIsToldOnRequest) {
  EXPECT_THAT(discovery_messages(site_with("url = \"mqtt://localhost\"\n")), IsEmpty());
  const SiteConfig site =
      site_with("url = \"mqtt://localhost\"\nhome_assistant = \"homeassistant\"\n");
  SiteFacts facts;
  facts.meters.resize(1);
  std::map<std::string, Json> states;
  for (const mqtt::Message& one : state_messages(site, facts)) {
    states[one.topic] = Json::parse(one.payload);
  }
  const auto messages = discovery_messages(site);
  EXPECT_THAT(messages, SizeIs(12));
  for (const mqtt::Message& one : messages) {
    EXPECT_TRUE(one.is_retained);
    EXPECT_TRUE(one.topic.starts_with("homeassistant/sensor/recald_depot")) << one.topic;
    const Json config = Json::parse(one.payload);
    ASSERT_TRUE(states.contains(config["state_topic"])) << config;
    const std::string shown = config["value_template"];  // {{ value_json.KEY }}
    const std::string key = shown.substr(14, shown.size() - 17);
    EXPECT_TRUE(states[config["state_topic"]].contains(key)) << key;
  }
}

}  // namespace
}  // namespace recald::daemon::state_messages_test
