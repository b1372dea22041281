/// What was kept in memory while the disk did not let anybody open the store, once it does.
#include <gmock/gmock.h>

#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon::take_over_test {
namespace {

using metering::Instant;
using recald::testing::FailingStore;
using recald::testing::VirtualLoop;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using testing::kRigStart;

constexpr double kTick_kWh = 0.1 + 1e-6;  // two registers of 0.1 kWh bound an energy

/// Two meters with an interval a minute: eight days of one are more than a committer keeps while
/// its store refuses.
class TakeOver : public ::testing::Test {
 protected:
  TakeOver() {
    devices_[1].energy_kWh = testing::main_kWh;
    devices_[2].energy_kWh = testing::cooling_kWh;
  }

  std::unique_ptr<Gateway> open(Store& store) {
    return Gateway::open(site_, metering::LocalCalendar::open(site_.timezone).value(),
                         {.loop = loop_,
                          .store = store,
                          .make_bus =
                              [this](const BusConfig&) {
                                return std::make_unique<recald::testing::CounterBus>(loop_,
                                                                                     devices_);
                              },
                          .time_zone_release = "2025b"},
                         OnMonth{})
        .value();
  }
  void run_on(Store& store, std::chrono::milliseconds length) {
    const auto gateway = open(store);
    gateway->start();
    loop_.run_for(length);
    ASSERT_TRUE(gateway->flush().has_value());
  }
  static std::vector<metering::Reading> stored(Store& store, std::uint32_t meter) {
    std::vector<metering::Reading> readings;
    EXPECT_TRUE(store
                    .for_each_interval(meter, {Instant::min(), Instant::max()},
                                       [&](const StoredInterval& interval) {
                                         readings.push_back(interval.reading);
                                       })
                    .has_value());
    return readings;
  }
  /// Each minute of both meters, measured, with the energy that they counted.
  void expect_whole() {
    for (std::uint8_t meter = 0; meter < 2; ++meter) {
      const auto readings = stored(disk_, meter);
      ASSERT_FALSE(readings.empty());
      const auto minutes_passed = (loop_.now().instant() - kRigStart) / minutes{1};
      EXPECT_GE(std::ssize(readings), minutes_passed - 2);
      double sum_kWh = 0.0;
      for (std::size_t i = 0; i < readings.size(); ++i) {
        ASSERT_EQ(readings[i].start, readings.front().start + i * minutes{1});
        sum_kWh += readings[i].mean_kW / 60.0;
      }
      EXPECT_EQ(
          std::ranges::count(readings, metering::Validity::missing, &metering::Reading::validity),
          0);
      const auto counted_kWh = [&](Instant t) {
        return devices_.at(static_cast<std::uint8_t>(meter + 1)).energy_kWh(t - kRigStart);
      };
      EXPECT_NEAR(
          sum_kWh,
          counted_kWh(readings.back().start + minutes{1}) - counted_kWh(readings.front().start),
          kTick_kWh);
    }
  }

  recald::testing::TemporaryFolder folder_;
  VirtualLoop loop_{kRigStart};
  std::map<std::uint8_t, recald::testing::CounterDevice> devices_;
  SiteConfig site_ =
      testing::load_rig_site(folder_.path(), testing::two_meter_site("interval = \"1m\"\n"));
  sqlite::SqliteStore disk_ = sqlite::SqliteStore::open(":memory:").value();
  sqlite::SqliteStore memory_ = sqlite::SqliteStore::open(":memory:").value();
};

TEST_F(TakeOver, DaysInMemoryAreHandedOverWhole) {
  run_on(disk_, hours{2});
  run_on(memory_, days{8});
  const auto gateway = open(disk_);
  ASSERT_TRUE(gateway->take_over(memory_).has_value());
  EXPECT_EQ(gateway->status().store.lost_intervals, 0u);
  expect_whole();
}

// The disk is full again in the middle of it: all of it is handed over later, by another gateway.
TEST_F(TakeOver, OneThatFailsLeavesNothingAndIsDoneAgain) {
  run_on(disk_, hours{2});
  const std::size_t before = stored(disk_, 0).size();
  run_on(memory_, days{1});
  FailingStore failing{disk_};
  int commits = 0;
  failing.before_commit = [&](const StoreBatch&) { failing.refuses = ++commits >= 5; };
  const auto refused = open(failing)->take_over(memory_);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::io_failed);
  EXPECT_EQ(stored(disk_, 0).size(), before);
  run_on(memory_, hours{5});
  ASSERT_TRUE(open(disk_)->take_over(memory_).has_value());
  expect_whole();
}

// A reload has made it a meter whose readings are pushed: its counter is nobody's any more.
TEST_F(TakeOver, OfAMeterThatIsPushedSinceItsIntervals) {
  run_on(memory_, hours{3});
  const auto kept = stored(memory_, 0);
  ASSERT_GT(kept.size(), 150u);
  site_ = testing::load_rig_site(folder_.path(),
                                 testing::site_head("America/Chicago", "interval = \"1m\"\n") +
                                     "[http]\nlisten = \"127.0.0.1:0\"\n"
                                     "[[meter]]\nid = \"main\"\nsource = \"http\"\n"
                                     "utility = \"electricity\"\n");
  ASSERT_TRUE(open(disk_)->take_over(memory_).has_value());
  EXPECT_EQ(stored(disk_, 0).size(), kept.size());
}

}  // namespace
}  // namespace recald::daemon::take_over_test
