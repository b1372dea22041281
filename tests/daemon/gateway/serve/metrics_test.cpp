#include "daemon/gateway/serve/api/metrics.hpp"

#include <gmock/gmock.h>

#include "daemon/gateway/serve/api/prometheus_text.hpp"
#include "tests/daemon/gateway/serve/prometheus_parser.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

using recald::testing::Exposition;
using recald::testing::parse_prometheus;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::IsEmpty;

class Metrics : public ServedSite {
 protected:
  Exposition scrape() {
    const http::Response response = get("/metrics");
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.content_type, "text/plain; version=0.0.4; charset=utf-8");
    Exposition exposition = parse_prometheus(response.body);
    EXPECT_THAT(exposition.problems, IsEmpty());
    return exposition;
  }
};

TEST_F(Metrics, CountWhatTheGatewayDid) {
  loop_.run_for(hours{2} + seconds{30});
  const Exposition seen = scrape();
  EXPECT_EQ(seen.sample("recald_poll_requests_total{bus=\"plant\",meter=\"main\",result=\"ok\"}"),
            121);
  EXPECT_EQ(seen.sample("recald_poll_duration_seconds_count{bus=\"plant\"}"), 242);
  EXPECT_EQ(seen.sample("recald_poll_duration_seconds_bucket{bus=\"plant\",le=\"0.01\"}"), 0);
  EXPECT_EQ(seen.sample("recald_poll_duration_seconds_bucket{bus=\"plant\",le=\"0.025\"}"), 242);
  // Each device falls due at a time of its own, so the second does not wait for the first.
  EXPECT_EQ(seen.sample("recald_poll_lateness_seconds_count{bus=\"plant\"}"), 242);
  EXPECT_EQ(seen.sample("recald_poll_lateness_seconds_bucket{bus=\"plant\",le=\"0.001\"}"), 242);
  EXPECT_EQ(seen.sample("recald_poll_lateness_seconds_bucket{bus=\"plant\",le=\"0.025\"}"), 242);
  EXPECT_EQ(seen.sample("recald_unit_state{meter=\"main\"}"), 2);
  EXPECT_EQ(seen.sample("recald_last_reading_timestamp_seconds{meter=\"main\"}"),
            static_cast<double>((kStart + hours{2}).time_since_epoch().count()));
  EXPECT_EQ(seen.sample("recald_intervals_total{meter=\"main\",validity=\"ok\"}"), 8);
  EXPECT_EQ(seen.sample("recald_late_intervals_total{meter=\"main\"}"), 0);
  EXPECT_EQ(seen.sample("recald_clock_ok"), 1);
  EXPECT_EQ(seen.sample("recald_events_total{severity=\"error\"}"), 0);
  EXPECT_GE(seen.sample("recald_store_commit_seconds_count").value_or(0), 8);
  EXPECT_EQ(seen.sample("process_start_time_seconds"),
            static_cast<double>(kStart.time_since_epoch().count()));
}

TEST_F(Metrics, HaveTheLoadsAndRegisters) {
  EXPECT_EQ(scrape().sample("recald_power_kilowatts{meter=\"main\",utility=\"electricity\"}"),
            std::nullopt);  // nothing was read yet
  loop_.run_for(hours{2} + seconds{5});
  const Exposition seen = scrape();
  const auto of_main = [&](const std::string& name) {
    return seen.sample(name + "{meter=\"main\",utility=\"electricity\"}").value_or(-1.0);
  };
  EXPECT_NEAR(of_main("recald_register_kilowatthours"), 120.4, 1e-9);
  EXPECT_NEAR(of_main("recald_interval_mean_kilowatts"), 60.4, 1e-9);
}

// Eight hours of silence in a month that began at 05:00Z of the first.
TEST_F(Metrics, CoverageIsOfTheOpenMonth) {
  devices_[1].is_silent = [](milliseconds t) { return t > days{3} && t < days{3} + hours{8}; };
  begin();
  loop_.run_for(days{3} + hours{1});
  EXPECT_EQ(scrape().sample("recald_month_coverage_ratio{meter=\"cooling\"}"), 1.0);
  EXPECT_LT(scrape().sample("recald_month_coverage_ratio{meter=\"main\"}").value(), 1.0);
  loop_.run_for(days{3});
  const double hours_so_far = 6 * 24 + 1 - (24 + 17);  // since the local first of April
  EXPECT_NEAR(*scrape().sample("recald_month_coverage_ratio{meter=\"main\"}"),
              1.0 - 8.0 / hours_so_far, 0.01);
  begin();  // a restart takes it up from the store
  EXPECT_NEAR(*scrape().sample("recald_month_coverage_ratio{meter=\"main\"}"),
              1.0 - 8.0 / hours_so_far, 0.01);
}

