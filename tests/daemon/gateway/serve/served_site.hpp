/// A site with two polled meters and a recorded one, on a virtual clock, and what it serves.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/run/gateway.hpp"
#include "daemon/gateway/serve/served.hpp"
#include "tests/support/counter_bus.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"

namespace recald::daemon {

using Json = nlohmann::ordered_json;

inline constexpr const char* kServedSite = R"([site]
id = "tower"
name = "Tower <3>"
timezone = "America/Chicago"
watermark = "2h"

[bus.plant]
type = "tcp"
host = "unused"

[[meter]]
id = "main"
source = "modbus"
utility = "electricity"
bus = "plant"
unit = 1
map = "counter.toml"
rated_kW = 400
poll = "60s"

[[meter]]
id = "cooling"
source = "modbus"
utility = "chilled_water"
bus = "plant"
unit = 2
map = "counter.toml"
rated_kW = 900
poll = "60s"

[[meter]]
id = "old"
utility = "gas"
file = "old.csv"
)";

/// Its meters count from the start on (half a digit more than they show, so that no rounding
/// decides), 2024-03-30T12:00:00Z, so that a month closes soon.
class ServedSite : public ::testing::Test {
 protected:
  /// @param more  Of the site file.
  explicit ServedSite(const std::string& more = "") {
    recald::testing::write_text(folder_ / "counter.toml", recald::testing::CounterBus::kMap);
    recald::testing::write_text(folder_ / "site.toml", kServedSite + more);
    site_ = load_site(folder_ / "site.toml").value();
    devices_[1].energy_kWh = [](std::chrono::milliseconds t) {
      return 0.05 + 60.0 * hours_of(t) + unevenness_kWh(t);
    };
    devices_[2].energy_kWh = [](std::chrono::milliseconds t) {
      return 1000.05 + 100.0 * hours_of(t) + unevenness_kWh(t);
    };
    begin();
  }

  void begin() {
    gateway_.reset();
    gateway_ = std::move(Gateway::open(site_, calendar_,
                                       {.loop = loop_,
                                        .store = store_,
                                        .make_bus =
                                            [this](const BusConfig&) {
                                              return std::make_unique<recald::testing::CounterBus>(
                                                  loop_, devices_);
                                            },
                                        .time_zone_release = "2025b"},
                                       nullptr)
                             .value());
    gateway_->start();
  }

  http::Response get(const std::string& path, std::map<std::string, std::string> query = {}) {
    return answer(served_, {.path = path, .query = std::move(query)});
  }
  Json get_json(const std::string& path, std::map<std::string, std::string> query = {}) {
    const http::Response response = get(path, std::move(query));
    EXPECT_EQ(response.status, 200) << response.body;
    return Json::parse(response.body);
  }
  /// "400 invalid_value limit", for short.
  std::string refused(const std::string& path, std::map<std::string, std::string> query = {}) {
    return in_short(get(path, std::move(query)));
  }
  static std::string in_short(const http::Response& response) {
    const Json json = Json::parse(response.body, nullptr, false);
    if (!json.contains("error")) return std::to_string(response.status);
    return std::to_string(response.status) + " " + json["error"]["code"].get<std::string>() + " " +
           json["error"]["field"].get<std::string>();
  }
  /// 0.1 kWh more in every second interval: a load that never changes is a frozen meter.
  static double unevenness_kWh(std::chrono::milliseconds t) {
    return 0.1 * std::floor(2.0 * hours_of(t));
  }
  static double hours_of(std::chrono::milliseconds t) {
    return static_cast<double>(t.count()) / 3.6e6;
  }

  static constexpr metering::Instant kStart =
      std::chrono::sys_days{std::chrono::year{2024} / 3 / 30} + std::chrono::hours{12};

  recald::testing::TemporaryFolder folder_;
  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  sqlite::SqliteStore disk_ = sqlite::SqliteStore::open(":memory:").value();
  recald::testing::FailingStore store_{disk_};
  recald::testing::VirtualLoop loop_{kStart};
  SiteConfig site_;
  std::map<std::uint8_t, recald::testing::CounterDevice> devices_;
  std::unique_ptr<Gateway> gateway_;
  Served served_{.site = site_,
                 .calendar = calendar_,
                 .store = store_,
                 .status = [this] { return gateway_->status(); },
                 .meter_status = [this](const auto& id) { return gateway_->meter_status(id); },
                 .now = [this] { return loop_.now().instant(); },
                 .started = kStart,
                 .take_readings =
                     [this](const std::string& meter, auto readings) {
                       return gateway_->take_pushed(meter, std::move(readings));
                     }};
};

}  // namespace recald::daemon
