/// Pushed readings.
#include "daemon/gateway/serve/api/pushed_readings.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <ostream>

#include "tests/daemon/gateway/serve/served_site.hpp"
#include "tests/support/allocations.hpp"

namespace recald::daemon {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class PushedMeterSite : public ServedSite {
 protected:
  PushedMeterSite()
      : ServedSite(R"(
[[meter]]
id = "chw"
source = "http"
utility = "chilled_water"
rated_kW = 500
multiplier = 2
)") {}

  http::Response post(const std::string& body) {
    return answer(served_,
                  {.method = http::Method::post, .path = "/api/v1/readings", .body = body});
  }
  Json taken(const std::string& body) {
    const http::Response response = post(body);
    EXPECT_EQ(response.status, 200) << response.body;
    return Json::parse(response.body);
  }
  /// Quarter hours from `start` on of so many kWh each.
  static std::string body_of(metering::Instant start, int count, double kWh) {
    std::string list;
    for (int i = 0; i < count; ++i) {
      list += fmt::format(R"({}{{"time":"{}","value":{}}})", i == 0 ? "" : ",",
                          metering::to_string(start + i * minutes{15}), kWh + (i % 2));
    }
    return fmt::format(R"({{"meter":"chw","unit":"kWh","readings":[{}]}})", list);
  }
  Json intervals() { return get_json("/api/v1/intervals", {{"meter", "chw"}})["intervals"]; }
};

TEST_F(PushedMeterSite, WhatIsAnsweredIsStored) {
  const Json said = taken(R"({"meter":"chw","unit":"kWh","readings":[
      {"time":"2024-03-30T06:00:00-05:00","value":10},{"time":"2024-03-30T11:15:00Z","value":null}]})");
  EXPECT_EQ(said["stored"], 2);
  EXPECT_THAT(said["conflicts"], IsEmpty());
  const Json stored = intervals();
  ASSERT_THAT(stored, SizeIs(2));
  EXPECT_EQ(stored[0]["start"], "2024-03-30T11:00:00Z");
  EXPECT_EQ(stored[0]["mean_kW"], 80.0);  // 10 kWh in a quarter of an hour, twice by the multiplier
  EXPECT_EQ(stored[1]["validity"], "missing");
}

TEST_F(PushedMeterSite, SentAgainItIsTakenOnce) {
  const std::string body = body_of(kStart - hours{3}, 4, 5.0);
  EXPECT_EQ(taken(body)["stored"], 4);
  const Json again = taken(body);
  EXPECT_EQ(again["stored"], 0);
  EXPECT_EQ(again["known"], 4);
  EXPECT_THAT(intervals(), SizeIs(4));
}

// Their stamps are the sender's, but what is to come can only be told from a clock that is right.
TEST_F(PushedMeterSite, AClockThatIsNotSetTakesNoneYet) {
  const auto off = loop_.now().wall.time_since_epoch() - hours{1};
  const std::string body = body_of(kStart - hours{3}, 4, 5.0);
  loop_.set_wall_clock(-off);
  begin();
  const http::Response response = post(body);
  EXPECT_EQ(response.status, 503);
  EXPECT_THAT(response.body, HasSubstr("the daemon's clock is not set: it says 1970-01-01"));
  loop_.set_wall_clock(off);
  loop_.run_for(minutes{2});
  EXPECT_EQ(taken(body)["stored"], 4);
}

// A year and a month may be caught up on; what is older is taken for a wrong date.
TEST_F(PushedMeterSite, ReadingsOlderThan400DaysAreRefused) {
  EXPECT_EQ(taken(body_of(kStart - days{399}, 1, 5.0))["stored"], 1);
  const http::Response response = post(body_of(kStart - days{401}, 1, 5.0));
  EXPECT_EQ(response.status, 400);
  EXPECT_THAT(response.body, HasSubstr("more than 400 days ago"));
}

TEST_F(PushedMeterSite, AnotherValueIsNotTakenAndTold) {
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":7}]})");
  const Json said = taken(
      R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":9}]})");
  EXPECT_THAT(said["conflicts"], ElementsAre("2024-03-30T10:00:00Z"));
  EXPECT_EQ(intervals()[0]["mean_kW"], 14.0);
  loop_.run_for(minutes{1});
  const Json events = get_json("/api/v1/events")["events"];
  ASSERT_THAT(events, ::testing::Not(IsEmpty()));
  EXPECT_EQ(events[0]["kind"], "reading_conflict");
}

