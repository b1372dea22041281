/// A gateway with two meters on a virtual clock, whose energy is known at any instant: what writes
/// to the stores that a test breaks.
#pragma once

#include <cmath>
#include <map>
#include <memory>

#include "daemon/gateway/run/gateway.hpp"
#include "tests/support/counter_bus.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"

namespace recald::daemon::testing {

inline const metering::Instant kRigStart = std::chrono::sys_days{std::chrono::year{2024} / 2 / 28};

inline constexpr const char* kRigSite = R"([site]
id = "tower"
timezone = "America/Chicago"
watermark = "72h"

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
)";

/// Since kRigStart: 60 kW with a daily course of 30 kW, and 100 kW all day.
inline double main_kWh(std::chrono::milliseconds t) {
  const double h = static_cast<double>(t.count()) / 3.6e6;
  return 5000.0 + 60.0 * h + 30.0 * 24.0 / 6.283185307 * (1.0 - std::cos(h / 24.0 * 6.283185307));
}
inline double cooling_kWh(std::chrono::milliseconds t) {
  return 100.0 * static_cast<double>(t.count()) / 3.6e6;
}

/// The site file and its register map in a folder.
inline SiteConfig rig_site(const std::filesystem::path& folder) {
  recald::testing::write_text(folder / "counter.toml", recald::testing::CounterBus::kMap);
  recald::testing::write_text(folder / "site.toml", kRigSite);
  return load_site(folder / "site.toml").value();
}

/// Its meters began at kRigStart, whenever the loop did.
class GatewayRig {
 public:
  GatewayRig(const SiteConfig& site, Store& store, recald::testing::VirtualLoop& loop)
      : calendar_{metering::LocalCalendar::open(site.timezone).value()} {
    const auto since_start = [&loop](auto) {
      return loop.now().wall - std::chrono::sys_time<std::chrono::milliseconds>{kRigStart};
    };
    std::map<std::uint8_t, recald::testing::CounterDevice> devices;
    devices[1].energy_kWh = [=](auto t) { return main_kWh(since_start(t)); };
    devices[2].energy_kWh = [=](auto t) { return cooling_kWh(since_start(t)); };
    auto opened =
        Gateway::open(site, calendar_,
                      {.loop = loop,
                       .store = store,
                       .make_bus =
                           [&loop, devices](const BusConfig&) {
                             return std::make_unique<recald::testing::CounterBus>(loop, devices);
                           },
                       .time_zone_release = "2025b"},
                      {});
    if (!opened) throw std::runtime_error(opened.error().message);
    gateway_ = std::move(*opened);
    gateway_->start();
  }

  [[nodiscard]] const metering::LocalCalendar& calendar() const { return calendar_; }

 private:
  metering::LocalCalendar calendar_;
  std::unique_ptr<Gateway> gateway_;
};

}  // namespace recald::daemon::testing
