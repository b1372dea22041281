/// Another site file under way: what it does not change goes on as if nothing had happened.
#include <gmock/gmock.h>

#include <cmath>

#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/run/gateway.hpp"
#include "tests/support/counter_bus.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"

namespace recald::daemon::reload_test {
namespace {

using metering::Instant;
using metering::Validity;
using recald::testing::CounterBus;
using recald::testing::CounterDevice;
using recald::testing::FailingStore;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::SizeIs;

constexpr const char* kSite = R"([site]
id = "tower"
timezone = "America/Chicago"
)";

std::string bus(const std::string& name, const std::string& more = "") {
  return "[bus." + name + "]\ntype = \"tcp\"\nhost = \"" + name + "\"\n" + more;
}

std::string meter(const std::string& id, const std::string& bus_name, int unit,
                  const std::string& more = "rated_kW = 400\n") {
  return "[[meter]]\nid = \"" + id +
         "\"\nsource = \"modbus\"\nutility = \"electricity\"\nbus = \"" + bus_name +
         "\"\nunit = " + std::to_string(unit) + "\nmap = \"counter.toml\"\n" + more;
}

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 2 / 28};

class Reload : public ::testing::Test {
 protected:
  Reload() {
    recald::testing::write_text(folder_ / "counter.toml", CounterBus::kMap);
    for (std::uint8_t unit = 1; unit <= 3; ++unit) {
      devices_[unit].energy_kWh = [unit](milliseconds t) {
        return 50.0 * unit * static_cast<double>(t.count()) / 3.6e6;
      };
    }
  }

  SiteConfig site(const std::string& text) {
    recald::testing::write_text(folder_ / "site.toml", kSite + text);
    auto loaded = load_site(folder_ / "site.toml");
    EXPECT_TRUE(loaded.has_value()) << loaded.error().front();
    return loaded.value_or(SiteConfig{});
  }

  void begin(const std::string& text) {
    auto opened = Gateway::open(site(text), calendar_,
                                {.loop = loop_,
                                 .store = store_,
                                 .make_bus =
                                     [this](const BusConfig& config) {
                                       made_.push_back(config.name);
                                       return std::make_unique<CounterBus>(loop_, devices_);
                                     },
                                 .time_zone_release = "2025b"},
                                {});
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    gateway_ = std::move(*opened);
    gateway_->start();
  }

  /// Readings that are not `ok` from the first whole interval on.
  int flawed(const std::string& id) {
    int counted = 0;
    const auto number = disk_.meter_number(id, seconds{900}).value();
    (void)disk_.for_each_interval(
        number, {kStart + minutes{15}, Instant::max()},
        [&](const StoredInterval& stored) { counted += stored.reading.validity != Validity::ok; });
    return counted;
  }
  double stored_kWh(const std::string& id) {
    double sum_kWh = 0.0;
    const auto number = disk_.meter_number(id, seconds{900}).value();
    (void)disk_.for_each_interval(number, {kStart + minutes{15}, kStart + hours{4}},
                                  [&](const StoredInterval& stored) {
                                    if (!std::isnan(stored.reading.mean_kW))
                                      sum_kWh += stored.reading.mean_kW * 0.25;
                                  });
    return sum_kWh;
  }
  std::vector<std::string> polled() {
    std::vector<std::string> ids;
    for (const MeterStatus& one : gateway_->status().meters) ids.push_back(one.id);
    return ids;
  }

  TemporaryFolder folder_;
  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  sqlite::SqliteStore disk_ = sqlite::SqliteStore::open(":memory:").value();
  FailingStore store_{disk_};
  VirtualLoop loop_{kStart};
  std::map<std::uint8_t, CounterDevice> devices_;
  std::vector<std::string> made_;
  std::unique_ptr<Gateway> gateway_;
};

const std::string kTwoBuses =
    bus("plant") + bus("roof") + meter("main", "plant", 1) + meter("lift", "roof", 2);

TEST_F(Reload, AFileThatSaysTheSameChangesNothing) {
  begin(kTwoBuses);
  loop_.run_for(hours{1} + minutes{7});
  const auto requests = gateway_->status().meters[0].poll->requests;
  // Comments, spaces and the order of keys are nothing that changed.
  ASSERT_TRUE(gateway_
                  ->reload(site("# again\n" + bus("roof") + bus("plant") +
                                meter("main", "plant", 1) + meter("lift", "roof", 2)))
                  .has_value());
  EXPECT_THAT(made_, ElementsAre("plant", "roof"));
  EXPECT_EQ(gateway_->status().meters[0].poll->requests, requests);
  loop_.run_for(hours{3});
  EXPECT_EQ(flawed("main"), 0);
  EXPECT_EQ(flawed("lift"), 0);
}

