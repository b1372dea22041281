/// The registers' facts against what the API says of the same gateway, on a virtual clock.
#include "daemon/gateway/registers/register_watch.hpp"

#include <gmock/gmock.h>

#include "daemon/gateway/registers/register_table.hpp"
#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

class Watched : public ServedSite {
 protected:
  explicit Watched(const std::string& more = "") : ServedSite{more} {}

  void watch() {
    watch_ = std::make_unique<RegisterWatch>(loop_, served_, [this](const SiteFacts& facts) {
      ++published_;
      values_ = register_values(facts);
    });
    watch_->start();
  }
  [[nodiscard]] MeterFacts facts(std::size_t meter) const { return watch_->facts().meters[meter]; }

  std::unique_ptr<RegisterWatch> watch_;
  std::vector<std::uint16_t> values_;
  int published_ = 0;
};

TEST_F(Watched, SayWhatTheApiSays) {
  watch();
  loop_.run_for(days{4} + minutes{1});
  const Json meter = get_json("/api/v1/meters/main");
  const MeterFacts main = facts(0);
  EXPECT_EQ(main.state, MeterState::up);
  EXPECT_FALSE(main.is_silent);
  EXPECT_EQ(main.quality, 1);
  EXPECT_EQ(main.interval_mean_kW, meter["last_interval"]["mean_kW"].get<double>());
  EXPECT_EQ(metering::to_string(*main.interval_start),
            meter["last_interval"]["start"].get<std::string>());
  EXPECT_EQ(main.open.coverage, meter["open_month_coverage"].get<double>());
  const Json march = get_json("/api/v1/months", {{"meter", "main"}})["months"].back();
  ASSERT_EQ(march["month"], "2024-03");
  EXPECT_EQ(main.closed.month, std::chrono::year{2024} / 3);
  EXPECT_EQ(main.closed.daily_average_kWh, march["daily_average_kWh"].get<double>());
  EXPECT_EQ(main.closed.peak_kW, march["peak"]["peak_kW"].get<double>());
  EXPECT_EQ(main.closed.coverage, march["coverage"].get<double>());
  EXPECT_EQ(main.closed.is_usable, march["usable"].get<bool>());
  // April has begun at 05:00Z; of it every interval so far.
  double sum_kW = 0.0, most_kW = 0.0;
  const Json april =
      get_json("/api/v1/intervals",
               {{"meter", "main"}, {"from", "2024-04-01"}, {"limit", "10000"}})["intervals"];
  ASSERT_GT(april.size(), 200u);
  for (const Json& interval : april) {
    sum_kW += interval["mean_kW"].get<double>();
    most_kW = std::max(most_kW, interval["mean_kW"].get<double>());
  }
  EXPECT_EQ(main.open.month, std::chrono::year{2024} / 4);
  EXPECT_NEAR(main.open.daily_average_kWh, 24.0 * sum_kW / static_cast<double>(april.size()), 1e-9);
  EXPECT_EQ(main.open.peak_kW, most_kW);
  // The recorded meter has its block, and nothing in it.
  EXPECT_EQ(watch_->facts().meters.size(), 3u);
  EXPECT_EQ(facts(2).state, MeterState::recorded);
  EXPECT_TRUE(std::isnan(facts(2).open.daily_average_kWh));
  EXPECT_EQ(watch_->facts().quality, SiteQuality::good);
}

TEST_F(Watched, AreRenewedEveryTwoSeconds) {
  watch();
  EXPECT_EQ(published_, 1);
  loop_.run_for(seconds{21});
  EXPECT_EQ(published_, 11);
  ASSERT_EQ(values_.size(), 100u + 3u * 64u);
  EXPECT_EQ(values_[0], kMapVersion);
  EXPECT_EQ(values_[3], 20);
}

// Whatever was stored before, and what comes while it runs.
TEST_F(Watched, ARestartReadsTheMonthAgain) {
  watch();
  loop_.run_for(days{4} + minutes{1});
  const MeterFacts before = facts(0);
  begin();
  watch();
  loop_.run_for(minutes{1});
  EXPECT_EQ(facts(0).open.daily_average_kWh, before.open.daily_average_kWh);
  EXPECT_EQ(facts(0).open.peak_kW, before.open.peak_kW);
  EXPECT_EQ(facts(0).closed.daily_average_kWh, before.closed.daily_average_kWh);
}

