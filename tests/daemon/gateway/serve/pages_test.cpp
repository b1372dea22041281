#include "daemon/gateway/serve/pages/pages.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "adapters/http/dress.hpp"
#include "adapters/models/model_store.hpp"
#include "adapters/system/files/write_file.hpp"
#include "daemon/gateway/serve/api/readiness.hpp"
#include "daemon/gateway/serve/pages/page_frame.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using std::chrono::days;
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

// The policy in the header forbids what these pages must therefore not contain.
TEST_F(Page, HasNoScriptOrStyleInlineAndNothingFromElsewhere) {
  loop_.run_for(hours{30});
  for (const char* path : {"/", "/meters/main", "/months", "/events"}) {
    EXPECT_THAT(
        get(path).body,
        AllOf(Not(HasSubstr("<script>")), Not(HasSubstr("<style")), Not(HasSubstr("style=\"")),
              Not(HasSubstr(" onclick")), Not(HasSubstr("http://")), Not(HasSubstr("https://")),
              HasSubstr("href=\"/style.css\""), HasSubstr("src=\"/page.js\"")))
        << path;
  }
  EXPECT_EQ(get("/style.css").content_type, "text/css; charset=utf-8");
  EXPECT_EQ(get("/page.js").content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/favicon.ico").status, 204);  // a browser asks in any case
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

TEST_F(Page, TheWeekIsDrawnWithoutAScript) {
  loop_.run_for(hours{30});
  const std::string page = get("/").body;
  EXPECT_THAT(page,
              HasSubstr("<a href=\"/meters/main\">main</a></figcaption><svg class=\"chart\""));
  EXPECT_THAT(page, HasSubstr("<title>main, mean of 15 minutes</title>"));
  EXPECT_THAT(page, HasSubstr("<path class=\"chart-line\" d=\"M"));
}

TEST_F(Page, OfAMeterHasItsHistoryAndItsMonths) {
  pass_months(days{35});
  const std::string week = get("/meters/main").body;
  EXPECT_THAT(week, AllOf(HasSubstr("<h1>main</h1>"), HasSubstr("main, mean of an hour"),
                          HasSubstr("Apr 2024"), HasSubstr("1,445\u00a0kWh/day"),
                          HasSubstr("format=csv\">These intervals as CSV")));
  const std::string day = get("/meters/main", {{"from", "2024-04-02"}, {"to", "2024-04-03"}}).body;
  EXPECT_THAT(day, AllOf(HasSubstr("main, mean of 15 minutes"), HasSubstr("value=\"2024-04-02\"")));
  EXPECT_THAT(get("/meters/main", {{"from", "1999-01-01"}, {"to", "1999-01-02"}}).body,
              HasSubstr("No valid readings in this time."));
  EXPECT_THAT(get("/meters/old").body, HasSubstr("Its readings are in files"));
  EXPECT_EQ(get("/meters/none").status, 404);
  EXPECT_EQ(get("/meters/main", {{"from", "soon"}}).status, 400);
  EXPECT_EQ(get("/meters/main", {{"from", ""}, {"to", ""}}).body, week);  // emptied fields
  EXPECT_THAT(get("/meters/main", {{"from", "2030-01-01"}}).body,
              HasSubstr("No valid readings in this time."));
  EXPECT_THAT(get("/meters/main", {{"from", "2014-05-01"}, {"to", "2024-05-01"}}).body,
              HasSubstr("The first 10,000 of these intervals as CSV"));
}

/// What the script gets beside the first zoomable chart of a page.
Json chart_data(const std::string& page) {
  const std::string begin = "<script type=\"application/json\">";
  const std::size_t at = page.find(begin);
  if (at == std::string::npos) return {};
  const std::size_t from = at + begin.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST_F(Page, OfAMeterHasItsNumbersForTheScriptThatZooms) {
  pass_months(days{35});
  const std::string page = get("/meters/main").body;
  EXPECT_THAT(page, AllOf(HasSubstr("<div class=\"zoomable\"><svg class=\"chart\""),
                          HasSubstr("<script src=\"/charts.js\" defer></script>")));
  const Json data = chart_data(page);
  EXPECT_EQ(data["title"], "main, mean of an hour");
  EXPECT_EQ(data["unit"], "kW");
  EXPECT_EQ(data["finer"]["address"], "/api/v1/history?meter=main");
  EXPECT_EQ(data["finer"]["interval_s"], 900);
  // From midnight at the site, five hours behind UTC.
  const std::int64_t begin = data["span"][0];
  EXPECT_EQ(begin % 86'400, 5 * 3600);
  EXPECT_EQ(data["offsets"], Json::array({{begin, -5 * 3600}}));
  const Json& point = data["points"][0];
  EXPECT_EQ(point[0], begin);
  EXPECT_EQ(point[1], begin + 3600);
  EXPECT_NEAR(point[3].get<double>(), 60.2, 0.1);
  EXPECT_LT(point[2], point[4]);
}

TEST_F(Page, OnlyWithAChartToZoomLoadsTheScriptForIt) {
  loop_.run_for(hours{30});
  for (const char* path : {"/", "/months", "/model", "/events", "/meters/old"}) {
    EXPECT_THAT(get(path).body, Not(HasSubstr("charts.js"))) << path;
  }
  EXPECT_THAT(get("/meters/main", {{"from", "1999-01-01"}, {"to", "1999-01-02"}}).body,
              Not(HasSubstr("charts.js")));
  EXPECT_THAT(get("/").body, HasSubstr("<a href=\"/meters/main\">main</a></figcaption>"));
  const http::Response script = get("/charts.js");
  EXPECT_EQ(script.content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(script.header("cache-control"), "private, max-age=3600");
  EXPECT_THAT(script.body, AllOf(StartsWith("/*\nApache ECharts"), HasSubstr("zoomable")));
}

// As it goes over the network: the first view is what is read before the script comes.
TEST_F(Page, OfAMeterIsSmall) {
  devices_[1].energy_kWh = [](std::chrono::milliseconds t) {
    const double hour = testing::hours_of(t);
    return 60.0 * hour + 20.0 * std::sin(0.9 * hour) + 2.0 * std::sin(17.3 * hour);
  };
  pass_months(days{35});
  const auto sent = [&](const std::string& path, std::map<std::string, std::string> query = {}) {
    http::Request request{.path = path, .query = std::move(query)};
    request.headers.emplace("accept-encoding", "gzip");
    return http::dressed(request, answer(served_, request)).body.size();
  };
  // Four days of quarter hours: as many points as a chart may have.
  const std::size_t first_view =
      sent("/meters/main", {{"from", "2024-04-02"}, {"to", "2024-04-06"}}) + sent("/style.css") +
      sent("/page.js");
  const std::size_t whole = first_view + sent("/charts.js");
  RecordProperty("first_view_bytes", static_cast<int>(first_view));
  RecordProperty("whole_bytes", static_cast<int>(whole));
  EXPECT_LE(first_view, 150'000u);
  EXPECT_LE(whole, 500'000u);
  EXPECT_GT(whole, 100'000u);  // it is there
}

TEST_F(Page, OfMonthsHasWhatWasForecastAndWhatCame) {
  EXPECT_THAT(get("/months").body, HasSubstr("There are no forecasts yet."));
  const auto forecast = [](unsigned month, double measured) {
    return StoredForecast{.output = "main_daily_kWh",
                          .month = std::chrono::year{2024} / static_cast<int>(month),
                          .made = kStart,
                          .mean = 100.0,
                          .sd = 5.0,
                          .q05 = 92.0,
                          .q50 = 100.0,
                          .q95 = 108.0,
                          .measured = measured};
  };
  const std::array both{forecast(1, 104.0), forecast(2, 120.0)};
  ASSERT_TRUE(disk_.add_forecasts(both));
  const std::string page = get("/months").body;
  EXPECT_THAT(
      page, AllOf(HasSubstr("<h2>Main, daily mean</h2>"), HasSubstr("chart-mark"),
                  HasSubstr("<script src=\"/charts.js\" defer></script>"),
                  HasSubstr("92.00 to 108.0\u00a0kWh/day"), HasSubstr("✔ yes"), HasSubstr("▲ no")));
  const Json data = chart_data(page);
  EXPECT_EQ(data["points"].size(), 2u);
  EXPECT_EQ(data["marks"][1][2], 120.0);
  EXPECT_EQ(data["words"]["mark"], "Measured");
  EXPECT_TRUE(data["finer"].is_null());
}

TEST_F(Page, OfEventsShowsWhatIsAskedFor) {
  ASSERT_TRUE(disk_.commit({.events = {{kStart, Severity::warning, "a", "main", "Reset & went on."},
                                       {kStart, Severity::info, "b", "cooling", "All is well."}}}));
  const auto page = [&](std::map<std::string, std::string> query) {
    return get("/events", std::move(query)).body;
  };
  EXPECT_THAT(page({}), AllOf(HasSubstr("Reset &amp; went on."), HasSubstr("All is well.")));
  EXPECT_THAT(page({{"severity", "warning"}}),
              AllOf(HasSubstr("Reset"), Not(HasSubstr("All is well."))));
  EXPECT_THAT(page({{"subject", "cooling"}}),
              AllOf(Not(HasSubstr("Reset")), HasSubstr("All is well.")));
  EXPECT_THAT(page({{"text", "IS WELL"}}),
              AllOf(Not(HasSubstr("Reset")), HasSubstr("All is well.")));
  EXPECT_THAT(page({{"text", "\"><script>"}}),
              AllOf(HasSubstr("No event is like that."), HasSubstr("&quot;&gt;&lt;script&gt;"),
                    Not(HasSubstr("\"><script>"))));
  EXPECT_EQ(refused("/events", {{"sevrity", "warning"}}), "400 unknown_parameter sevrity");
}

TEST_F(Page, OfTheModelLinksReportsAndOnlyFilesOfJobs) {
  const recald::testing::TemporaryFolder folder;
  ASSERT_TRUE(system::write_file(folder / "report.html", "<p>It said so."));
  ASSERT_TRUE(system::write_file(folder / "secret.toml", "token"));
  const auto number = disk_.add_job({.state = JobState::done,
                                     .asked = kStart,
                                     .accepted = true,
                                     .folder = folder.path().string()});
  ASSERT_TRUE(number);
  const std::string address = "/jobs/" + std::to_string(*number) + "/";
  EXPECT_THAT(get("/").body, AllOf(HasSubstr("<a href=\"" + address + "report.html\">report</a>"),
                                   HasSubstr("✔ in use")));
  ASSERT_TRUE(disk_.add_job({.state = JobState::done, .asked = kStart, .accepted = true}));
  EXPECT_THAT(get("/").body, HasSubstr("✔ accepted"));  // the one before
  const http::Response report = get(address + "report.html");
  EXPECT_EQ(report.body, "<p>It said so.");
  EXPECT_EQ(report.content_type, "text/html; charset=utf-8");
  EXPECT_THAT(std::string{report.header("content-security-policy")}, HasSubstr("sandbox"));
  for (const char* other :
       {"secret.toml", "../report.html", "..", ".html", "diagnosis.html", "", "a/report.html"}) {
    EXPECT_EQ(get(address + other).status, 404) << other;
  }
  EXPECT_EQ(get("/jobs/99/report.html").status, 404);
  EXPECT_EQ(get("/jobs/x/report.html").status, 404);
}

/// A version that a diagnosis has proposed.
std::string propose(const SiteConfig& site) {
  diagnosis::ModelVersion version;
  version.parent = diagnosis::kBaseVersion;
  version.site_id = site.id;
  version.created_at = "2024-03-30T12:00:00Z";
  version.effects = {{.effect = "weekend_operation",
                      .title = "Runs on <weekends>",
                      .physics = "x",
                      .log_evidence_gain = 20.0,
                      .probability = 0.97}};
  const auto saved = models::ModelStore{site.file, site.id}.save(version);
  EXPECT_TRUE(saved.has_value()) << saved.error().message;
  return saved ? saved->version : "";
}

class ModelVersions : public ServedSite {
 protected:
  ModelVersions() {
    site_.file = folder_ / "site.toml";
    site_.model.emplace();
    served_.ask_job = [this](JobKind kind) -> Result<std::int64_t> {
      asked_.push_back(kind);
      return 1;
    };
  }
  http::Response post(const std::string& body) {
    return answer(served_, {.method = http::Method::post, .path = "/api/v1/model", .body = body});
  }

  recald::testing::TemporaryFolder folder_;
  std::vector<JobKind> asked_;
};

TEST_F(ModelVersions, AreAppliedAndTakenBack) {
  EXPECT_EQ(get_json("/api/v1/model")["active"], "drawings");
  const std::string version = propose(site_);
  EXPECT_THAT(get("/model").body, AllOf(Not(HasSubstr("<script>")), Not(HasSubstr("style=\"")),
                                        Not(HasSubstr(" onclick"))));
  const std::string button = "data-body=\"{&quot;activate&quot;:&quot;" + version;
  EXPECT_THAT(get("/model").body, AllOf(HasSubstr("Runs on &lt;weekends&gt; (97.0\u00a0%)"),
                                        HasSubstr("proposed"), HasSubstr(button)));
  const http::Response applied = post(R"({"activate":")" + version + "\"}");
  ASSERT_EQ(applied.status, 200) << applied.body;
  EXPECT_EQ(Json::parse(applied.body)["active"], version);
  EXPECT_EQ(asked_.size(), 1u);  // a calibration that has it
  EXPECT_THAT(get("/model").body, AllOf(HasSubstr("✔ in force"), Not(HasSubstr(button)),
                                        HasSubstr("Go back by one version")));
  EXPECT_EQ(Json::parse(post(R"({"revert":null})").body)["active"], "drawings");
  EXPECT_EQ(asked_.size(), 2u);
}

// A diagnosis starts from the drawings, so it cannot be asked for beside a version of the model.
TEST_F(ModelVersions, JobsAreRequestedByAClick) {
  const std::string version = propose(site_);
  const std::string calibrate = "data-post=\"/api/v1/calibrations\" data-body=\"{}\"";
  const std::string diagnose = "data-post=\"/api/v1/diagnoses\" data-body=\"{}\"";
  EXPECT_THAT(get("/model").body, Not(HasSubstr(diagnose)));  // there is no [building]
  site_.building.emplace();
  EXPECT_THAT(get("/model").body, AllOf(HasSubstr(calibrate), HasSubstr(diagnose)));
  ASSERT_EQ(post(R"({"activate":")" + version + "\"}").status, 200);
  EXPECT_THAT(get("/model").body, AllOf(HasSubstr(calibrate), Not(HasSubstr(diagnose))));
  served_.ask_job = {};
  EXPECT_THAT(get("/model").body, Not(HasSubstr(calibrate)));
}

TEST_F(ModelVersions, WhatIsWrongIsSaidAndChangesNothing) {
  propose(site_);
  EXPECT_EQ(in_short(post("{}")), "400 invalid_value body");
  EXPECT_EQ(in_short(post("[]")), "400 invalid_value body");
  EXPECT_EQ(in_short(post(R"({"activate":7})")), "400 invalid_value body");
  EXPECT_EQ(in_short(post(R"({"activate":"0000","revert":null})")), "400 invalid_value body");
  EXPECT_EQ(in_short(post(R"({"activate":"ffffffffffff"})")), "404 not_found version");
  EXPECT_EQ(in_short(post(R"({"revert":null})")), "409 not_possible version");
  EXPECT_EQ(get_json("/api/v1/model")["active"], "drawings");
  EXPECT_TRUE(asked_.empty());
}

TEST_F(Page, TheWeekIsDrawnBesideWhatTheModelExpects) {
  std::vector<ExpectedMeter> expected{{"main", {}}};
  served_.expected = [&]() -> const auto& { return expected; };
  loop_.run_for(hours{50} + minutes{20});
  EXPECT_THAT(get("/").body, Not(HasSubstr("were outside the band")));
  // Of the last day the model expects six hours otherwise than main's 60 kW.
  const metering::Instant now = kStart + hours{50};
  for (int hour = 50; hour > 0; --hour) {
    const double kW = hour <= 6 ? 90.0 : 60.0;
    expected[0].hours.push_back({now - hours{hour}, {kW - 5.0, kW, kW + 5.0}});
  }
  EXPECT_THAT(
      get("/").body,
      AllOf(HasSubstr("6 of the last 24 hours were outside the band"),
            HasSubstr("main, mean of an hour; the band is what the model of the drawings expects"),
            Not(HasSubstr("▲ 6 of the last"))));
  for (ExpectedHour& hour : expected[0].hours) hour.load = {85.0, 90.0, 95.0};
  EXPECT_THAT(get("/").body, HasSubstr("▲ 24 of the last 24 hours were outside the band"));
}

TEST_F(Page, SaysHowGoodTheDataAre) {
  EXPECT_THAT(get("/data").body, HasSubstr("No month has closed yet."));
  devices_[2].is_silent = [](std::chrono::milliseconds t) {
    return t > hours{24 * 5} && t < hours{24 * 12};
  };
  pass_months(days{40});
  const std::string page = get("/data").body;
  // Of April: main has all of it, and cooling lacks a week, which was filled.
  EXPECT_THAT(page, HasSubstr("Share of each month that was measured"));
  EXPECT_THAT(page, HasSubstr("data-label=\"Apr 2024\">100.0"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number warn\" data-label=\"Apr 2024\">▲ 7"));
  EXPECT_THAT(page, HasSubstr("meter answers 1, meter silent 1"));
}

TEST_F(Page, SaysHowFarTheRunningJobIs) {
  const auto number =
      disk_.add_job({.state = JobState::running, .asked = kStart, .started = kStart});
  ASSERT_TRUE(number);
  loop_.run_for(minutes{3});
  EXPECT_THAT(get("/").body, HasSubstr("A calibration has been running for 3 min."));
  served_.progress = [&] { return JobProgress{*number, 0.6, "calibrating the model"}; };
  EXPECT_THAT(get("/").body, HasSubstr("A calibration has been running for 3 min: 60\u00a0% "
                                       "(calibrating the model); about 2 min left."));
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
  loop_.set_wall_clock(-(kStart.time_since_epoch() - minutes{5}));  // 1969 in Chicago
  begin();
  const Json json = Json::parse(get("/readyz").body);
  EXPECT_EQ(json["status"], "not ready");
  EXPECT_THAT(json["reasons"].at(0).get<std::string>(),
              HasSubstr("the system clock is not set: it says 1970-01-01T00:05:00Z"));
  for (const char* path : {"/", "/meters/main", "/months", "/model", "/events"}) {
    EXPECT_EQ(get(path).status, 200) << path;  // and people can read why
  }
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
