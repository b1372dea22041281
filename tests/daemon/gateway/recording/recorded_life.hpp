/// A gateway on a virtual clock to which everything happens that can happen to one, and its
/// recording.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/random/rng.hpp"
#include "daemon/gateway/recording/recorder.hpp"
#include "daemon/gateway/replay/replay_recording.hpp"
#include "daemon/gateway/upkeep/export_csv.hpp"
#include "daemon/version.hpp"
#include "tests/daemon/gateway/weather_station.hpp"

namespace recald::daemon::testing {

inline constexpr const char* kOtherMeters = R"(
[mqtt]
url = "mqtts://broker.example.org"
user = "somebody"
password_file = "secret-password"

[http]
listen = "127.0.0.1:0"
token_file = "secret-token"

[[alerts.webhook]]
url = "https://hooks.example.org/secret-path"

[[meter]]
id = "steam"
source = "http"
utility = "steam"

[[meter]]
id = "hot_water"
source = "mqtt"
utility = "heating"
rated_kW = 300
energy_from = { topic = "plant/hot-water", unit = "kWh" }
)";

/// All that a store holds of readings, months and events, as text.
struct StoreTexts {
  std::string readings;
  std::string months;
  std::vector<std::string> events;  ///< In order of their numbers.
};

inline StoreTexts texts_of(Store& store, std::span<const StoredMeter> meters,
                           const metering::LocalCalendar& calendar) {
  constexpr metering::TimeSpan kAll{metering::Instant::min(), metering::Instant::max()};
  std::vector<StoredMeter> own{meters.begin(), meters.end()};
  for (StoredMeter& meter : own) meter.number = store.find_meter(meter.meter.id).value().value();
  std::ostringstream readings;
  std::ostringstream months;
  EXPECT_TRUE(export_readings(store, own, kAll, readings).has_value());
  EXPECT_TRUE(export_months(store, calendar, own, kAll, months).has_value());
  std::vector<std::string> events;
  const auto all = store.events_after(0, 1'000'000).value();
  for (const StoreEvent& event : all) {
    events.push_back(fmt::format("{} {} {} {} x{} {}", metering::to_string(event.time), event.kind,
                                 event.subject, event.text, event.count,
                                 metering::to_string(event.last.value_or(event.time))));
  }
  return {readings.str(), months.str(), events};
}

class RecordedLife : private RigInMemory {
 public:
  /// @param seed  Of what happens, and when.
  explicit RecordedLife(std::uint64_t seed) : RigInMemory{kRigStart}, rng_{seed} {
    recald::testing::write_text(folder_ / "station.toml", kStationMap);
    if (rng_.below(3) == 0) {
      const auto until = after(std::chrono::minutes{40});
      clock_->is_settling = [this, until] { return loop_.now().monotonic < until; };
    }
    for (std::uint8_t unit = 1; unit <= 3; ++unit) give_faults(unit);
    devices_[3].registers = [](milliseconds t) {
      return station_registers(usual_weather(hours_of(t)));
    };
  }

  /// Lives without a recording.
  void live(std::chrono::hours length) {
    begin(load(site()));
    loop_.run_for(length);
    EXPECT_TRUE(gateway_->flush().has_value());
  }