TEST_F(Watched, AMeterThatFallsSilentIsCounted) {
  devices_[2].is_silent = [](std::chrono::milliseconds t) { return t > hours{2}; };
  begin();
  served_.status = [this] {
    GatewayStatus status = gateway_->status();
    for (MeterStatus& meter : status.meters) meter.live.power_kW = 61.5;  // as last read
    return status;
  };
  watch();
  loop_.run_for(hours{2} + minutes{20});
  EXPECT_FALSE(facts(1).is_silent);
  loop_.run_for(minutes{30});
  EXPECT_TRUE(facts(1).is_silent);
  EXPECT_EQ(facts(1).state, MeterState::down);
  EXPECT_TRUE(std::isnan(facts(1).power_kW));
  EXPECT_EQ(facts(0).power_kW, 61.5);
  EXPECT_FALSE(facts(0).is_silent);
  EXPECT_EQ(values_[9], 1);
}

TEST_F(Watched, AStoreThatRefusesIsNotReady) {
  watch();
  store_.refuses = true;
  loop_.run_for(hours{1});
  EXPECT_FALSE(watch_->facts().is_store_ok);
  EXPECT_EQ(watch_->facts().quality, SiteQuality::not_ready);
  EXPECT_TRUE(watch_->facts().is_clock_ok);
}

TEST_F(Watched, AClockThatIsNotSetHasNoMonth) {
  clock_->is_settling = [] { return true; };
  begin();
  watch();
  loop_.run_for(hours{1});
  EXPECT_FALSE(watch_->facts().is_clock_ok);
  EXPECT_FALSE(facts(0).open.month.has_value());
}

TEST_F(Watched, TheCalibrationInUseAndItsForecasts) {
  watch();
  loop_.run_for(days{4} + minutes{1});
  EXPECT_TRUE(std::isnan(watch_->facts().model_age_days));
  ASSERT_TRUE(disk_.add_job({.state = JobState::done,
                             .ended = loop_.now().instant() - hours{36},
                             .accepted = true,
                             .result = {.document = R"({"drift":[{"output":"cooling_daily_kWh",
                                 "month":"2024-03","log_evidence":6.0,"log_threshold":6.0}],
                                 "alarms":[{"month":"2024-03","output":"cooling_daily_kWh",
                                 "since":"2024-02","consequence":"none","explained_until":"2024-03",
                                 "causes":[{"kind":"effect","subject":"fouling",
                                 "probability":0.75}]}]})"}}));
  ASSERT_TRUE(disk_.add_job({.kind = JobKind::diagnosis,
                             .state = JobState::done,
                             .ended = loop_.now().instant(),
                             .accepted = true,
                             .result = {.document = R"({"added":["economiser_failed"]})"}}));
  const StoredForecast march{.output = "cooling_daily_kWh",
                             .month = std::chrono::year{2024} / 3,
                             .model_version = "a",
                             .q05 = 1.0,
                             .q50 = 2.0,
                             .q95 = 3.0};
  ASSERT_TRUE(disk_.add_forecasts({&march, 1}));
  EXPECT_TRUE(std::isnan(watch_->facts().model_age_days)) << "nobody has said so";
  watch_->refresh();
  loop_.run_for(seconds{3});
  const SiteFacts site = watch_->facts();
  EXPECT_NEAR(site.model_age_days, 1.5, 1e-3);
  EXPECT_EQ(site.alarms, 1);
  EXPECT_EQ(site.drift.state, DriftState::alarm);
  EXPECT_EQ(static_cast<int>(site.drift.alarm), 115);
  EXPECT_EQ(site.alarm_meter, 2);
  EXPECT_EQ(site.drift.since, std::chrono::year{2024} / 2);
  EXPECT_EQ(static_cast<int>(site.named), 112);
  EXPECT_EQ(site.meters[1].closed.forecast_kWh.q05, 1.0);
  EXPECT_EQ(site.meters[1].closed.forecast_kWh.q50, 2.0);
  EXPECT_EQ(site.meters[1].closed.forecast_kWh.q95, 3.0);
  EXPECT_TRUE(std::isnan(site.meters[0].closed.forecast_kWh.q50));
}

