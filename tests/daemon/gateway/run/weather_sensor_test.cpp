/// A gateway with a weather sensor beside its meter: on the same bus, or sending.
#include <gmock/gmock.h>

#include <cmath>

#include "daemon/gateway/run/gateway.hpp"
#include "tests/daemon/gateway/weather_station.hpp"

namespace recald::daemon::weather_sensor_test {
namespace {

using metering::Instant;
using metering::Validity;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Instant kStart = testing::kRigStart;

class WeatherSensor : public ::testing::Test, protected testing::RigInMemory {
 protected:
  WeatherSensor() : RigInMemory{kStart} {
    recald::testing::write_text(folder_ / "station.toml", testing::kStationMap);
    devices_[3].registers = [this](milliseconds t) {
      return testing::station_registers(weather_(testing::hours_of(t)));
    };
    site_ = load(testing::site_head("America/Chicago", "watermark = \"2h\"\n") +
                 testing::kMainMeter + testing::station());
  }
  void begin() { RigInMemory::begin(site_); }

  [[nodiscard]] metering::TimeSpan march() const {
    return calendar_.month_span(std::chrono::year{2024} / 3);
  }
  std::vector<StoreEvent> events_of(std::string_view kind) {
    std::vector<StoreEvent> found;
    std::vector<StoreEvent> all = disk_.events(1000).value();
    for (StoreEvent& event : all) {
      if (event.kind == kind) found.push_back(std::move(event));
    }
    return found;
  }
  [[nodiscard]] MeterStatus roof() const { return gateway_->meter_status("roof").value(); }
  /// Of the true weather over a quarter of an hour.
  static double mean_dry_bulb_C(Instant start) {
    double sum = 0.0;
    for (int minute = 0; minute < 15; ++minute) {
      sum += testing::usual_weather(metering::in_hours(start - kStart) + (minute + 0.5) / 60.0)
                 .dry_bulb_C;
    }
    return sum / 15.0;
  }

