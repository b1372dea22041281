/// The API over a gateway that runs: what is asked and what comes.
#include "daemon/gateway/serve/api/api.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "adapters/csv/fields.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

using Api = ServedSite;

TEST_F(Api, TheSite) {
  const Json site = get_json("/api/v1/sites")["sites"].at(0);
  EXPECT_EQ(site["id"], "tower");
  EXPECT_EQ(site["timezone"], "America/Chicago");
  EXPECT_EQ(site["interval_s"], 900);
  EXPECT_EQ(site["meters"], 3);
  EXPECT_EQ(site["started_at"], "2024-03-30T12:00:00Z");
}

TEST_F(Api, MetersWithWhatTheyShow) {
  loop_.run_for(hours{2} + std::chrono::seconds{5});
  const Json meters = get_json("/api/v1/meters")["meters"];
  ASSERT_THAT(meters, SizeIs(3));
  EXPECT_EQ(meters[0]["id"], "main");
  EXPECT_EQ(meters[0]["state"], "up");
  EXPECT_EQ(meters[0]["source"], "modbus");
  EXPECT_EQ(meters[0]["unit"], 1);
  EXPECT_NEAR(meters[0]["register_kWh"].get<double>(), 120.4, 1e-9);
  EXPECT_EQ(meters[0]["read_at"], "2024-03-30T14:00:00Z");
  EXPECT_EQ(meters[0]["last_interval"]["start"], "2024-03-30T13:45:00Z");
  EXPECT_NEAR(meters[0]["last_interval"]["mean_kW"].get<double>(), 60.4, 1e-9);
  EXPECT_NEAR(meters[0]["last_interval"]["energy_kWh"].get<double>(), 15.1, 1e-9);
  EXPECT_EQ(meters[2]["source"], "csv");
  EXPECT_FALSE(meters[2].contains("state"));
  EXPECT_EQ(get_json("/api/v1/meters/cooling"), meters[1]);
  EXPECT_EQ(refused("/api/v1/meters/none"), "404 not_found meter");
}

TEST_F(Api, IntervalsOfASpan) {
  loop_.run_for(days{1} + minutes{1});
  const Json json = get_json(
      "/api/v1/intervals",
      {{"meter", "main"}, {"from", "2024-03-30T15:00:00+01:00"}, {"to", "2024-03-30T15:00:00Z"}});
  EXPECT_EQ(json["meter"], "main");
  EXPECT_EQ(json["interval_s"], 900);
  EXPECT_EQ(json["next"], nullptr);
  ASSERT_THAT(json["intervals"], SizeIs(4));
  Json first = json["intervals"][0];
  EXPECT_NEAR(first["mean_kW"].get<double>(), 60.0, 1e-9);
  EXPECT_NEAR(first["energy_kWh"].get<double>(), 15.0, 1e-9);
  first.erase("mean_kW");
  first.erase("energy_kWh");
  EXPECT_EQ(first, Json::parse(R"({"start":"2024-03-30T14:00:00Z","validity":"ok","late":false,
      "reasons":[],"revision":0})"));
  EXPECT_EQ(json["intervals"][3]["start"], "2024-03-30T14:45:00Z");
}

TEST_F(Api, PagesOfIntervalsAreTheWhole) {
  loop_.run_for(days{3} + minutes{1});
  const Json whole = get_json("/api/v1/intervals", {{"meter", "main"}})["intervals"];
  ASSERT_THAT(whole, SizeIs(3 * 96));
  Json parts = Json::array();
  std::map<std::string, std::string> query{{"meter", "main"}, {"limit", "100"}};
  for (int page = 0; page < 3; ++page) {
    const Json json = get_json("/api/v1/intervals", query);
    for (const Json& interval : json["intervals"]) parts.push_back(interval);
    ASSERT_EQ(json["next"].is_null(), page == 2);
    if (page < 2) query["cursor"] = json["next"].get<std::string>();
  }
  EXPECT_EQ(parts, whole);
}

TEST_F(Api, ALimitThatFitsExactlyHasNoNext) {
  loop_.run_for(hours{1} + minutes{1});
  EXPECT_EQ(get_json("/api/v1/intervals", {{"meter", "main"}, {"limit", "4"}})["next"], nullptr);
  EXPECT_EQ(get_json("/api/v1/intervals", {{"meter", "main"}, {"limit", "3"}})["next"],
            "2024-03-30T12:45:00Z");
}