TEST_F(Watched, TheLoadExpectedInTheNewestHour) {
  std::vector<ExpectedMeter> expected{
      {"main", {{kStart, {1.0, 2.0, 3.0}}, {kStart + hours{1}, {4.0, 5.0, 6.0}}}}};
  served_.expected = [&]() -> const std::vector<ExpectedMeter>& { return expected; };
  watch();
  loop_.run_for(hours{3});
  EXPECT_EQ(facts(0).expected_kW.q05, 4.0);
  EXPECT_EQ(facts(0).expected_kW.q50, 5.0);
  EXPECT_EQ(facts(0).expected_kW.q95, 6.0);
  EXPECT_EQ(facts(0).expected_hour, kStart + hours{1});
  EXPECT_TRUE(std::isnan(facts(1).expected_kW.q50));
  loop_.run_for(hours{2});
  EXPECT_TRUE(std::isnan(facts(0).expected_kW.q50)) << "too old to be told";
  EXPECT_FALSE(facts(0).expected_hour.has_value());
}

// What the meter read until then, what is expected of the rest, and how far such forecasts are off.
TEST_F(Watched, TheForecastOfTheMonthThatGoesOn) {
  std::vector<ExpectedMeter> expected{{"main", {}}, {"cooling", {}}};
  served_.expected = [&]() -> const std::vector<ExpectedMeter>& { return expected; };
  watch();
  loop_.run_for(days{4} + minutes{1});
  EXPECT_TRUE(std::isnan(facts(0).open.forecast_kWh.q50));
  const metering::Month april = std::chrono::year{2024} / 4;
  const metering::Instant begin = calendar_.month_span(april).begin;
  const ExpectedMonth month{.month = april,
                            .rest_from = begin + hours{72},
                            .rest_kW = 40.0,
                            .mean_kW = 50.0,
                            .error_q05 = -0.1,
                            .error_q50 = 0.01,
                            .error_q95 = 0.2};
  expected[0].month = month;
  expected[1].month = month;
  expected[1].month->month = std::chrono::year{2024} / 3;  // the store has not told of April yet
  const double so_far_kWh = facts(0).open.daily_average_kWh;
  const double forecast_kWh = 0.1 * so_far_kWh + 0.9 * 24.0 * 40.0;
  const double scale_kWh = std::sqrt(forecast_kWh * 24.0 * 50.0);
  EXPECT_NEAR(facts(0).open.forecast_kWh.q05, forecast_kWh - 0.1 * scale_kWh, 1e-9);
  EXPECT_NEAR(facts(0).open.forecast_kWh.q50, forecast_kWh + 0.01 * scale_kWh, 1e-9);
  EXPECT_NEAR(facts(0).open.forecast_kWh.q95, forecast_kWh + 0.2 * scale_kWh, 1e-9);
  EXPECT_TRUE(std::isnan(facts(1).open.forecast_kWh.q50));
}

TEST(MonthSoFar, HasPeaksOfWholeBlocksAndNoEnergyOfWhatIsMissing) {
  const auto calendar = metering::LocalCalendar::open("Asia/Kolkata").value();
  metering::Meter meter;
  meter.peak.window = minutes{30};
  MonthSoFar month{meter, calendar, std::chrono::year{2026} / 3};
  EXPECT_TRUE(std::isnan(month.daily_average_kWh()));
  EXPECT_TRUE(std::isnan(month.peak_kW()));
  const metering::Instant begin = calendar.month_span(std::chrono::year{2026} / 3).begin;
  int slot = 0;
  const auto take = [&](double kW, metering::Validity validity = metering::Validity::ok) {
    metering::Reading reading;
    reading.start = begin + slot++ * minutes{15};
    reading.mean_kW = kW;
    reading.validity = validity;
    month.take(reading);
    month.take(reading);  // comes twice, counts once
  };
  take(10.0);
  take(20.0);  // 15
  take(30.0);
  take(40.0, metering::Validity::scaled);  // energy, and no peak
  take(90.0, metering::Validity::suspect);
  take(50.0);
  take(24.0);  // a block begins here, and not with the 50
  take(26.0);
  EXPECT_DOUBLE_EQ(month.peak_kW(), 25.0);
  EXPECT_DOUBLE_EQ(month.daily_average_kWh(), 24.0 * (10 + 20 + 30 + 40 + 50 + 24 + 26) / 7.0);
  ++slot;  // a hole
  take(80.0);
  take(20.0);
  EXPECT_DOUBLE_EQ(month.peak_kW(), 25.0);
  EXPECT_EQ(month.next(), begin + slot * minutes{15});
  metering::Reading of_april;
  of_april.start = month.span().end;
  of_april.mean_kW = 1e6;
  month.take(of_april);
  EXPECT_DOUBLE_EQ(month.peak_kW(), 25.0);
}

}  // namespace
}  // namespace recald::daemon
