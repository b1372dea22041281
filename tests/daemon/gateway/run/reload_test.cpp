/// Another site file under way: what it does not change goes on as if nothing had happened.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon::reload_test {
namespace {

using metering::Instant;
using metering::Validity;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::SizeIs;

std::string bus(const std::string& name, const std::string& more = "") {
  return "[bus." + name + "]\ntype = \"tcp\"\nhost = \"" + name + "\"\n" + more;
}

std::string meter(const std::string& id, const std::string& bus_name, int unit,
                  const std::string& more = "rated_kW = 400\n") {
  return "[[meter]]\nid = \"" + id +
         "\"\nsource = \"modbus\"\nutility = \"electricity\"\nbus = \"" + bus_name +
         "\"\nunit = " + std::to_string(unit) + "\nmap = \"counter.toml\"\n" + more;
}

const Instant kStart = testing::kRigStart;

class Reload : public ::testing::Test, protected testing::RigInMemory {
 protected:
  Reload() : RigInMemory{kStart} {
    for (std::uint8_t unit = 1; unit <= 3; ++unit) {
      devices_[unit].energy_kWh = [unit](milliseconds t) {
        return 50.0 * unit * testing::hours_of(t);
      };
    }
  }

  SiteConfig site(const std::string& text) {
    return load(testing::site_head("America/Chicago") + text);
  }
  void begin(const std::string& text) { RigInMemory::begin(site(text)); }