TEST_F(Api, AGapOfYearsIsPassed) {
  const auto number = disk_.meter_number("main", std::chrono::seconds{900}).value();
  ASSERT_TRUE(disk_.commit(
      {.intervals = {{{number, kStart - days{3650}, 1.0}},
                     {{number, kStart - days{2}, std::nan(""), metering::Validity::missing,
                       metering::Reason::timeout | metering::Reason::crc}}}}));
  const Json json = get_json("/api/v1/intervals", {{"meter", "main"}, {"limit", "2"}});
  ASSERT_THAT(json["intervals"], SizeIs(2));
  EXPECT_EQ(json["next"], nullptr);
  EXPECT_EQ(json["intervals"][1]["mean_kW"], nullptr);
  EXPECT_THAT(json["intervals"][1]["reasons"], ElementsAre("timeout", "crc"));
}

TEST_F(Api, NothingIsEnteredForAMeterThatIsNotPolled) {
  EXPECT_THAT(get_json("/api/v1/intervals", {{"meter", "old"}})["intervals"], SizeIs(0));
  const auto next = disk_.meter_number("another", std::chrono::seconds{900});
  EXPECT_EQ(next.value(), disk_.meter_number("cooling", std::chrono::seconds{900}).value() + 1);
}

TEST_F(Api, MonthsByMeterAndMonth) {
  pass_months(days{35});
  const Json months = get_json("/api/v1/months")["months"];
  ASSERT_THAT(months, SizeIs(4));
  EXPECT_EQ(months[0]["month"], "2024-03");
  EXPECT_EQ(months[1]["month"], "2024-04");
  EXPECT_EQ(months[1]["meter"], "main");
  EXPECT_NEAR(months[1]["daily_average_kWh"].get<double>(), 1444.8, 0.01);
  EXPECT_EQ(months[1]["coverage"], 1.0);
  EXPECT_EQ(months[1]["slots_by_validity"]["ok"], 2880);
  EXPECT_EQ(months[1]["peak"]["window_s"], 900);
  EXPECT_EQ(months[1]["usable"], true);
  EXPECT_EQ(months[0]["usable"], false);
  EXPECT_EQ(get_json("/api/v1/months", {{"meter", "cooling"}, {"from", "2024-04"}})["months"],
            Json::array({months[3]}));
  EXPECT_EQ(get_json("/api/v1/months", {{"to", "2024-04"}})["months"],
            Json::array({months[0], months[2]}));
}

TEST_F(Api, PagesOfMonthsAreTheWhole) {
  pass_months(days{35});
  const Json whole = get_json("/api/v1/months")["months"];
  const Json first = get_json("/api/v1/months", {{"limit", "3"}});
  ASSERT_EQ(first["next"], "cooling/2024-04");
  const Json second = get_json("/api/v1/months", {{"limit", "3"}, {"cursor", "cooling/2024-04"}});
  EXPECT_EQ(second["next"], nullptr);
  Json both = first["months"];
  for (const Json& month : second["months"]) both.push_back(month);
  EXPECT_EQ(both, whole);
}

TEST_F(Api, PagesOfEventsStandStillWhileNewOnesCome) {
  const auto put = [&](metering::Instant at, const char* kind) {
    ASSERT_TRUE(disk_.commit({.events = {{at, Severity::warning, kind, "main", "It was so."}}}));
  };
  put(kStart, "a");
  for (const char* same_second : {"b", "c", "d"}) put(kStart + minutes{1}, same_second);
  const Json first = get_json("/api/v1/events", {{"limit", "2"}});
  EXPECT_EQ(first["events"][0]["kind"], "d");
  EXPECT_EQ(first["events"][0]["time"], "2024-03-30T12:01:00Z");
  EXPECT_EQ(first["events"][0]["severity"], "warning");
  put(kStart + minutes{2}, "e");
  const Json second = get_json("/api/v1/events", {{"limit", "5"}, {"cursor", first["next"]}});
  ASSERT_THAT(second["events"], SizeIs(2));
  EXPECT_EQ(second["events"][0]["kind"], "b");
  EXPECT_EQ(second["events"][1]["kind"], "a");
  EXPECT_EQ(second["next"], nullptr);
  // All of them in pages, each once, of whatever size.
  for (const char* limit : {"1", "2", "3"}) {
    std::string kinds;
    Json next = "";
    while (!next.is_null()) {
      std::map<std::string, std::string> asked{{"limit", limit}};
      if (next != "") asked["cursor"] = next;
      const Json page = get_json("/api/v1/events", asked);
      for (const Json& event : page["events"]) kinds += event["kind"];
      next = page["next"];
    }
    EXPECT_EQ(kinds, "edcba") << limit;
  }

  const Json minute = get_json("/api/v1/events",
                               {{"from", "2024-03-30T12:01:00Z"}, {"to", "2024-03-30T12:02:00Z"}});
  EXPECT_THAT(minute["events"], SizeIs(3));
}

