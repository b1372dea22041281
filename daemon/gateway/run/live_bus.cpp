#include "daemon/gateway/run/live_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/modbus/sunspec_bus.hpp"

namespace recald::daemon {
namespace {

using std::chrono::milliseconds;

/// The site's meters on the bus of that name, in order of the file.
std::vector<const MeterConfig*> meters_on(const SiteConfig& site, const std::string& bus) {
  std::vector<const MeterConfig*> meters;
  for (const MeterConfig& meter : site.meters) {
    if (meter.live && meter.live->bus == bus) meters.push_back(&meter);
  }
  return meters;
}

/// Why a meter without a state should have one; empty: it need not. Samples are stored together
/// with the state that they led to, so where there are some, it was lost.
Result<std::string> lost_state(Store& store, std::uint32_t meter, const std::string& field) {
  std::string lost;
  const auto read = store.for_each_sample(meter, field, [&](const metering::RegisterSample&) {
    lost = "the state of its counter is not in the store any more";
  });
  if (!read) return tl::unexpected(read.error());
  return lost;
}

}  // namespace

Result<std::unique_ptr<LiveBus>> LiveBus::open(const SiteConfig& site, const BusConfig& bus,
                                               const metering::LocalCalendar& calendar,
                                               Store& store) {
  std::unique_ptr<LiveBus> live{new LiveBus{bus}};
  for (const MeterConfig* meter : meters_on(site, bus.name)) {
    if (auto added = live->add_meter(*meter, calendar, store); !added) {
      return tl::unexpected(added.error());
    }
  }
  return live;
}

Result<void> LiveBus::add_meter(const MeterConfig& config, const metering::LocalCalendar& calendar,
                                Store& store) {
  const LiveMeterConfig& live = *config.live;
  auto reads = plan_reads(metered_fields(live.map), live.map.function, live.map.limits);
  if (!reads) {
    return failure(reads.error().code,
                   fmt::format("meter '{}': {}", config.meter.id, reads.error().message));
  }
  std::vector<metering::Reading> recent;
  auto progress = MeterProgress::open(config.meter, calendar, store,
                                      [&](const metering::Reading& one) { recent.push_back(one); });
  if (!progress) return tl::unexpected(progress.error());
  const std::uint32_t number = progress->stored.number;
  auto states = store.registers(number);
  std::string doubt;
  if (!states && states.error().code == ErrorCode::malformed) {
    doubt = states.error().message;
    states = std::vector<RegisterState>{};
  }
  if (!states) return tl::unexpected(states.error());

  TrackedMeter tracked{
      .number = number,
      .id = config.meter.id,
      .map = live.map,
      .multiplier = config.multiplier,
      .counter = config.counter.value_or(
          metering::CounterSettings{.rated_kW = config.meter.rated_kW.value_or(0.0)}),
      .booking = {.interval = config.meter.interval, .sample_gap_max = 2 * live.poll}};
  // A map that once had a counter and now has none leaves the counter's state behind.
  const std::string field = live.map.energy.empty() ? "power" : "energy";
  const auto found = std::ranges::find(*states, field, &RegisterState::field);
  const std::optional<RegisterState> state =
      found == states->end() ? std::nullopt : std::optional{*found};
  if (!state && doubt.empty() && progress->last_interval) {
    auto lost = lost_state(store, number, field);
    if (!lost) return tl::unexpected(lost.error());
    doubt = std::move(*lost);
  }
  LiveMeter meter{.progress = std::move(*progress),
                  .config = live,
                  .text = config.text,
                  .track = MeterTrack{std::move(tracked), calendar, state},
                  .reads = std::move(*reads),
                  .doubt = std::move(doubt)};
  for (const metering::Reading& one : recent) meter.track.remember(one);
  meters_.push_back(std::move(meter));
  return {};
}

/// The bus; where it has SunSpec devices, one that finds their models first.
std::unique_ptr<Bus> LiveBus::make_bus(const Ports& ports) const {
  std::map<std::uint8_t, std::vector<std::uint16_t>> sunspec;
  for (const LiveMeter& meter : meters_) {
    const LiveMeterConfig& live = meter.config;
    if (!live.map.sunspec_models.empty()) sunspec[live.unit] = live.map.sunspec_models;
  }
  auto made = ports.make_bus(config_);
  if (sunspec.empty()) return made;
  return std::make_unique<modbus::SunSpecBus>(std::move(made), std::move(sunspec));
}

std::vector<PolledUnit> LiveBus::polled_units() const {
  std::vector<PolledUnit> units;
  for (const LiveMeter& meter : meters_) {
    const LiveMeterConfig& live = meter.config;
    units.push_back({.meter = meter.progress.stored.meter.id,
                     .unit = live.unit,
                     .reads = meter.reads,
                     .period = live.poll,
                     .interval = meter.progress.stored.meter.interval,
                     .timeout = live.timeout > milliseconds{0} ? live.timeout : config_.timeout});
  }
  return units;
}

void LiveBus::start(const Ports& ports, OnRead on_read) {
  if (meters_.empty()) return;
  BusRules rules;
  rules.health.down_after = config_.down_after;
  rules.health.probe_max = config_.probe_max;
  rules.request_gap = config_.request_gap;
  runner_ = std::make_unique<BusRunner>(
      ports.loop, make_bus(ports), BusPoller{polled_units(), rules, Rng{ports.seed, 0}},
      [this, on_read = std::move(on_read)](const PolledRead& read) {
        on_read(meters_[read.order.unit], read);
      });
  runner_->start();
}

void LiveBus::begin_anew(const Ports& ports) {
  if (runner_) runner_->begin_anew([&] { return make_bus(ports); });
}

bool LiveBus::is_described_by(const SiteConfig& site) const {
  const auto bus = std::ranges::find(site.buses, config_.name, &BusConfig::name);
  if (bus == site.buses.end() || *bus != config_) return false;
  return std::ranges::equal(meters_, meters_on(site, config_.name),
                            [](const LiveMeter& now, const MeterConfig* then) {
                              return now.text == then->text && now.config == *then->live &&
                                     now.progress.stored.meter.interval == then->meter.interval;
                            });
}

}  // namespace recald::daemon
