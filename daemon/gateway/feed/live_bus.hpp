/// A bus with its meters, as the site file describes them. A reload keeps or
/// replaces it as a whole.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/feed/register_feed.hpp"
#include "daemon/gateway/poll/bus_runner.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

class LiveBus;

/// A meter or weather sensor on a bus.
class PolledFeed final : public RegisterFeed {
 public:
  /// @param unit  Of the bus's poller.
  PolledFeed(OpenedRegisters opened, const LiveBus& bus, std::size_t unit)
      : RegisterFeed(std::move(opened)), bus_(bus), unit_(unit) {}

  [[nodiscard]] MeterStatus status(metering::Instant now) const override;

 private:
  const LiveBus& bus_;
  std::size_t unit_;
};

class LiveBus {
 public:
  struct Ports {
    Loop& loop;
    std::function<std::unique_ptr<Bus>(const BusConfig&)> make_bus;
    std::uint64_t seed;  ///< For the jitter of probes.
  };
  using OnRead = std::function<void(MeterFeed&, const PolledRead&)>;

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
  /// In order of the poller's units.
  [[nodiscard]] const std::vector<std::unique_ptr<PolledFeed>>& feeds() const { return feeds_; }
  /// Null before the start, and for a bus without meters.
  [[nodiscard]] const BusRunner* runner() const { return runner_.get(); }

 private:
  explicit LiveBus(BusConfig config) : config_(std::move(config)) {}
  [[nodiscard]] std::unique_ptr<Bus> make_bus(const Ports& ports) const;
  [[nodiscard]] std::vector<PolledUnit> polled_units() const;

  BusConfig config_;
  std::vector<std::unique_ptr<PolledFeed>> feeds_;
  std::unique_ptr<BusRunner> runner_;
};

}  // namespace recald::daemon