TEST_F(Api, HistoryIsIntervalsSummedUp) {
  loop_.run_for(days{3});
  const auto history = [&](const std::string& points) {
    return get_json(
        "/api/v1/history",
        {{"meter", "main"}, {"from", "2024-03-31"}, {"to", "2024-04-01"}, {"points", points}});
  };
  const Json fine = history("96");
  EXPECT_EQ(fine["step_s"], 900);
  EXPECT_THAT(fine["points"], SizeIs(96));
  const Json coarse = history("24");
  EXPECT_EQ(coarse["step_s"], 3600);
  ASSERT_THAT(coarse["points"], SizeIs(24));
  const Json first = coarse["points"][0];
  EXPECT_EQ(first["start"], "2024-03-31T05:00:00Z");
  double sum_kW = 0.0;
  double most_kW = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double kW = fine["points"][i]["mean"];
    sum_kW += kW;
    most_kW = std::max(most_kW, kW);
  }
  EXPECT_NEAR(first["mean"].get<double>(), sum_kW / 4.0, 1e-9);
  EXPECT_NEAR(first["most"].get<double>(), most_kW, 1e-9);
  EXPECT_EQ(first["valid_share"], 1.0);
  EXPECT_THAT(get_json("/api/v1/history", {{"meter", "main"}, {"points", "1"}})["points"],
              SizeIs(1));
  EXPECT_EQ(refused("/api/v1/history", {{"meter", "main"}, {"points", "0"}}),
            "400 invalid_value points");
  EXPECT_THAT(get_json("/api/v1/history", {{"meter", "old"}})["points"], SizeIs(0));
}

TEST_F(Api, ADateIsWhereThatDayBeginsAtTheSite) {
  loop_.run_for(days{3});
  const auto starts = [&](const std::string& from, const std::string& to) {
    const Json list =
        get_json("/api/v1/intervals", {{"meter", "main"}, {"from", from}, {"to", to}})["intervals"];
    EXPECT_THAT(list, SizeIs(96)) << from;
    return list.front()["start"].get<std::string>() + " " + list.back()["start"].get<std::string>();
  };
  EXPECT_EQ(starts("2024-03-31", "2024-04-01"), "2024-03-31T05:00:00Z 2024-04-01T04:45:00Z");
  EXPECT_EQ(starts("2024-03-31", "2024-04-01T05:00:00Z"),
            "2024-03-31T05:00:00Z 2024-04-01T04:45:00Z");
  EXPECT_EQ(refused("/api/v1/events", {{"from", "2024-02-30"}}), "400 invalid_value from");
}

/// The lines of a response in CSV, without their ends.
std::vector<std::string> lines_of(const http::Response& response) {
  EXPECT_EQ(response.content_type, "text/csv; charset=utf-8; header=present");
  std::vector<std::string> lines;
  std::istringstream text(response.body);
  for (std::string line; std::getline(text, line);) {
    EXPECT_TRUE(line.ends_with('\r')) << line;
    lines.push_back(line.substr(0, line.size() - 1));
  }
  return lines;
}

TEST_F(Api, ListsAreCsvForThoseWhoAskForIt) {
  pass_months(days{35});
  const auto months = lines_of(get("/api/v1/months", {{"format", "csv"}, {"limit", "2"}}));
  ASSERT_THAT(months, SizeIs(3));
  EXPECT_THAT(months[0], StartsWith("meter,month,daily_average_kWh,"));
  EXPECT_THAT(months[1], StartsWith("main,2024-03,"));
  EXPECT_THAT(months[2], HasSubstr(",900,"));  // the peak's window, one level down
  csv::FieldSplitter fields;                   // quotes and all
  const std::size_t columns = fields.split(months[0]);
  for (const std::string& line : months) EXPECT_EQ(fields.split(line), columns) << line;

  const http::Response first =
      get("/api/v1/intervals",
          {{"format", "csv"}, {"meter", "main"}, {"from", "2024-03-31"}, {"limit", "1"}});
  EXPECT_THAT(lines_of(first),
              ElementsAre("start,mean_kW,energy_kWh,mean,validity,late,reasons,revision",
                          StartsWith("2024-03-31T05:00:00Z,60")));
  EXPECT_EQ(first.header("link"),
            "</api/v1/intervals?cursor=2024-03-31T05%3A15%3A00Z&format=csv&from=2024-03-31&"
            "limit=1&meter=main>; rel=\"next\"");
  EXPECT_EQ(first.header("vary"), "Accept");
}