  /// Goes on as another process that records.
  void record(std::chrono::hours length, std::uint64_t limit_bytes = 1'000'000'000) {
    const SiteConfig config = load(site());
    own_ = recording::Recorder::create(file(), limit_bytes, [this](const std::string& why) {
             ended_.push_back(why);
           }).value();
    events_before_ = disk_.events(1'000'000).value().size();
    recorder_ = own_.get();
    before_start_ = [this, config] {
      const auto begun =
          own_->begin({config.file, kVersion, "2025b"}, disk_, calendar_, gateway_->meters());
      ASSERT_TRUE(begun.has_value()) << begun.error().message;
    };
    begin(config);
    plan(length);
    loop_.run_for(length);
    EXPECT_TRUE(gateway_->flush().has_value());
    own_->end("the test ended");
  }

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "recording.jsonl"; }
  /// Why the recording has ended before the gateway.
  [[nodiscard]] const std::vector<std::string>& ended() const { return ended_; }
  /// Of its own store, or of another with the same meters.
  StoreTexts texts() { return texts(disk_); }
  StoreTexts texts(Store& store) { return texts_of(store, gateway_->meters(), calendar_); }
  /// How many it had when the recording began.
  [[nodiscard]] std::size_t events_before() const { return events_before_; }

 private:
  using milliseconds = std::chrono::milliseconds;

  [[nodiscard]] static std::string site(const char* poll = "60s") {
    std::string text = two_meter_site("watermark = \"2h\"\n") + kOtherMeters + station();
    const std::string usual = "poll = \"60s\"";
    text.replace(text.find(usual), usual.size(), std::string{"poll = \""} + poll + "\"");
    return text;
  }

  /// Some time of that length from now.
  milliseconds within(milliseconds length) {
    return milliseconds{
        static_cast<std::int64_t>(rng_.below(static_cast<std::uint64_t>(length.count())))};
  }
  milliseconds after(milliseconds length) { return loop_.now().monotonic + within(length); }

  /// It is silent, answers with exceptions, and its counter begins at zero again.
  void give_faults(std::uint8_t unit) {
    constexpr std::chrono::hours kLife{24 * 8};
    const auto spans = [&](int count, std::chrono::minutes longest) {
      std::vector<std::pair<milliseconds, milliseconds>> all;
      for (int i = 0; i < count; ++i) {
        const auto begin = after(kLife);
        all.emplace_back(begin, begin + within(longest));
      }
      return [all](milliseconds t) {
        return std::ranges::any_of(
            all, [t](const auto& one) { return one.first <= t && t < one.second; });
      };
    };
    recald::testing::CounterDevice& device = devices_[unit];
    device.is_silent = spans(6, std::chrono::minutes{300});
    device.exception = [refuses = spans(6, std::chrono::minutes{90}),
                        is_busy = spans(6, std::chrono::minutes{20})](milliseconds t) {
      return is_busy(t) ? 6 : refuses(t) ? 2 : 0;
    };
    if (unit == 3) return;
    device.energy_kWh = [counted = device.energy_kWh, reset = after(kLife)](milliseconds t) {
      return t < reset ? counted(t) : counted(t) - counted(reset);
    };
    if (rng_.below(4) != 0) return;
    // From some day on it starts again with each third read.
    device.energy_kWh = [counted = device.energy_kWh, fails = after(kLife)](milliseconds t) {
      return t < fails ? counted(t) : static_cast<double>(t / std::chrono::minutes{1} % 3);
    };
  }

  /// What comes from others during the recording.
  void plan(std::chrono::hours length) {
    for (int i = 0; i < 3; ++i) {
      loop_.after(within(length), [this] {
        const milliseconds most = rng_.below(2) == 0 ? milliseconds{4'000} : std::chrono::hours{5};
        loop_.set_wall_clock(rng_.below(2) == 0 ? within(most) : -within(most));
      });
    }
    loop_.after(within(length),
                [this] { EXPECT_TRUE(gateway_->reload(load(site("30s"))).has_value()); });
    loop_.after(within(length), [this] { gateway_->begin_buses_anew(); });
    push_every_hour();
    tell_every_minute();
  }

  /// Readings of before, some of them late by days, with another value than before, or corrected.
  void push_every_hour() {
    loop_.after(std::chrono::minutes{55} + within(std::chrono::minutes{10}), [this] {
      const auto late = rng_.below(4) == 0 ? within(std::chrono::hours{80}) : milliseconds{0};
      const auto end = std::chrono::floor<std::chrono::hours>(loop_.now().wall - late);
      std::vector<metering::Reading> readings;
      for (int i = 4; i > 0; --i) {
        readings.push_back({.meter = 0,
                            .start = end - i * std::chrono::minutes{15},
                            .mean_kW = 100.0 / 3.0 + rng_.uniform()});
      }
      std::optional<Correction> correction;
      if (rng_.below(5) == 0) correction = Correction{"a person", "it was wrong", "0123"};
      EXPECT_TRUE(gateway_->take_pushed("steam", readings, correction).has_value());
      push_every_hour();
    });
  }

  /// A broker's values: some with a time, some of them out of order.
  void tell_every_minute() {
    loop_.after(std::chrono::seconds{50} + within(std::chrono::seconds{20}), [this] {
      const Moment now = loop_.now();
      MeterValue value{.meter = "hot_water",
                       .is_counter = true,
                       .value = 7.0 + 20.0 * hours_of(now.monotonic) / 3.0,
                       .measured = {}};
      if (rng_.below(3) == 0) value.measured = now.instant() - std::chrono::seconds{rng_.below(90)};
      if (rng_.below(60) != 0) {
        EXPECT_TRUE(gateway_->accept_mqtt(value).has_value());
      }
      tell_every_minute();
    });
  }

  Rng rng_;
  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  std::unique_ptr<recording::Recorder> own_;
  std::vector<std::string> ended_;
  std::size_t events_before_ = 0;
};

inline Result<ReplayedRecording> replay_text(const std::string& text, Store& store) {
  return replay_recording(csv::bytes_of(text), "recording.jsonl", store);
}

}  // namespace recald::daemon::testing