  std::function<weather::WeatherHour(double hours)> weather_ = testing::usual_weather;
  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  SiteConfig site_;
};

TEST_F(WeatherSensor, AMonthFromRegistersToMeans) {
  begin();
  loop_.run_for(days{36} + minutes{1});
  const auto dry_bulb = stored("roof.dry_bulb_C", march());
  ASSERT_THAT(dry_bulb, SizeIs(31 * 96 - 4));
  for (const metering::Reading& one : dry_bulb) {
    EXPECT_EQ(one.validity, Validity::ok);
    ASSERT_NEAR(one.mean_kW, mean_dry_bulb_C(one.start), 0.05);
  }
  EXPECT_THAT(stored("roof.ghi_W_m2", march()), SizeIs(31 * 96 - 4));
  const MeterStatus status = roof();
  EXPECT_EQ(status.poll->state, UnitState::up);
  EXPECT_EQ(status.open_month_coverage, 1.0);
  ASSERT_THAT(status.weather, SizeIs(5));
  EXPECT_EQ(status.weather[0].quantity->name, "dry_bulb_C");
  EXPECT_EQ(status.weather[0].known_until, kStart + days{36});
  EXPECT_NEAR(status.weather[0].now.value(), testing::usual_weather(0.0).dry_bulb_C, 0.2);
  EXPECT_FALSE(status.weather[0].state.silent_since.has_value());
  EXPECT_THAT(gateway_->status().meters, SizeIs(2));
  // Degrees are no kilowatt-hours: no month of the weather is ever closed.
  EXPECT_THAT(closed_, SizeIs(2));
  for (const ClosedMonth& month : closed_) EXPECT_EQ(month.meter, "main");
  EXPECT_THAT(disk_.months(disk_.find_meter("roof.dry_bulb_C").value().value()).value(), IsEmpty());
}

TEST_F(WeatherSensor, SilentForAWeekItIsToldAndTheMonthCloses) {
  const milliseconds gone = march().begin - kStart + days{10} + minutes{1};
  devices_[3].is_silent = [=](milliseconds t) { return t > gone && t < gone + days{7}; };
  begin();
  loop_.run_for(gone + hours{5});
  EXPECT_THAT(events_of("weather_silent"), IsEmpty());
  loop_.run_for(hours{3});
  const auto told = events_of("weather_silent");
  ASSERT_THAT(told, SizeIs(1));
  EXPECT_EQ(told[0].subject, "roof");
  const Instant since = march().begin + days{10};
  EXPECT_THAT(told[0].text,
              AllOf(HasSubstr("has sent no dry_bulb_C, rel_humidity_pct, wind_speed_m_s"),
                    HasSubstr("since " + metering::to_string(since))));
  EXPECT_EQ(roof().poll->state, UnitState::down);
  EXPECT_EQ(roof().weather[0].state.silent_since, since);
  loop_.run_for(days{8});
  EXPECT_THAT(events_of("weather_silent"), SizeIs(1));
  ASSERT_THAT(events_of("weather_answers"), SizeIs(1));
  EXPECT_FALSE(roof().weather[0].state.silent_since.has_value());
  loop_.run_for(days{20});
  ASSERT_THAT(closed_, SizeIs(2));
  EXPECT_EQ(closed_[1].figure.coverage, 1.0);  // the meter's March
  const auto known = stored("roof.dry_bulb_C", march());
  EXPECT_NEAR(static_cast<double>(std::ssize(known)), 24 * 96 - 4, 4);
}

TEST_F(WeatherSensor, AThermometerThatStandsStillIsTold) {
  weather_ = [](double h) {
    weather::WeatherHour now = testing::usual_weather(h);
    if (h > 48.0 && h < 60.0) now.dry_bulb_C = 4.4;
    return now;
  };
  begin();
  loop_.run_for(days{2} + hours{6});
  EXPECT_FALSE(roof().weather[0].state.frozen_since.has_value());
  loop_.run_for(hours{2});
  ASSERT_THAT(events_of("weather_frozen"), SizeIs(1));
  EXPECT_THAT(events_of("weather_frozen")[0].text,
              HasSubstr("the same dry_bulb_C since 2024-03-01"));
  EXPECT_TRUE(roof().weather[0].state.frozen_since.has_value());
  loop_.run_for(hours{6});
  EXPECT_FALSE(roof().weather[0].state.frozen_since.has_value());
}

// Killed every few hours at odd minutes, and back within a minute.
TEST_F(WeatherSensor, KillsCostNoWeather) {
  begin();
  for (int kill = 0; kill < 60; ++kill) {
    loop_.run_for(hours{4} + minutes{7} + std::chrono::seconds{13 * kill % 60});
    gateway_.reset();
    loop_.run_for(std::chrono::seconds{20 + kill % 40});
    begin();
  }
  loop_.run_for(hours{1});
  const metering::TimeSpan whole{kStart, kStart + days{10}};
  for (const char* channel : {"roof.dry_bulb_C", "roof.wind_dir_deg", "roof.ghi_W_m2"}) {
    const auto readings = stored(channel, whole);
    ASSERT_THAT(readings, SizeIs(960)) << channel;
    EXPECT_EQ(std::ranges::count(readings, Validity::ok, &metering::Reading::validity), 960);
  }
  for (const metering::Reading& one : stored("roof.dry_bulb_C", whole)) {
    ASSERT_NEAR(one.mean_kW, mean_dry_bulb_C(one.start), 0.15);
  }
}

TEST_F(WeatherSensor, AFullDiskCostsNoWeather) {
  begin();
  loop_.run_for(days{1});
  store_.refuses = true;
  loop_.run_for(hours{20});
  store_.refuses = false;
  loop_.run_for(days{1});
  EXPECT_EQ(gateway_->status().store.lost_intervals, 0U);
  EXPECT_THAT(stored("roof.dry_bulb_C", {kStart, kStart + days{2}}), SizeIs(2 * 96));
}

// Before the clock is right nothing can be stamped; what was read then is stamped when it is.
TEST_F(WeatherSensor, Clock1970ThenSync) {
  const auto true_start = loop_.now().wall;
  loop_.set_wall_clock(-true_start.time_since_epoch());
  begin();
  loop_.run_for(hours{3});
  EXPECT_THAT(roof().weather, SizeIs(5));
  loop_.set_wall_clock(true_start.time_since_epoch());
  loop_.run_for(days{1});
  EXPECT_THAT(stored("roof.dry_bulb_C", {kStart + minutes{15}, kStart + days{1}}), SizeIs(95));
  EXPECT_THAT(events_of("weather_silent"), IsEmpty());
}

TEST_F(WeatherSensor, AReloadAddsAndRemovesIt) {
  site_ = load(testing::site_head("America/Chicago") + testing::kMainMeter);
  begin();
  loop_.run_for(hours{1});
  EXPECT_FALSE(gateway_->meter_status("roof").has_value());
  ASSERT_TRUE(reload(load(testing::site_head("America/Chicago") + testing::kMainMeter +
                          testing::station("interval = \"5m\"\n")))
                  .has_value());
  loop_.run_for(hours{1} + minutes{1});
  EXPECT_THAT(stored("roof.dry_bulb_C", {kStart, kStart + hours{2}}), SizeIs(12));
  ASSERT_TRUE(reload(site_).has_value());
  loop_.run_for(hours{1});
  EXPECT_FALSE(gateway_->meter_status("roof").has_value());
  EXPECT_THAT(stored("roof.dry_bulb_C", {kStart, kStart + hours{3}}), SizeIs(12));
}

/// The same sensor, sending.
class SendingSensor : public WeatherSensor {
 protected:
  explicit SendingSensor(const std::string& interval = "15m") {
    site_ =
        load(testing::site_head("America/Chicago", "watermark = \"2h\"\n") + testing::kMainMeter +
             "\n[http]\n[[meter]]\nid = \"roof\"\nrole = \"weather\"\nsource = \"http\"\n" +
             "interval = \"" + interval + "\"\n");
    begin();
  }
  void send_day(Instant start) {
    std::vector<metering::Reading> readings;
    for (int i = 0; i < 96; ++i) {
      const Instant at = start + i * minutes{15};
      readings.push_back({.meter = 0, .start = at, .mean_kW = mean_dry_bulb_C(at)});
    }
    ASSERT_TRUE(gateway_->take_pushed("roof.dry_bulb_C", std::move(readings)).has_value());
  }
};

// A day at a time is often enough; what is never sent is not missed.
TEST_F(SendingSensor, IsSilentWhenADayIsMissing) {
  for (int day = 0; day < 4; ++day) {
    loop_.run_for(days{1});
    send_day(kStart + days{day});
  }
  EXPECT_THAT(events_of("weather_silent"), IsEmpty());
  ASSERT_THAT(roof().weather, SizeIs(1));
  EXPECT_EQ(roof().weather[0].known_until, kStart + days{4});
  loop_.run_for(hours{38});
  ASSERT_THAT(events_of("weather_silent"), SizeIs(1));
  EXPECT_THAT(events_of("weather_silent")[0].text, HasSubstr("has sent no dry_bulb_C since"));
  send_day(kStart + days{4});
  loop_.run_for(hours{2});
  EXPECT_THAT(events_of("weather_answers"), SizeIs(1));
}

TEST_F(SendingSensor, ThatNeverSentIsTold) {
  loop_.run_for(hours{40});
  ASSERT_THAT(events_of("weather_silent"), SizeIs(1));
  EXPECT_THAT(roof().weather, SizeIs(1));
}

class SendingEachHour : public SendingSensor {
 protected:
  SendingEachHour() : SendingSensor("1h") {}
};

// Whole degrees of a foggy night stand still for half a day.
TEST_F(SendingEachHour, CoarseValuesAreNotFrozenAtOnce) {
  auto send_until_hour = [&, hour = 0](int end) mutable {
    std::vector<metering::Reading> readings;
    for (; hour < end; ++hour) {
      readings.push_back({.meter = 0, .start = kStart + hours{hour}, .mean_kW = 3.0});
    }
    loop_.run_for(kStart + hours{end} - loop_.now().instant());
    ASSERT_TRUE(gateway_->take_pushed("roof.dry_bulb_C", std::move(readings)).has_value());
  };
  send_until_hour(23);
  EXPECT_FALSE(roof().weather[0].state.frozen_since.has_value());
  send_until_hour(24);
  EXPECT_EQ(roof().weather[0].state.frozen_since, kStart);
}

}  // namespace
}  // namespace recald::daemon::weather_sensor_test