TEST_F(Api, TextInCsvCannotBreakItsLine) {
  ASSERT_TRUE(disk_.commit(
      {.events = {{kStart, Severity::warning, "odd", "main", "It said \"1,5\".\nThen nothing."}}}));
  const http::Response response = get("/api/v1/events", {{"format", "csv"}});
  EXPECT_THAT(response.body,
              HasSubstr("Z,warning,odd,main,\"It said \"\"1,5\"\".\nThen nothing.\",1,\r\n"));
}

TEST_F(Api, CsvIsChosenByTheAcceptHeader) {
  const auto type_for = [&](const std::string& accept) {
    http::Request request{.path = "/api/v1/events", .headers = {{"accept", accept}}};
    return answer(served_, request).content_type.substr(0, 16);
  };
  EXPECT_EQ(type_for("text/csv"), "text/csv; charse");
  EXPECT_EQ(type_for("text/csv, application/json;q=0.5"), "text/csv; charse");
  EXPECT_EQ(type_for("application/json, text/csv"), "application/json");
  EXPECT_EQ(type_for("*/*"), "application/json");
  EXPECT_EQ(refused("/api/v1/events", {{"format", "xml"}}), "400 invalid_value format");
  EXPECT_EQ(refused("/api/v1/sites", {{"format", "csv"}}), "400 unknown_parameter format");
  EXPECT_EQ(refused("/api/v1/intervals", {{"format", "csv"}}), "400 missing_parameter meter");
}

TEST_F(Api, WhatIsWrongIsSaid) {
  EXPECT_EQ(refused("/api/v1/intervals"), "400 missing_parameter meter");
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "x"}}), "404 not_found meter");
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "main"}, {"form", "2024"}}),
            "400 unknown_parameter form");
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "main"}, {"from", "yesterday"}}),
            "400 invalid_value from");
  EXPECT_EQ(
      refused("/api/v1/intervals",
              {{"meter", "main"}, {"from", "2024-03-02T00:00Z"}, {"to", "2024-03-01T00:00Z"}}),
      "400 invalid_value to");
  for (const char* wrong : {"0", "10001", "-1", "ten", "1e3", "99999999999999999999", ""}) {
    EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "main"}, {"limit", wrong}}),
              "400 invalid_value limit")
        << wrong;
  }
  EXPECT_EQ(refused("/api/v1/months", {{"from", "2024-13"}}), "400 invalid_value from");
  for (const char* wrong : {"", "main", "main/", "x/2024-03", "/", "3"}) {
    EXPECT_EQ(refused("/api/v1/months", {{"cursor", wrong}}), "400 invalid_value cursor") << wrong;
    EXPECT_EQ(refused("/api/v1/events", {{"cursor", wrong}}), "400 invalid_value cursor") << wrong;
  }
  EXPECT_EQ(refused("/api/v1/events", {{"cursor", "2024-03-30T12:01:00Z/-1"}}),
            "400 invalid_value cursor");
}

TEST_F(Api, AStoreThatRefusesIs503) {
  store_.refuses = true;
  for (const char* path : {"/api/v1/months", "/api/v1/events", "/api/v1/calibrations",
                           "/api/v1/drift", "/api/v1/diagnoses/1"}) {
    EXPECT_EQ(refused(path), "503 store_unavailable ") << path;
  }
  EXPECT_EQ(refused("/api/v1/intervals", {{"meter", "main"}}), "503 store_unavailable ");
  EXPECT_EQ(get("/api/v1/meters").status, 200);  // what needs no store goes on
}

TEST_F(Api, WhatIsNotThere) {
  for (const char* path : {"/api/v1/", "/api/v1/nothing", "/api/v1/meters/", "/api/v2/meters",
                           "/api/v1/sites/tower", "/robots.txt", "/api/v1/calibrations/x"}) {
    EXPECT_EQ(get(path).status, 404) << path;
  }
}