TEST_F(Metrics, WhatWentWrongIsToldApart) {
  devices_.erase(2);
  begin();
  loop_.run_for(hours{1});
  const Exposition seen = scrape();
  EXPECT_EQ(seen.sample("recald_unit_state{meter=\"cooling\"}"), 0);
  EXPECT_GT(
      seen.sample("recald_poll_requests_total{bus=\"plant\",meter=\"cooling\",result=\"timeout\"}"),
      3);
  EXPECT_EQ(
      seen.sample("recald_poll_requests_total{bus=\"plant\",meter=\"cooling\",result=\"crc\"}"),
      std::nullopt);
  EXPECT_EQ(seen.sample("recald_last_reading_timestamp_seconds{meter=\"cooling\"}"), std::nullopt);
}

TEST_F(Metrics, CounterEventsAreCounted) {
  devices_[1].energy_kWh = [](milliseconds t) {
    return t < minutes{90} ? 5000.0 + 60.0 * testing::hours_of(t) : 60.0 * testing::hours_of(t);
  };
  begin();
  loop_.run_for(hours{2});
  EXPECT_EQ(scrape().sample("recald_counter_events_total{meter=\"main\",event=\"counter_reset\"}"),
            1);
  EXPECT_EQ(scrape().sample("recald_events_total{severity=\"warning\"}"), 1);
}

TEST_F(Metrics, AMeterInOrderHasFewSeries) {
  loop_.run_for(days{3});
  EXPECT_EQ(scrape().count_with("meter=\"main\""), 9);
  EXPECT_EQ(scrape().count_with("meter=\"old\""), 0);
}

TEST_F(Metrics, TheCalibrationInUse) {
  ASSERT_TRUE(disk_.add_job({.state = JobState::done,
                             .ended = kStart - hours{1},
                             .accepted = true,
                             .result = {.document = R"({"parameters":[{"rhat":1.01},{"rhat":null}],
                                 "hyperparameters":[{"rhat":1.02}],
                                 "drift":[{"output":"main_daily_kWh","pvalue":0.25,
                                 "log_evidence":1.5,"log_threshold":6.0,
                                 "daily":{"log_evidence":-1.0,"log_threshold":8.0}},
                                 {"output":"old","pvalue":0.5,"daily":null}]})"}}));
  const Exposition seen = scrape();
  EXPECT_EQ(seen.sample("recald_calibration_age_seconds{model=\"\"}"), 3600);
  EXPECT_EQ(seen.sample("recald_calibration_rhat_max{model=\"\"}"), 1.02);
  EXPECT_EQ(seen.sample("recald_drift_pvalue{model=\"\",output=\"main_daily_kWh\"}"), 0.25);
  const std::string ratio = "recald_drift_evidence_ratio{model=\"\",output=\"";
  EXPECT_EQ(seen.sample(ratio + "main_daily_kWh\",grain=\"month\"}"), 0.25);
  EXPECT_EQ(seen.sample(ratio + "main_daily_kWh\",grain=\"day\"}"), -0.125);
  EXPECT_EQ(seen.count_with("output=\"old\""), 1);  // a p-value alone
}

TEST_F(Metrics, GoOnWithoutTheStore) {
  store_.refuses = true;
  loop_.run_for(hours{1});
  EXPECT_GT(scrape().sample("recald_store_commit_seconds_count").value_or(0), 1);
}

TEST(PrometheusText, EscapesWhatCouldEndALine) {
  PrometheusText text;
  text.begin("a_total", "counter", "One\nline\\.");
  text.sample(1.5e-7, {{"x", "say \"hi\"\\\n"}});
  EXPECT_EQ(text.str(),
            "# HELP a_total One\\nline\\\\.\n# TYPE a_total counter\n"
            "a_total{x=\"say \\\"hi\\\"\\\\\\n\"} 1.5e-07\n");
}

TEST(PrometheusText, ParserRefusesWhatIsWrong) {
  for (const char* wrong :
       {"# HELP a x\n# TYPE a gauge\na 1", "a 1\n", "# HELP a x\n# TYPE a gauge\na 1\na 2\n",
        "# HELP a x\n# TYPE a counter\na 1\n", "# HELP a x\na 1\n",
        "# HELP a x\n# TYPE a gauge\nb 1\n", "# HELP a x\n# TYPE a gauge\na{x=1} 1\n",
        "# HELP a x\n# TYPE a histogram\na_bucket{le=\"1\"} 2\na_bucket{le=\"+Inf\"} 1\na_sum 1\n"
        "a_count 1\n"}) {
    EXPECT_FALSE(parse_prometheus(wrong).problems.empty()) << wrong;
  }
}

}  // namespace
}  // namespace recald::daemon
