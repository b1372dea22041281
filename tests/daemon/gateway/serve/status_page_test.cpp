#include "daemon/gateway/serve/status_page.hpp"

#include <gmock/gmock.h>

#include "daemon/gateway/serve/readiness.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

using Page = ServedSite;

TEST_F(Page, SaysHowItIs) {
  loop_.run_for(hours{2} + seconds{30});
  const http::Response page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  EXPECT_THAT(page.body,
              AllOf(StartsWith("<!doctype html><html lang=\"en\">"), HasSubstr("name=\"viewport\""),
                    HasSubstr("As of 2024-03-30 09:00 −05:00; times are in America/Chicago."),
                    HasSubstr("✔ All 2 polled meters answer."),
                    HasSubstr("<td class=\"good\" data-label=\"State\">✔ up</td>"),
                    HasSubstr("30 s ago"), HasSubstr("2024-03-30 08:45 −05:00 ok")));
}

TEST_F(Page, WhatTheSiteIsCalledIsText) {
  EXPECT_THAT(get("/").body, AllOf(HasSubstr("Tower &lt;3&gt;"), Not(HasSubstr("<3>"))));
}

// The policy in the header forbids what this page must therefore not contain.
TEST_F(Page, NeedsNeitherScriptNorInlineStyle) {
  EXPECT_THAT(get("/").body,
              AllOf(Not(HasSubstr("<script")), Not(HasSubstr("<style")), Not(HasSubstr("style=\"")),
                    Not(HasSubstr("http://")), HasSubstr("href=\"/style.css\"")));
  EXPECT_EQ(get("/style.css").content_type, "text/css; charset=utf-8");
}

TEST_F(Page, WhatIsWrongStandsAtTheTop) {
  devices_.erase(2);
  begin();
  loop_.run_for(hours{1});
  store_.refuses = true;
  loop_.run_for(hours{1});
  const std::string page = get("/").body;
  EXPECT_THAT(page, HasSubstr("▲ 1 of 2 polled meters answer only sometimes or not at all"));
  EXPECT_THAT(page, HasSubstr("✖ Not ready: the store refuses writes: database or disk is full; "));
  EXPECT_THAT(page, HasSubstr("✖ down"));
  EXPECT_THAT(page, HasSubstr("The events cannot be read"));
}

TEST_F(Page, EventsAndJobs) {
  ASSERT_TRUE(disk_.commit(
      {.events = {{kStart, Severity::warning, "counter_reset", "main", "Reset & went on."}}}));
  ASSERT_TRUE(disk_.add_job({.state = JobState::failed,
                             .asked_by = "api",
                             .asked = kStart,
                             .message = "too few months"}));
  EXPECT_THAT(get("/").body, AllOf(HasSubstr("Reset &amp; went on."), HasSubstr("▲ warning"),
                                   HasSubstr("Last calibrations"), HasSubstr("too few months")));
}

TEST_F(Page, TimesAreThoseOfTheSite) {
  const auto at = [&](metering::Instant t) { return site_time_text(calendar_, t); };
  const metering::Instant change =
      std::chrono::sys_days{std::chrono::year{2024} / 3 / 10} + hours{8};
  EXPECT_EQ(at(change - minutes{1}), "2024-03-10 01:59 −06:00");
  EXPECT_EQ(at(change), "2024-03-10 03:00 −05:00");
  EXPECT_EQ(at(metering::Instant{seconds{5}}), "1970-01-01T00:00:05Z");
}

TEST(AgeText, InTheUnitThatFits) {
  EXPECT_EQ(age_text(seconds{0}), "0 s");
  EXPECT_EQ(age_text(seconds{119}), "119 s");
  EXPECT_EQ(age_text(minutes{2}), "2 min");
  EXPECT_EQ(age_text(hours{2}), "2 h");
  EXPECT_EQ(age_text(hours{48}), "2 days");
  EXPECT_EQ(age_text(seconds{-1}), "in the future");
}

using Readiness = ServedSite;

TEST_F(Readiness, AliveIsNotReady) {
  EXPECT_EQ(get("/healthz").status, 200);
  EXPECT_EQ(get_json("/readyz")["status"], "ready");
  store_.refuses = true;
  loop_.run_for(hours{1});
  EXPECT_EQ(get("/healthz").status, 200);
  const http::Response response = get("/readyz");
  EXPECT_EQ(response.status, 503);
  EXPECT_THAT(response.body, HasSubstr("the store refuses writes: database or disk is full"));
  store_.refuses = false;
  loop_.run_for(minutes{1});
  EXPECT_EQ(get("/readyz").status, 200);
}

TEST_F(Readiness, AClockThatIsNotSet) {
  loop_.set_wall_clock(-hours{24 * 365 * 54});
  begin();
  const Json json = Json::parse(get("/readyz").body);
  EXPECT_EQ(json["status"], "not ready");
  EXPECT_THAT(json["reasons"].at(0).get<std::string>(), HasSubstr("the system clock is not set"));
  EXPECT_EQ(get("/").status, 200);  // and people can read why
  EXPECT_EQ(get("/metrics").status, 200);
}

TEST_F(Readiness, RefusedRegistersDeserveALook) {
  devices_[1].exception = [](auto) { return 2; };
  begin();
  loop_.run_for(minutes{5});
  const Json json = get_json("/readyz");
  EXPECT_THAT(json["look_at"].dump(), HasSubstr("meter 'main' refuses registers 0 to 3 with "
                                                "exception 2 (illegal data address) since 2024"));
  EXPECT_EQ(get_json("/api/v1/meters/main")["refused"].at(0)["exception"], 2);
  EXPECT_EQ(get_json("/api/v1/meters/main")["state"], "degraded");
  EXPECT_THAT(get("/").body, HasSubstr("exception 2 (illegal data address)"));
}

TEST_F(Readiness, ABusyDeviceAndOneThatItsGatewayDoesNotReachDeserveALook) {
  devices_[1].exception = [](auto) { return 6; };
  devices_[2].exception = [](auto) { return 11; };
  begin();
  loop_.run_for(minutes{4});
  EXPECT_EQ(get_json("/readyz")["look_at"].size(), 0u);
  loop_.run_for(minutes{10});
  const Json look_at = get_json("/readyz")["look_at"];
  ASSERT_EQ(look_at.size(), 2u) << look_at;
  EXPECT_THAT(look_at[0].get<std::string>(),
              StartsWith("meter 'main' has been busy at every request for registers 0 to 3 with "
                         "exception 6 (device busy) since 2024-03-30T12:00:00Z"));
  EXPECT_THAT(look_at[1].get<std::string>(),
              StartsWith("meter 'cooling' cannot be reached by its gateway, which answers requests "
                         "for registers 0 to 3 with exception 11 ("));
  EXPECT_EQ(get_json("/api/v1/meters/main")["state"], "degraded");
  EXPECT_EQ(get_json("/api/v1/meters/cooling")["state"], "down");
}

TEST_F(Readiness, ASilentMeterIsNoReason) {
  devices_.clear();
  begin();
  loop_.run_for(hours{1});
  EXPECT_EQ(get("/readyz").status, 200);
}

}  // namespace
}  // namespace recald::daemon