TEST_F(Api, WhatAPathDoesNotDo) {
  const http::Response post = answer(served_, {.method = http::Method::post, .path = "/metrics"});
  EXPECT_EQ(post.status, 405);
  EXPECT_EQ(post.header("Allow"), "GET, HEAD");
  const http::Response other =
      answer(served_, {.method = http::Method::other, .path = "/api/v1/calibrations"});
  EXPECT_EQ(other.status, 405);
  EXPECT_EQ(other.header("Allow"), "GET, HEAD, POST");
  EXPECT_EQ(answer(served_, {.path = "/api/v1/readings"}).status, 405);
  EXPECT_EQ(answer(served_, {.method = http::Method::head, .path = "/"}).status, 200);
}

class Jobs : public ServedSite {
 protected:
  http::Response post(const std::string& path, std::string body = "") {
    return answer(served_, {.method = http::Method::post, .path = path, .body = std::move(body)});
  }
  void work_on_jobs() {
    served_.ask_job = [this](JobKind kind) {
      return disk_.add_job({.kind = kind, .asked_by = "api", .asked = kStart});
    };
  }
};

TEST_F(Jobs, WithoutAStoreOnDiskNoneIsBegun) {
  work_on_jobs();
  served_.no_store = "database or disk is full";
  for (const char* path : {"/api/v1/calibrations", "/api/v1/diagnoses"}) {
    const http::Response response = post(path);
    EXPECT_EQ(response.status, 503) << path;
    EXPECT_EQ(response.header("Retry-After"), "60");
    EXPECT_THAT(response.body,
                HasSubstr("was started, try again later: the store cannot be opened"));
  }
  EXPECT_THAT(disk_.unfinished_jobs().value(), SizeIs(0));
}

TEST_F(Jobs, AreAskedForAndFollowed) {
  work_on_jobs();
  const http::Response accepted = post("/api/v1/calibrations", "{}");
  EXPECT_EQ(accepted.status, 202);
  const std::string where{accepted.header("Location")};
  ASSERT_EQ(where, "/api/v1/calibrations/1");
  Json job = get_json(where);
  EXPECT_EQ(job["state"], "waiting");
  EXPECT_EQ(job["asked_by"], "api");
  EXPECT_EQ(job["asked_at"], "2024-03-30T12:00:00Z");
  EXPECT_EQ(job["result"], nullptr);
  StoredJob done = disk_.job(1).value().value();
  done.state = JobState::done;
  done.accepted = true;
  done.ended = kStart + hours{1};
  done.result.document =
      R"({"model":"epc","drift":[{"output":"main_daily_kWh","pvalue":0.5}],)"
      R"("alarms":[{"output":"main_daily_kWh","since":"2023-02","sentence":"More <b>."}]})";
  ASSERT_TRUE(disk_.put_job(done));
  job = get_json(where);
  EXPECT_EQ(job["state"], "done");
  EXPECT_EQ(job["ended_at"], "2024-03-30T13:00:00Z");
  EXPECT_EQ(job["result"]["model"], "epc");
  const Json drift = get_json("/api/v1/drift");
  EXPECT_EQ(drift["calibration"], where);
  EXPECT_EQ(drift["drift"][0]["pvalue"], 0.5);
  EXPECT_EQ(drift["alarms"][0]["since"], "2023-02");
  // People and monitoring are told as well.
  const http::Response page = answer(served_, {.path = "/"});
  EXPECT_THAT(page.body, HasSubstr("What has changed"));
  EXPECT_THAT(page.body, HasSubstr("More &lt;b&gt;."));
  EXPECT_THAT(answer(served_, {.path = "/metrics"}).body,
              HasSubstr("recald_drift_alarms{model=\"\",output=\"main_daily_kWh\"} 1"));
}

