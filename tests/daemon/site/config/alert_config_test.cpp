#include "daemon/site/config/service/alert_config.hpp"

#include <gmock/gmock.h>

#include "daemon/site/config/service/alert_kinds.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon::alert_config_test {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

tl::expected<SiteConfig, Problems> load(const std::string& alerts) {
  return parse_site(
      "[site]\nid = \"depot\"\ntimezone = \"Europe/Berlin\"\n[[meter]]\nid = \"main\"\nsource = "
      "\"http\"\nutility = \"electricity\"\n[alerts]\n" +
          alerts,
      "/etc/depot/site.toml");
}

void expect_refused(const std::string& alerts, const std::string& said) {
  SCOPED_TRACE(alerts);
  const auto site = load(alerts);
  ASSERT_FALSE(site.has_value());
  EXPECT_THAT(site.error(), Contains(HasSubstr(said)));
}

std::string mail(const std::string& server, const std::string& more = "") {
  return "[[alerts.mail]]\nserver = \"" + server + "\"\nfrom = \"a@b\"\nto = \"c@d\"\n" + more;
}

TEST(AlertConfigTest, SaysWhoIsToldOfWhat) {
  const auto site =
      load("pages = \"https://gw.example.org/\"\nquiet = \"22:00-07:00\"\n" +
           mail("smtp://mail.example.org:587", "user = \"u\"\npassword_file = \"secret\"\n") +
           "[[alerts.webhook]]\nurl = \"https://hooks.example.org/x\"\n");
  ASSERT_TRUE(site.has_value()) << site.error().front();
  const AlertConfig& alerts = site->alerts;
  EXPECT_EQ(alerts.pages, "https://gw.example.org");
  ASSERT_EQ(alerts.destinations.size(), 2);
  EXPECT_EQ(std::get<WebhookConfig>(alerts.destinations[0]).url, "https://hooks.example.org/x");
  const auto& to = std::get<MailConfig>(alerts.destinations[1]);
  EXPECT_EQ(to.password_file, "/etc/depot/secret");
  EXPECT_TRUE(to.encrypts);
  EXPECT_THAT(to.to, ElementsAre("c@d"));
  EXPECT_THAT(alerts.about, Contains("drift_alarm"));
  EXPECT_THAT(alerts.about, Not(Contains("clock_set")));
}

TEST(AlertConfigTest, QuietHoursGoOverMidnight) {
  const QuietHours night{hours{22}, hours{7}};
  EXPECT_TRUE(night.contain(hours{22}));
  EXPECT_TRUE(night.contain(hours{3}));
  EXPECT_FALSE(night.contain(hours{7}));
  EXPECT_FALSE(night.contain(hours{12}));
  const QuietHours noon{hours{12}, hours{13}};
  EXPECT_TRUE(noon.contain(hours{12} + minutes{30}));
  EXPECT_FALSE(noon.contain(hours{13}));
}

TEST(AlertConfigTest, AMailServerOnThisMachineNeedsNoEncryption) {
  const auto site = load(mail("smtp://localhost"));
  ASSERT_TRUE(site.has_value());
  EXPECT_FALSE(std::get<MailConfig>(site->alerts.destinations[0]).encrypts);
}

TEST(AlertConfigTest, WhatCannotWorkIsRefused) {
  expect_refused("", "there is nobody to tell; add [[alerts.webhook]] or [[alerts.mail]]");
  expect_refused("quiet = \"22-7\"\n" + mail("smtp://m"), "'quiet' is \"22-7\"; write two");
  expect_refused("about = [\"nonsense\"]\n" + mail("smtp://m"),
                 "'about' has \"nonsense\"; the kinds");
  expect_refused(mail("mail.example.org"), "'server' is \"mail.example.org\"; write an address");
  expect_refused(mail("smtp://m", "user = \"u\"\n"), "'user' and 'password_file' belong together");
  expect_refused(mail("smtp://m", "encrypt = false\nuser = \"u\"\npassword_file = \"p\"\n"),
                 "the password would be sent without encryption");
  expect_refused("[[alerts.webhook]]\nurl = \"htps://hooks.example.org/secret\"\n",
                 "'url' is no address of http or https");
  expect_refused("[[alerts.webhook]]\nurl = \"http://h.example.org\"\ntoken_file = \"t\"\n",
                 "would send the token without encryption; use https");
  for (const char* bad : {"a", "@b", "a@", "a@b@c", "a b@c", "<a@b>", "a@b,c@d"}) {
    expect_refused("[[alerts.mail]]\nserver = \"smtp://m\"\nfrom = \"a@b\"\nto = \"" +
                       std::string{bad} + "\"\n",
                   "'to' has \"" + std::string{bad} + "\"; write a mail address");
  }
}

TEST(AlertKindsTest, AreFoundByTheirNames) {
  ASSERT_NE(find_alert_kind("drift_alarm"), nullptr);
  EXPECT_EQ(find_alert_kind("alert_sent"), nullptr);
}

}  // namespace
}  // namespace recald::daemon::alert_config_test
