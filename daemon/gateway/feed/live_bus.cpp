#include "daemon/gateway/feed/live_bus.hpp"

#include <algorithm>
#include <utility>

#include "adapters/modbus/sunspec_bus.hpp"

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;

/// The site's meters and weather sensors on the bus of that name, in order of the file.
std::vector<const MeterConfig*> meters_on(const SiteConfig& site, const std::string& bus) {
  std::vector<const MeterConfig*> meters;
  for (const auto* const list : {&site.meters, &site.sensors}) {
    for (const MeterConfig& meter : *list) {
      if (meter.live && meter.live->bus == bus) meters.push_back(&meter);
    }
  }
  return meters;
}

}  // namespace

MeterStatus PolledFeed::status(metering::Instant now) const {
  MeterStatus status = RegisterFeed::status(now);
  status.poll = PollStatus{.bus = bus_.config().name, .refused = refused()};
  if (const BusRunner* const runner = bus_.runner()) {
    status.poll->state = runner->poller().state(unit_);
    status.poll->skipped = runner->poller().skipped(unit_);
    status.poll->requests = runner->counters().requests[unit_];
  }
  return status;
}

Result<std::unique_ptr<LiveBus>> LiveBus::open(const SiteConfig& site, const BusConfig& bus,
                                               const metering::LocalCalendar& calendar,
                                               Store& store) {
  std::unique_ptr<LiveBus> live{new LiveBus{bus}};
  for (const MeterConfig* meter : meters_on(site, bus.name)) {
    auto opened = TRY(meter->role == MeterRole::weather
                          ? open_sensor_registers(*meter, calendar, store)
                          : open_meter_registers(*meter, *meter->live, calendar, store));
    live->feeds_.push_back(
        std::make_unique<PolledFeed>(std::move(opened), *live, live->feeds_.size()));
  }
  return live;
}

/// Creates the bus; with SunSpec devices, one that finds their models first.
std::unique_ptr<Bus> LiveBus::make_bus(const Ports& ports) const {
  std::map<std::uint8_t, std::vector<std::uint16_t>> sunspec;
  for (const auto& feed : feeds_) {
    const LiveMeterConfig& live = feed->config();
    if (!live.map.sunspec_models.empty()) sunspec[live.unit] = live.map.sunspec_models;
  }
  auto made = ports.make_bus(config_);
  if (sunspec.empty()) return made;
  return std::make_unique<modbus::SunSpecBus>(std::move(made), std::move(sunspec));
}

std::vector<PolledUnit> LiveBus::polled_units() const {
  std::vector<PolledUnit> units;
  for (const auto& feed : feeds_) {
    const LiveMeterConfig& live = feed->config();
    units.push_back({.meter = feed->id(),
                     .unit = live.unit,
                     .reads = feed->reads(),
                     .period = live.poll,
                     .interval = feed->interval(),
                     .phase = poll_phase(config_.name, units.size(), feeds_.size()),
                     .timeout = live.timeout > milliseconds{0} ? live.timeout : config_.timeout});
  }
  return units;
}

void LiveBus::start(const Ports& ports, OnRead on_read) {
  if (feeds_.empty()) return;
  BusRules rules;
  rules.health.down_after = config_.down_after;
  rules.health.probe_max = config_.probe_max;
  rules.request_gap = config_.request_gap;
  runner_ = std::make_unique<BusRunner>(
      ports.loop, make_bus(ports), BusPoller{polled_units(), rules, Rng{ports.seed, 0}},
      [this, on_read = std::move(on_read)](const PolledRead& read) {
        on_read(*feeds_[read.order.unit], read);
      });
  runner_->start();
}

void LiveBus::begin_anew(const Ports& ports) {
  if (runner_) runner_->begin_anew([&] { return make_bus(ports); });
}

bool LiveBus::is_described_by(const SiteConfig& site) const {
  const auto bus = std::ranges::find(site.buses, config_.name, &BusConfig::name);
  if (bus == site.buses.end() || *bus != config_) return false;
  return std::ranges::equal(feeds_, meters_on(site, config_.name),
                            [](const auto& now, const MeterConfig* then) {
                              return now->text() == then->text && now->config() == *then->live &&
                                     now->interval() == then->meter.interval;
                            });
}

}  // namespace recald::daemon
