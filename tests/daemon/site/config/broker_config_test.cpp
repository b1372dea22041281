/// The brokers of a site file: [mqtt] and [fleet] are read alike.
#include "daemon/site/config/service/broker_config.hpp"

#include <gmock/gmock.h>

#include "daemon/site/config/site_config.hpp"

namespace recald::daemon::broker_config_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

auto parse(const std::string& tables) {
  return parse_site("[site]\nid = \"tower\"\ntimezone = \"Europe/Berlin\"\n" + tables +
                        "\n[[meter]]\nid = \"main\"\nsource = \"http\"\nutility = \"gas\"\n",
                    "/sites/tower.toml");
}

TEST(BrokerConfig, AFleetHasABrokerOfItsOwn) {
  const auto site = parse(R"([mqtt]
url = "mqtt://localhost"
[fleet]
url = "mqtts://fleet.example.org:8884"
user = "tower"
password_file = "secret"
trusted_certificate = "ca.pem")");
  ASSERT_TRUE(site.has_value()) << site.error().front();
  EXPECT_EQ(site->mqtt->broker.where(), "localhost:1883");
  EXPECT_EQ(site->mqtt->broker.client_id, "recald-tower");
  ASSERT_TRUE(site->fleet.has_value());
  EXPECT_EQ(site->fleet->where(), "fleet.example.org:8884");
  EXPECT_TRUE(site->fleet->is_tls);
  EXPECT_EQ(site->fleet->client_id, "fleet-recald-tower");
  EXPECT_EQ(site->fleet->login.password_file, "/sites/secret");
  EXPECT_EQ(site->fleet->trusted_certificate, "/sites/ca.pem");
  EXPECT_FALSE(parse("")->fleet.has_value());
}

TEST(BrokerConfig, WhatIsWrongIsNamed) {
  const std::vector<std::pair<const char*, const char*>> all{
      {"", "url"},
      {"url = \"http://localhost\"", "'url' is no address of a broker"},
      {"url = \"mqtt://h\"\nuser = \"u\"\npassword_file = \"p\"",
       "'url' would send the password without encryption; use mqtts"},
      {"url = \"mqtt://h\"\nencrypt = false\ntrusted_certificate = \"ca.pem\"",
       "'trusted_certificate' belongs to an encrypted connection"},
      {"url = \"mqtts://h\"\nkey_file = \"k\"", "'certificate_file' and 'key_file' belong"},
      {"url = \"mqtts://h\"\nclient_id = \"a b\"",
       "'client_id' is \"a b\"; write one word such as"}};
  for (const char* table : {"[mqtt]\n", "[fleet]\n"}) {
    for (const auto& [keys, said] : all) {
      const auto site = parse(std::string{table} + keys);
      ASSERT_FALSE(site.has_value()) << table << keys;
      EXPECT_THAT(site.error(), Contains(HasSubstr(said))) << table;
    }
  }
  EXPECT_THAT(parse("[fleet]\nurl = \"mqtts://h\"\ntopic = \"x\"").error(),
              Contains(HasSubstr("unknown key 'topic'")));
}

// Of each kind of destination: what leaves this machine unencrypted is said to be meant.
TEST(Destinations, BeyondThisMachineTheyAreEncryptedOrSayThatTheyAreNot) {
  const std::vector<std::pair<std::string, std::string>> all{
      {"[mqtt]\nurl = \"mqtt", "\"\n"},
      {"[fleet]\nurl = \"mqtt", "\"\n"},
      {"[[alerts.webhook]]\nurl = \"http", "/hook\"\n"},
      {"[[remote_write]]\nprotocol = \"prometheus\"\nurl = \"http", "/write\"\n"}};
  for (const auto& [begin, end] : all) {
    const auto with = [&](const std::string& host, const std::string& more = "") {
      return parse(begin + host + end + more).has_value();
    };
    for (const char* here :
         {"://localhost", "://127.0.0.1:99", "://[::1]:99", "s://h.example.org"}) {
      EXPECT_TRUE(with(here)) << begin << here;
    }
    for (const char* elsewhere : {"://h", "://10.0.0.5", "://127.0.0.1.example.org",
                                  "://127.example", "://[2001:db8::1]"}) {
      const auto site = parse(begin + elsewhere + end);
      ASSERT_FALSE(site.has_value()) << begin << elsewhere;
      EXPECT_THAT(site.error(), Contains(HasSubstr("or add encrypt = false"))) << begin;
      EXPECT_TRUE(with(elsewhere, "encrypt = false\n")) << begin << elsewhere;
      EXPECT_FALSE(with(elsewhere, "encrypt = true\n")) << begin << elsewhere;
    }
  }
}

TEST(BrokerConfig, TwoConnectionsToOneBrokerHaveTwoNames) {
  const auto with = [](const char* url) {
    return parse("[mqtt]\nurl = \"mqtts://h\"\n[fleet]\nurl = \"" + std::string{url} +
                 "\"\nclient_id = \"recald-tower\"");
  };
  EXPECT_THAT(with("mqtts://h").error(), Contains(HasSubstr("as in [mqtt] at the same broker")));
  EXPECT_TRUE(with("mqtts://other").has_value());
}

}  // namespace
}  // namespace recald::daemon::broker_config_test
