/// A bus with its meters, as the site file describes them. A reload keeps or
/// replaces it as a whole.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/poll/bus_runner.hpp"
#include "daemon/gateway/run/live_meter.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

class LiveBus {
 public:
  struct Ports {
    Loop& loop;
    std::function<std::unique_ptr<Bus>(const BusConfig&)> make_bus;
    std::uint64_t seed;  ///< For the jitter of probes.
  };
  using OnRead = std::function<void(LiveMeter&, const PolledRead&)>;

  /// Registers the bus's meters with the store and restores their counters.
  /// @return the bus, or the store's failure; unsupported if a meter's reads cannot be planned.
  [[nodiscard]] static Result<std::unique_ptr<LiveBus>> open(
      const SiteConfig& site, const BusConfig& bus, const metering::LocalCalendar& calendar,
      Store& store);

  /// Opens the device and starts polling; does nothing for a bus without meters.
  void start(const Ports& ports, OnRead on_read);

  /// Opens the device again and forgets everything learned about it; the counters continue.
  void begin_anew(const Ports& ports);

  /// Whether the site file still describes this bus and its meters as when it was opened.
  [[nodiscard]] bool is_described_by(const SiteConfig& site) const;

  [[nodiscard]] const BusConfig& config() const { return config_; }
  [[nodiscard]] std::vector<LiveMeter>& meters() { return meters_; }
  [[nodiscard]] const std::vector<LiveMeter>& meters() const { return meters_; }
  /// Null before the start, and for a bus without meters.
  [[nodiscard]] const BusRunner* runner() const { return runner_.get(); }

 private:
  explicit LiveBus(BusConfig config) : config_(std::move(config)) {}
  [[nodiscard]] std::unique_ptr<Bus> make_bus(const Ports& ports) const;
  [[nodiscard]] std::vector<PolledUnit> polled_units() const;

  BusConfig config_;
  std::vector<LiveMeter> meters_;  ///< By unit of the poller.
  std::unique_ptr<BusRunner> runner_;
};

}  // namespace recald::daemon