TEST_F(Jobs, ForecastsAreToldAsTheyWereMade) {
  const auto forecast = [](unsigned month, double mean) {
    return StoredForecast{.output = "main_daily_kWh",
                          .month = std::chrono::year{2024} / std::chrono::month{month},
                          .model_version = "epc-1",
                          .made = kStart,
                          .mean = mean,
                          .measured = 97.0};
  };
  ASSERT_TRUE(disk_.add_forecasts(std::array{forecast(1, 100.0), forecast(2, 90.0)}));
  ASSERT_TRUE(disk_.add_forecasts(std::array{forecast(1, 98.0)}));  // wiser after the event
  const Json all = get_json("/api/v1/forecasts");
  ASSERT_THAT(all["forecasts"], SizeIs(2));
  EXPECT_EQ(all["forecasts"][0]["month"], "2024-01");
  EXPECT_EQ(all["forecasts"][0]["mean"], 100.0);
  EXPECT_EQ(all["forecasts"][0]["revision"], 0);
  EXPECT_EQ(all["next"], nullptr);
  const Json first = get_json("/api/v1/forecasts", {{"limit", "1"}});
  EXPECT_THAT(first["forecasts"], SizeIs(1));
  const Json second = get_json("/api/v1/forecasts", {{"limit", "1"}, {"cursor", first["next"]}});
  EXPECT_EQ(second["forecasts"][0]["month"], "2024-02");
  EXPECT_THAT(get_json("/api/v1/forecasts", {{"from", "2024-02"}})["forecasts"], SizeIs(1));
  EXPECT_THAT(get_json("/api/v1/forecasts", {{"output", "other"}})["forecasts"], SizeIs(0));
  EXPECT_EQ(refused("/api/v1/forecasts", {{"meter", "main"}}), "400 unknown_parameter meter");
}

TEST_F(Jobs, OfOneKindAreNotOfTheOther) {
  work_on_jobs();
  EXPECT_EQ(post("/api/v1/diagnoses").header("Location"), "/api/v1/diagnoses/1");
  EXPECT_EQ(refused("/api/v1/calibrations/1"), "404 not_found id");
  EXPECT_THAT(get_json("/api/v1/calibrations")["calibrations"], SizeIs(0));
  EXPECT_THAT(get_json("/api/v1/diagnoses")["diagnoses"], SizeIs(1));
  EXPECT_EQ(get_json("/api/v1/drift")["drift"], nullptr);
}

TEST_F(Jobs, TheNewestComeFirst) {
  work_on_jobs();
  for (int i = 0; i < 5; ++i) (void)post("/api/v1/calibrations");
  const Json first = get_json("/api/v1/calibrations", {{"limit", "3"}});
  EXPECT_EQ(first["calibrations"][0]["id"], 5);
  ASSERT_EQ(first["next"], "2");
  const Json second = get_json("/api/v1/calibrations", {{"limit", "3"}, {"cursor", "2"}});
  ASSERT_THAT(second["calibrations"], SizeIs(2));
  EXPECT_EQ(second["calibrations"][0]["id"], 2);
  EXPECT_EQ(second["next"], nullptr);
}

TEST_F(Jobs, AreCancelled) {
  work_on_jobs();
  const auto cancel = [&](const std::string& path) {
    return answer(served_, {.method = http::Method::remove, .path = path});
  };
  (void)post("/api/v1/diagnoses");
  EXPECT_EQ(in_short(cancel("/api/v1/diagnoses/1")), "409 not_possible ");  // nobody works here
  served_.cancel_job = [this](std::int64_t number) -> Result<void> {
    StoredJob job = disk_.job(number).value().value();
    if (job.state != JobState::waiting) return failure(ErrorCode::not_found, "it has ended");
    job.state = JobState::cancelled;
    return disk_.put_job(job);
  };
  EXPECT_EQ(in_short(cancel("/api/v1/calibrations/1")), "404 not_found id");
  EXPECT_EQ(cancel("/api/v1/diagnoses/1").status, 202);
  EXPECT_EQ(get_json("/api/v1/diagnoses/1")["state"], "cancelled");
  EXPECT_EQ(in_short(cancel("/api/v1/diagnoses/1")), "409 not_possible ");
  const http::Response nothing = cancel("/api/v1/diagnoses");
  EXPECT_EQ(nothing.status, 405);
  EXPECT_EQ(nothing.header("Allow"), "GET, HEAD, POST");
}

TEST_F(Jobs, AreRefusedWithTheirReason) {
  EXPECT_EQ(in_short(post("/api/v1/calibrations")), "409 not_possible ");
  served_.ask_job = [](JobKind) -> Result<std::int64_t> {
    return failure(ErrorCode::unsupported, "the site has no [[model]]");
  };
  EXPECT_THAT(post("/api/v1/diagnoses").body, HasSubstr("the site has no [[model]]"));
  for (const char* wrong : {"[]", "{\"model\":\"epc\"}", "{", "1"}) {
    EXPECT_EQ(in_short(post("/api/v1/calibrations", wrong)), "400 invalid_value body") << wrong;
  }
}

}  // namespace
}  // namespace recald::daemon
