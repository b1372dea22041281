/// A site with two polled meters and a recorded one, on a virtual clock, and what it serves.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/gateway/serve/api/served.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon {

using Json = nlohmann::ordered_json;

inline std::string served_site() {
  return testing::two_meter_site("name = \"Tower <3>\"\nwatermark = \"2h\"\n") +
         "\n[[meter]]\nid = \"old\"\nutility = \"gas\"\nfile = \"old.csv\"\n";
}

/// Its meters count from the start on (half a digit more than they show, so that no rounding
/// decides), 2024-03-30T12:00:00Z, so that a month closes soon.
class ServedSite : public ::testing::Test, protected testing::RigInMemory {
 protected:
  /// @param more  Of the site file.
  explicit ServedSite(const std::string& more = "") : RigInMemory{kStart} {
    site_ = load(served_site() + more);
    devices_[1].energy_kWh = [](std::chrono::milliseconds t) {
      return 0.05 + 60.0 * testing::hours_of(t) + unevenness_kWh(t);
    };
    devices_[2].energy_kWh = [](std::chrono::milliseconds t) {
      return 1000.05 + 100.0 * testing::hours_of(t) + unevenness_kWh(t);
    };
    begin();
  }

  void begin() { RigInMemory::begin(site_); }
  /// From the start, polled every fifth minute: months show the same, in less than half the time.
  void pass_months(std::chrono::days days) {
    for (MeterConfig& meter : site_.meters) {
      if (meter.live) meter.live->poll = std::chrono::minutes{5};
    }
    begin();
    loop_.run_for(days);
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
    return 0.1 * std::floor(2.0 * testing::hours_of(t));
  }

  static constexpr metering::Instant kStart =
      std::chrono::sys_days{std::chrono::year{2024} / 3 / 30} + std::chrono::hours{12};

  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("America/Chicago").value();
  SiteConfig site_;
  Served served_{.site = site_,
                 .calendar = calendar_,
                 .store = store_,
                 .status = [this] { return gateway_->status(); },
                 .meter_status = [this](const auto& id) { return gateway_->meter_status(id); },
                 .now = [this] { return loop_.now().instant(); },
                 .clock_doubt = [this] { return gateway_->clock_doubt(); },
                 .started = kStart,
                 .take_readings =
                     [this](const std::string& meter, auto readings, const auto& correction) {
                       return gateway_->take_pushed(meter, std::move(readings), correction);
                     },
                 .take_samples =
                     [this](const std::string& meter, auto samples) {
                       return gateway_->take_samples(meter, std::move(samples));
                     }};
};

}  // namespace recald::daemon