  /// Readings that are not `ok` from the first whole interval on.
  int flawed(const std::string& id) {
    return static_cast<int>(std::ranges::count_if(
        stored(id, {kStart + minutes{15}, Instant::max()}),
        [](const metering::Reading& reading) { return reading.validity != Validity::ok; }));
  }
  double stored_kWh(const std::string& id) {
    return RigInMemory::stored_kWh(id, {kStart + minutes{15}, kStart + hours{4}});
  }
  std::vector<std::string> polled() {
    std::vector<std::string> ids;
    for (const MeterStatus& one : gateway_->status().meters) ids.push_back(one.id);
    return ids;
  }
};

const std::string kTwoBuses =
    bus("plant") + bus("roof") + meter("main", "plant", 1) + meter("lift", "roof", 2);

TEST_F(Reload, AnotherRuleClosesTheClosedMonthsAnewAndOnce) {
  const std::string meters = bus("plant") + meter("main", "plant", 1);
  begin(meters);
  loop_.run_for(hours{24 * 7});
  ASSERT_THAT(closed_, SizeIs(1)) << "February, two days of it";
  const auto stricter =
      load(testing::site_head("America/Chicago", "coverage_min = 0.01\n") + meters);
  ASSERT_TRUE(gateway_->reload(stricter).has_value());
  loop_.run_for(seconds{2});
  ASSERT_THAT(closed_, SizeIs(2));
  EXPECT_EQ(closed_[1].figure.month, closed_[0].figure.month);
  EXPECT_EQ(closed_[1].figure.revision, 1);
  ASSERT_TRUE(gateway_->reload(stricter).has_value());
  loop_.run_for(hours{2});
  EXPECT_THAT(closed_, SizeIs(2));
  const auto events = disk_.events(100).value();
  EXPECT_EQ(std::ranges::count(events, "rules_changed", &StoreEvent::kind), 1);
}

TEST_F(Reload, AFileThatSaysTheSameBeginsTheBusesAnewAndCostsNothing) {
  begin(kTwoBuses);
  loop_.run_for(hours{1} + minutes{7});
  const auto requests = gateway_->status().meters[0].poll->requests;
  // Comments, spaces and the order of keys are nothing that changed.
  ASSERT_TRUE(gateway_
                  ->reload(site("# again\n" + bus("roof") + bus("plant") +
                                meter("main", "plant", 1) + meter("lift", "roof", 2)))
                  .has_value());
  loop_.run_for(seconds{1});
  EXPECT_THAT(buses_made_, ElementsAre("plant", "roof", "plant", "roof"));
  auto once_more = requests;
  ++once_more[static_cast<std::size_t>(RequestResult::ok)];
  EXPECT_EQ(gateway_->status().meters[0].poll->requests, once_more);
  loop_.run_for(hours{3});
  EXPECT_EQ(flawed("main"), 0);
  EXPECT_EQ(flawed("lift"), 0);
}

// Meters are not polled at the same instant, and each keeps its place in the minute.
TEST_F(Reload, PlacesInThePeriodStay) {
  std::map<int, std::vector<WallTime>> polled_at;
  for (std::uint8_t unit = 1; unit <= 3; ++unit) {
    devices_[unit].energy_kWh = [&polled_at, this, unit](milliseconds t) {
      polled_at[unit].push_back(loop_.now().wall);
      return 50.0 * unit * testing::hours_of(t);
    };
  }
  const std::string two = bus("plant") + meter("a", "plant", 1) + meter("b", "plant", 2);
  begin(two);
  // Some minutes in the middle of an interval.
  const auto places = [&] {
    const milliseconds past = loop_.now().wall.time_since_epoch() % minutes{15};
    (void)loop_.run_for(minutes{20} - past);
    polled_at.clear();
    (void)loop_.run_for(minutes{5});
    std::map<int, std::set<milliseconds>> found;
    for (const auto& [unit, times] : polled_at) {
      for (const WallTime t : times) found[unit].insert(t.time_since_epoch() % minutes{1});
    }
    return found;
  };
  const auto before = places();
  ASSERT_THAT(before, SizeIs(2));
  const auto place_of = [](std::size_t unit) {
    return PollTimes{minutes{1}, minutes{15}, poll_phase("plant", unit, 2)}
               .after(kStart + minutes{5})
               .time_since_epoch() %
           minutes{1};
  };
  EXPECT_THAT(before.at(1), ElementsAre(place_of(0)));
  EXPECT_THAT(before.at(2), ElementsAre(place_of(1)));
  ASSERT_TRUE(reload(site(two + bus("other") + meter("c", "other", 3))).has_value());
  auto after = places();
  EXPECT_THAT(after, SizeIs(3));
  EXPECT_NE(after.at(3), before.at(1));
  after.erase(3);
  EXPECT_EQ(after, before);
}

TEST_F(Reload, AChangedBusIsOpenedAnewAndItsNeighbourGoesOn) {
  begin(kTwoBuses);
  loop_.run_for(hours{1} + minutes{7});
  ASSERT_TRUE(gateway_
                  ->reload(site(bus("plant") + bus("roof", "request_gap = \"50ms\"\n") +
                                meter("main", "plant", 1) + meter("lift", "roof", 2)))
                  .has_value());
  loop_.run_for(seconds{1});
  EXPECT_THAT(buses_made_, ElementsAre("plant", "roof", "roof", "plant"));
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

TEST_F(Reload, WhatIsKnownOfASilentDeviceIsForgotten) {
  devices_[2].is_silent = [](milliseconds) { return true; };
  begin(kTwoBuses);
  loop_.run_for(hours{2});
  ASSERT_EQ(gateway_->status().meters[1].poll->state, UnitState::down);
  ASSERT_TRUE(gateway_
                  ->reload(site(bus("plant", "timeout = \"2s\"\n") + bus("roof") +
                                meter("main", "plant", 1) + meter("lift", "roof", 2)))
                  .has_value());
  loop_.run_for(milliseconds{0});
  for (const MeterStatus& one : gateway_->status().meters) {
    EXPECT_EQ(one.poll->state, UnitState::up) << one.id;
  }
}

// As where the site file cannot be read: the old one goes on, on connections of now.
TEST_F(Reload, WithoutAFileTheBusesBeginAnewAndCountersGoOn) {
  bool works = false;
  devices_[2].is_silent = [&](milliseconds t) { return !works && t > hours{1}; };
  begin(kTwoBuses);
  loop_.run_for(hours{2});
  ASSERT_EQ(gateway_->status().meters[1].poll->state, UnitState::down);
  works = true;
  gateway_->begin_buses_anew();
  loop_.run_for(seconds{1});
  EXPECT_THAT(buses_made_, ElementsAre("plant", "roof", "plant", "roof"));
  EXPECT_EQ(gateway_->status().meters[1].poll->state, UnitState::up);
  loop_.run_for(hours{2});
  EXPECT_EQ(flawed("main"), 0);
  EXPECT_NEAR(stored_kWh("lift"), 100.0 * 3.75, 0.11);
}

TEST_F(Reload, WhatWaitsOnABusThatStaysIsTriedAtOnce) {
  bool works = false;
  devices_[2].exception = [&](milliseconds) { return works ? 0 : 0x02; };
  begin(kTwoBuses);
  loop_.run_for(hours{2});
  ASSERT_EQ(gateway_->status().meters[1].poll->state, UnitState::degraded);
  works = true;
  ASSERT_TRUE(gateway_->reload(site(kTwoBuses)).has_value());
  loop_.run_for(minutes{1} + seconds{1});  // with its next poll
  EXPECT_EQ(gateway_->status().meters[1].poll->state, UnitState::up);
}

TEST_F(Reload, AMapThatSaysSomethingElseIsAChange) {
  begin(kTwoBuses);
  auto text = std::string{recald::testing::CounterBus::kMap};
  text.replace(text.find("scale = 0.1"), 11, "scale = 0.2");
  recald::testing::write_text(folder_ / "counter.toml", text);
  ASSERT_TRUE(gateway_->reload(site(kTwoBuses)).has_value());
  EXPECT_THAT(buses_made_, SizeIs(4));
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