// A sender that repeats itself must not fill the list of events.
TEST_F(PushedMeterSite, ThreeHundredConflictsAreOneCountedEvent) {
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":7}]})");
  for (int i = 0; i < 300; ++i) {
    taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":9}]})");
    loop_.run_for(minutes{1});
  }
  int conflicts = 0;
  const Json events = get_json("/api/v1/events")["events"];
  for (const Json& event : events) {
    if (event["kind"] != "reading_conflict") continue;
    ++conflicts;
    EXPECT_EQ(event["count"], 300);
    EXPECT_EQ(event["last_time"], "2024-03-30T16:59:00Z");
  }
  EXPECT_EQ(conflicts, 1);
  // Days later it is another event: the list is in order of time.
  loop_.run_for(days{2});
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":9}]})");
  loop_.run_for(minutes{1});
  const Json newest = get_json("/api/v1/events")["events"][0];
  EXPECT_EQ(newest["kind"], "reading_conflict");
  EXPECT_EQ(newest["time"], "2024-04-01T17:00:00Z");
}

// 500 kW rated: 1.2 times that is the most that is believed, as of any other meter.
TEST_F(PushedMeterSite, WhatTheMeterCannotReadIsSuspect) {
  const Json said = taken(R"({"meter":"chw","unit":"kW","readings":[
      {"time":"2024-03-30T10:00:00Z","value":300},{"time":"2024-03-30T10:15:00Z","value":301},
      {"time":"2024-03-30T10:30:00Z","value":-1}]})");
  EXPECT_EQ(said["stored"], 3);
  ASSERT_THAT(said["suspect"], SizeIs(2));
  EXPECT_EQ(said["suspect"][0]["start"], "2024-03-30T10:15:00Z");
  EXPECT_EQ(said["suspect"][0]["why"],
            "602 kW is more than 1.2 times rated_kW = 500; check the unit, or rated_kW");
  EXPECT_EQ(
      said["suspect"][1]["why"],
      "-2 kW is negative, but the meter does not have negative_is_valid = true; check the sign");
  const Json stored = intervals();
  EXPECT_EQ(stored[0]["validity"], "ok");
  EXPECT_EQ(stored[1]["validity"], "suspect");
  EXPECT_EQ(stored[1]["reasons"], Json::array({"range"}));
  EXPECT_EQ(stored[2]["reasons"], Json::array({"negative"}));
}

TEST_F(PushedMeterSite, ASuspectReadingGivesWayToAGoodOne) {
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":9000}]})");
  const Json said = taken(
      R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":9}]})");
  EXPECT_EQ(said["stored"], 1);
  EXPECT_THAT(said["suspect"], IsEmpty());
  EXPECT_EQ(intervals()[0]["mean_kW"], 18.0);
  EXPECT_EQ(intervals()[0]["validity"], "ok");
}

TEST_F(PushedMeterSite, AReasonPutsAStoredValueRightAsAnEdit) {
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":7}]})");
  const Json said = taken(
      R"({"meter":"chw","unit":"kW","reason":"wrong channel","author":"Ada","readings":[
          {"time":"2024-03-30T10:00:00Z","value":9}]})");
  EXPECT_EQ(said["stored"], 1);
  EXPECT_THAT(said["conflicts"], IsEmpty());
  const Json stored = intervals();
  ASSERT_THAT(stored, SizeIs(1));
  EXPECT_EQ(stored[0]["mean_kW"], 18.0);
  EXPECT_EQ(stored[0]["revision"], 1);
  const auto number = store_.find_meter("chw").value().value();
  EXPECT_THAT(store_.edited_days(number).value(), SizeIs(1));
  auto edit = disk_.database().prepare("SELECT author, reason, length(sha256) FROM edit");
  ASSERT_TRUE(edit && edit->step().value());
  EXPECT_EQ(edit->text(0), "Ada");
  EXPECT_EQ(edit->text(1), "wrong channel");
  EXPECT_EQ(edit->integer(2), 64);
  loop_.run_for(minutes{1});
  const Json events = get_json("/api/v1/events")["events"];
  ASSERT_THAT(events, ::testing::Not(IsEmpty()));
  EXPECT_EQ(events[0]["kind"], "readings_corrected");
  EXPECT_THAT(events[0]["text"].get<std::string>(), HasSubstr("Ada: wrong channel"));
}