TEST_F(Reload, AChangedBusIsOpenedAnewAndItsNeighbourGoesOn) {
  begin(kTwoBuses);
  loop_.run_for(hours{1} + minutes{7});
  ASSERT_TRUE(gateway_
                  ->reload(site(bus("plant") + bus("roof", "request_gap = \"50ms\"\n") +
                                meter("main", "plant", 1) + meter("lift", "roof", 2)))
                  .has_value());
  EXPECT_THAT(made_, ElementsAre("plant", "roof", "roof"));
  loop_.run_for(hours{3});
  for (const char* id : {"main", "lift"}) EXPECT_EQ(flawed(id), 0) << id;
  EXPECT_NEAR(stored_kWh("main"), 50.0 * 3.75, 0.11);
  EXPECT_NEAR(stored_kWh("lift"), 100.0 * 3.75, 0.11);
}

TEST_F(Reload, ANewMeterIsPolledAndOneThatIsGoneIsNot) {
  begin(kTwoBuses);
  loop_.run_for(hours{1});
  ASSERT_TRUE(gateway_
                  ->reload(site(bus("plant") + bus("cellar") + meter("main", "plant", 1) +
                                meter("pump", "cellar", 3)))
                  .has_value());
  EXPECT_THAT(polled(), ElementsAre("main", "pump"));
  const auto lift = disk_.interval_extent(disk_.meter_number("lift", seconds{900}).value());
  loop_.run_for(hours{2});
  const auto later = disk_.interval_extent(disk_.meter_number("lift", seconds{900}).value());
  EXPECT_EQ((*lift)->end, (*later)->end);  // what was read of it stays
  const auto pump = disk_.interval_extent(disk_.meter_number("pump", seconds{900}).value());
  ASSERT_TRUE(pump.has_value() && pump->has_value());
  EXPECT_EQ((*pump)->end, kStart + hours{2} + minutes{30});
}

TEST_F(Reload, WhatIsKnownOfASilentDeviceIsNotForgotten) {
  devices_[2].is_silent = [](milliseconds) { return true; };
  begin(kTwoBuses);
  loop_.run_for(hours{2});
  ASSERT_EQ(gateway_->status().meters[1].poll->state, UnitState::down);
  ASSERT_TRUE(gateway_
                  ->reload(site(bus("plant", "timeout = \"2s\"\n") + bus("roof") +
                                meter("main", "plant", 1) + meter("lift", "roof", 2)))
                  .has_value());
  for (const MeterStatus& one : gateway_->status().meters) {
    EXPECT_EQ(one.poll->state, one.id == "lift" ? UnitState::down : UnitState::up) << one.id;
  }
}

TEST_F(Reload, AMapThatSaysSomethingElseIsAChange) {
  begin(kTwoBuses);
  auto text = std::string{CounterBus::kMap};
  text.replace(text.find("scale = 0.1"), 11, "scale = 0.2");
  recald::testing::write_text(folder_ / "counter.toml", text);
  ASSERT_TRUE(gateway_->reload(site(kTwoBuses)).has_value());
  EXPECT_THAT(made_, SizeIs(4));
}

// A counter goes on from what is stored, so a store that refuses means: not now.
TEST_F(Reload, WithAFullDiskEverythingStaysAsItWas) {
  begin(kTwoBuses);
  loop_.run_for(hours{1});
  store_.refuses = true;
  loop_.run_for(minutes{31});
  const auto reloaded = gateway_->reload(site(bus("plant") + meter("main", "plant", 3)));
  ASSERT_FALSE(reloaded.has_value());
  EXPECT_EQ(reloaded.error().code, ErrorCode::io_failed);
  EXPECT_THAT(polled(), ElementsAre("main", "lift"));
  store_.refuses = false;
  loop_.run_for(hours{3});
  for (const char* id : {"main", "lift"}) EXPECT_EQ(flawed(id), 0) << id;
}

}  // namespace
}  // namespace recald::daemon::reload_test