TEST_F(PushedMeterSite, WhatIsSaidOfACorrectionHasALength) {
  const auto correct = [&](std::size_t reason, std::size_t author) {
    return post(
        fmt::format(R"({{"meter":"chw","unit":"kW","reason":"{}","author":"{}","readings":[)"
                    R"({{"time":"2024-03-30T10:00:00Z","value":7}}]}})",
                    std::string(reason, 'r'), std::string(author, 'a')));
  };
  EXPECT_EQ(correct(2'000, 200).status, 200);
  for (const auto& [reason, author, field] :
       {std::tuple{2'001, 200, "reason"}, {1'000'000, 1, "reason"}, {1, 201, "author"}}) {
    const http::Response refused = correct(static_cast<std::size_t>(reason), author);
    EXPECT_EQ(refused.status, 400);
    EXPECT_THAT(refused.body, HasSubstr(fmt::format("'{}' is", field)));
    EXPECT_LT(refused.body.size(), 200U);
  }
}

TEST_F(PushedMeterSite, ACorrectionThatChangesNothingLeavesNoEdit) {
  const std::string body =
      R"({"meter":"chw","unit":"kW","reason":"again","readings":[{"time":"2024-03-30T10:00:00Z","value":7}]})";
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":7}]})");
  EXPECT_EQ(taken(body)["known"], 1);
  auto edits = disk_.database().prepare("SELECT count(*) FROM edit");
  ASSERT_TRUE(edits && edits->step().value());
  EXPECT_EQ(edits->integer(0), 0);
}

TEST_F(PushedMeterSite, ACorrectedMonthIsClosedAgain) {
  const metering::Instant march{calendar_.month_span(std::chrono::year{2024} / 3).begin};
  for (int day = 0; day < 29; ++day) taken(body_of(march + days{day}, 96, 6.0));
  loop_.run_for(days{3});
  std::string corrected = body_of(march + days{3}, 96, 7.0);
  corrected.insert(1, R"("reason":"the multiplier was wrong that day",)");
  EXPECT_EQ(taken(corrected)["stored"], 96);
  loop_.run_for(hours{2});
  const Json months = get_json("/api/v1/months", {{"meter", "chw"}})["months"];
  ASSERT_THAT(months, SizeIs(1));
  EXPECT_EQ(months[0]["revision"], 1);
}

TEST_F(PushedMeterSite, ADeeplyNestedBodyIsRefusedBeforeItIsRead) {
  const std::string deep(1024 * 1024, '[');
  const long before = recald::testing::allocation_count();
  const http::Response response = post(deep);
  EXPECT_LT(recald::testing::allocation_count() - before, 1000);
  EXPECT_EQ(response.status, 400);
  EXPECT_THAT(response.body, HasSubstr("levels of nesting"));
  EXPECT_EQ(in_short(post(R"({"meter":"chw","unit":")" + std::string(64, '[') + R"("})")),
            "400 invalid_value unit");  // within a text they are text
  const http::Response job =
      answer(served_, {.method = http::Method::post, .path = "/api/v1/calibrations", .body = deep});
  EXPECT_EQ(job.status, 400) << job.body;
  EXPECT_LT(recald::testing::allocation_count() - before, 2000);
}

TEST_F(PushedMeterSite, EndStampsAndRates) {
  taken(
      R"({"meter":"chw","unit":"ton","stamps":"end","readings":[{"time":"2024-03-30T10:00:00Z","value":1}]})");
  EXPECT_EQ(intervals()[0]["start"], "2024-03-30T09:45:00Z");
  EXPECT_NEAR(intervals()[0]["mean_kW"].get<double>(), 2.0 * 3.516852842, 1e-6);
}

TEST_F(PushedMeterSite, AMonthClosesAndALateReadingOpensItAgain) {
  const metering::Instant march{calendar_.month_span(std::chrono::year{2024} / 3).begin};
  for (int day = 0; day < 29; ++day) taken(body_of(march + days{day}, 96, 6.0));
  loop_.run_for(days{3});
  Json months = get_json("/api/v1/months", {{"meter", "chw"}})["months"];
  ASSERT_THAT(months, SizeIs(1));
  EXPECT_EQ(months[0]["revision"], 0);
  EXPECT_NEAR(months[0]["coverage"].get<double>(), 29.0 * 96 / (31 * 96 - 4), 1e-9);
  taken(body_of(march + days{29}, 96, 6.0));
  loop_.run_for(hours{2});
  months = get_json("/api/v1/months", {{"meter", "chw"}})["months"];
  EXPECT_EQ(months[0]["revision"], 1);
  EXPECT_NEAR(months[0]["coverage"].get<double>(), 30.0 * 96 / (31 * 96 - 4), 1e-9);
}

TEST_F(PushedMeterSite, WhatIsKnownOpensNoMonth) {
  const metering::Instant march{calendar_.month_span(std::chrono::year{2024} / 3).begin};
  for (int day = 0; day < 29; ++day) taken(body_of(march + days{day}, 96, 6.0));
  loop_.run_for(days{3});
  for (int day = 0; day < 29; ++day) taken(body_of(march + days{day}, 96, 6.0));
  loop_.run_for(hours{2});
  const Json months = get_json("/api/v1/months", {{"meter", "chw"}})["months"];
  ASSERT_THAT(months, SizeIs(1));
  EXPECT_EQ(months[0]["revision"], 0);
}

TEST_F(PushedMeterSite, WhatIsNotTakenIsNotShown) {
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":7}]})");
  taken(R"({"meter":"chw","unit":"kW","readings":[{"time":"2024-03-30T10:00:00Z","value":9}]})");
  EXPECT_EQ(get_json("/api/v1/meters/chw")["last_interval"]["mean_kW"], 14.0);
  EXPECT_THAT(get("/metrics").body,
              HasSubstr(R"(recald_intervals_total{meter="chw",validity="ok"} 1)"));
}

TEST_F(PushedMeterSite, IsShownAsSuch) {
  taken(body_of(kStart - hours{3}, 4, 5.0));
  const Json meter = get_json("/api/v1/meters/chw");
  EXPECT_EQ(meter["source"], "http");
  EXPECT_FALSE(meter.contains("state"));
  EXPECT_EQ(meter["read_at"], "2024-03-30T12:00:00Z");
  EXPECT_THAT(get("/").body, HasSubstr(">pushed<"));
  const std::string metrics = get("/metrics").body;
  EXPECT_THAT(metrics, HasSubstr(R"(recald_intervals_total{meter="chw",validity="ok"} 4)"));
  EXPECT_THAT(metrics, ::testing::Not(HasSubstr(R"(recald_unit_state{meter="chw"})")));
}

TEST_F(PushedMeterSite, ARefusedStoreIsTold) {
  store_.refuses = true;
  const http::Response response = post(body_of(kStart - hours{3}, 4, 5.0));
  EXPECT_EQ(response.status, 503);
  EXPECT_EQ(response.header("Retry-After"), "60");
  store_.refuses = false;
  EXPECT_THAT(intervals(), IsEmpty());
}

// What is answered 200 is on the disk. In memory it would go with the process.
TEST_F(PushedMeterSite, WhileReadingsAreOnlyInMemoryTheyAreToBeSentAgain) {
  served_.no_store = "database or disk is full";
  const http::Response response = post(body_of(kStart - hours{3}, 4, 5.0));
  EXPECT_EQ(response.status, 503);
  EXPECT_EQ(response.header("Retry-After"), "60");
  EXPECT_THAT(response.body, HasSubstr("nothing was stored, send the readings again: the store "
                                       "cannot be opened: database or disk is full"));
  EXPECT_THAT(intervals(), IsEmpty());
}

TEST_F(PushedMeterSite, ARestartKnowsWhatWasSent) {
  taken(body_of(kStart - hours{3}, 4, 5.0));
  begin();
  EXPECT_EQ(get_json("/api/v1/meters/chw")["last_interval"]["start"], "2024-03-30T09:45:00Z");
}

struct WrongBody {
  const char* name;
  const char* body;
  const char* said;
  friend void PrintTo(const WrongBody& wrong, std::ostream* out) { *out << wrong.name; }
};

class WrongBodies : public PushedMeterSite, public ::testing::WithParamInterface<WrongBody> {};

TEST_P(WrongBodies, AreRefusedWhole) {
  EXPECT_EQ(in_short(post(GetParam().body)), GetParam().said);
  EXPECT_THAT(intervals(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    PushedReadings, WrongBodies,
    ::testing::Values(
        WrongBody{"empty", "", "400 malformed body"},
        WrongBody{"cut_off", "{", "400 malformed body"},
        WrongBody{"list_for_object", "[]", "400 malformed body"},
        WrongBody{"meter_is_a_number", R"({"meter":3})", "400 malformed meter"},
        WrongBody{"meter_unknown", R"({"meter":"x"})", "404 not_found meter"},
        WrongBody{"meter_is_polled", R"({"meter":"main","readings":[]})", "409 not_possible meter"},
        WrongBody{"meter_of_a_file", R"({"meter":"old","readings":[]})", "409 not_possible meter"},
        WrongBody{"unit_missing", R"({"meter":"chw"})", "400 malformed unit"},
        WrongBody{"unit_unknown", R"({"meter":"chw","unit":"furlong"})", "400 invalid_value unit"},
        WrongBody{"readings_missing", R"({"meter":"chw","unit":"kWh"})", "400 malformed readings"},
        WrongBody{"readings_empty", R"({"meter":"chw","unit":"kWh","readings":[]})",
                  "400 malformed readings"},
        WrongBody{"readings_misspelt", R"({"meter":"chw","unit":"kWh","reading":[]})",
                  "400 malformed reading"},
        WrongBody{"stamps_unknown",
                  R"({"meter":"chw","unit":"kWh","stamps":"middle","readings":[1]})",
                  "400 invalid_value stamps"},
        WrongBody{"reason_blank", R"({"meter":"chw","unit":"kWh","reason":" ","readings":[1]})",
                  "400 invalid_value reason"},
        WrongBody{"author_without_reason",
                  R"({"meter":"chw","unit":"kWh","author":"Ada","readings":[1]})",
                  "400 invalid_value author"},
        WrongBody{"reading_is_a_number", R"({"meter":"chw","unit":"kWh","readings":[1]})",
                  "400 malformed readings[0]"},
        WrongBody{"value_missing",
                  R"({"meter":"chw","unit":"kWh","readings":[{"time":"2024-03-30T10:00:00Z"}]})",
                  "400 invalid_value readings[0].value"},
        WrongBody{"time_is_no_instant",
                  R"({"meter":"chw","unit":"kWh","readings":[{"time":"noon","value":1}]})",
                  "400 invalid_value readings[0].time"},
        WrongBody{
            "value_as_text",
            R"({"meter":"chw","unit":"kWh","readings":[{"time":"2024-03-30T10:00:00Z","value":"1"}]})",
            "400 invalid_value readings[0].value"},
        WrongBody{
            "value_beyond_any_meter",
            R"({"meter":"chw","unit":"kWh","readings":[{"time":"2024-03-30T10:00:00Z","value":1e300}]})",
            "400 invalid_value readings[0].value"},
        WrongBody{
            "time_off_the_grid",
            R"({"meter":"chw","unit":"kWh","readings":[{"time":"2024-03-30T10:07:00Z","value":1}]})",
            "400 invalid_value readings[0].time"},
        WrongBody{
            "time_to_come",
            R"({"meter":"chw","unit":"kWh","readings":[{"time":"2024-03-30T12:00:00Z","value":1}]})",
            "400 invalid_value readings[0].time"},
        WrongBody{
            "time_long_past",
            R"({"meter":"chw","unit":"kWh","readings":[{"time":"2000-01-01T00:00:00Z","value":1}]})",
            "400 invalid_value readings[0].time"},
        WrongBody{"second_reading_misspelt", R"({"meter":"chw","unit":"kWh","readings":[
            {"time":"2024-03-30T10:00:00Z","value":1},{"time":"2024-03-30T10:15:00Z","valve":1}]})",
                  "400 malformed readings[1]"}),
    [](const auto& wrong) { return wrong.param.name; });

class PushedCounter : public PushedMeterSite {
 protected:
  PushedCounter() {
    MeterConfig& meter = site_.meters.back();
    meter = load(served_site() + R"(
[[meter]]
id = "chw"
source = "http"
utility = "electricity"
rated_kW = 40
counter = { unit = "kWh" }
)")
                .meters.back();
    begin();
  }

  /// Register samples from `start` on, a body each of so many.
  Json push(metering::Instant start, std::chrono::seconds step, int count,
            const std::function<double(metering::Instant)>& value_MWh) {
    std::string list;
    for (int i = 0; i < count; ++i) {
      const metering::Instant at = start + i * step;
      list += fmt::format(R"({}{{"time":"{}","value":{}}})", i == 0 ? "" : ",",
                          metering::to_string(at), value_MWh(at));
    }
    return taken(fmt::format(R"({{"meter":"chw","unit":"MWh","readings":[{}]}})", list));
  }
};

// Samples at any time, sent twice, through a restart and an exchange: what a polled counter would
// have made of them.
TEST_F(PushedCounter, IsCountedAsOneThatIsPolled) {
  const metering::Instant begin_at = kStart - hours{20};
  const auto reads = [&](metering::Instant t) {
    const double used_kWh = 14.4 * metering::in_hours(t - begin_at);
    const bool is_exchanged = t >= begin_at + hours{10};
    return (is_exchanged ? 900'000.0 + used_kWh : 182'034.5 + used_kWh) / 1000.0;
  };
  constexpr std::chrono::seconds kStep{301};
  for (int part = 0; part < 20; ++part) {
    EXPECT_EQ(push(begin_at + part * 11 * kStep, kStep, 11, reads)["stored"], 11);
    const Json again = push(begin_at + part * 11 * kStep, kStep, 11, reads);
    EXPECT_EQ(again["stored"], 0);
    EXPECT_EQ(again["known"], 11);
    if (part == 5) begin();  // as after a restart
  }
  int ok = 0;
  for (const Json& interval : intervals()) {
    if (interval["validity"] != "ok") continue;
    ++ok;
    EXPECT_NEAR(interval["mean_kW"].get<double>(), 14.4, 1e-3);
  }
  EXPECT_GT(ok, 65);
  loop_.run_for(minutes{1});
  EXPECT_THAT(get_json("/api/v1/events").dump(), HasSubstr("counter_jump"));
}

TEST_F(PushedCounter, APowerOrStampsOfIntervalsAreNoRegister) {
  const auto said = [&](const std::string& rest) {
    return in_short(post(R"({"meter":"chw",)" + rest +
                         R"("readings":[{"time":"2024-03-30T10:00:07Z","value":7}]})"));
  };
  EXPECT_EQ(said(R"("unit":"kW",)"), "400 invalid_value unit");
  EXPECT_EQ(said(R"("unit":"kWh","stamps":"end",)"), "400 invalid_value stamps");
  EXPECT_EQ(said(R"("unit":"kWh","reason":"x",)"), "400 invalid_value reason");
  EXPECT_EQ(said(R"("unit":"kWh",)"), "200");
}

class UnratedPushedMeter : public PushedMeterSite {
 protected:
  UnratedPushedMeter() {
    site_.meters.back().meter.rated_kW.reset();
    begin();
  }
};

// A register that is sent as an amount is stored in doubt, and the answer and an event say what to
// write.
TEST_F(UnratedPushedMeter, ValuesThatOnlyRiseAreDoubted) {
  std::string list;
  for (int i = 0; i < 4; ++i) {
    list +=
        fmt::format(R"({}{{"time":"{}","value":{}}})", i == 0 ? "" : ",",
                    metering::to_string(kStart - hours{3} + i * minutes{15}), 182034.5 + 3.6 * i);
  }
  const Json said = taken(fmt::format(R"({{"meter":"chw","unit":"kWh","readings":[{}]}})", list));
  EXPECT_THAT(said["doubt"].get<std::string>(), HasSubstr("counter = { unit = \"kWh\" }"));
  const Json stored = intervals();
  ASSERT_THAT(stored, SizeIs(4));
  for (const Json& interval : stored) EXPECT_EQ(interval["validity"], "suspect");
  loop_.run_for(minutes{1});
  EXPECT_THAT(get_json("/api/v1/events").dump(), HasSubstr("readings_rise"));
}

TEST_F(UnratedPushedMeter, OrdinaryAmountsAreNot) {
  const Json said = taken(body_of(kStart - hours{9}, 32, 5.0));
  EXPECT_FALSE(said.contains("doubt"));
  for (const Json& interval : intervals()) EXPECT_EQ(interval["validity"], "ok");
}

}  // namespace
}  // namespace recald::daemon
