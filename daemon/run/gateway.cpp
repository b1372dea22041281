#include "daemon/run/gateway.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A gateway without a clock battery wakes up in 1970 until somebody tells it the time.
constexpr Instant kEarliestTime =
    std::chrono::sys_days{std::chrono::year{2024} / std::chrono::January / 1};
constexpr milliseconds kClockSet{2'000};
constexpr std::size_t kHeldMax = 100'000;  // a day of sixty meters at one poll a minute
constexpr hours kUsualDays{24 * 31};
constexpr hours kMonthsEvery{1};

}  // namespace

Gateway::Gateway(const metering::LocalCalendar& calendar, const SiteConfig& site,
                 const GatewayPorts& ports, OnMonth on_month)
    : calendar_(calendar),
      ports_(ports),
      on_month_(std::move(on_month)),
      committer_(ports_.loop, ports_.store, {},
                 [this](const StoreBatch& batch, const CommitCounts&) { note_committed(batch); }),
      keeper_(ports_.store, calendar, site.closing, ports_.time_zone_release),
      self_(std::make_shared<Gateway*>(this)) {}

Gateway::~Gateway() = default;

Result<std::unique_ptr<Gateway>> Gateway::open(const SiteConfig& site,
                                               const metering::LocalCalendar& calendar,
                                               const GatewayPorts& ports, OnMonth on_month) {
  std::unique_ptr<Gateway> gateway{new Gateway{calendar, site, ports, std::move(on_month)}};
  for (const BusConfig& bus : site.buses) gateway->buses_.push_back({.config = bus});
  for (const MeterConfig& meter : site.meters) {
    if (!meter.live) continue;
    if (auto added = gateway->add_meter(meter); !added) return tl::unexpected(added.error());
  }
  gateway->make_runners();
  return gateway;
}

Result<void> Gateway::add_meter(const MeterConfig& config) {
  const LiveMeterConfig& live = *config.live;
  const auto number = ports_.store.meter_number(config.meter.id, config.meter.interval);
  if (!number) return tl::unexpected(number.error());
  auto reads = plan_reads(metered_fields(live.map), live.map.function, live.map.limits);
  if (!reads) {
    return failure(reads.error().code,
                   fmt::format("meter '{}': {}", config.meter.id, reads.error().message));
  }
  const auto states = ports_.store.registers(*number);
  if (!states) return tl::unexpected(states.error());

  TrackedMeter tracked{
      .number = *number,
      .id = config.meter.id,
      .map = live.map,
      .multiplier = config.multiplier,
      .counter = config.counter.value_or(
          metering::CounterSettings{.rated_kW = config.meter.rated_kW.value_or(0.0)}),
      .booking = {.interval = config.meter.interval, .sample_gap_max = 2 * live.poll}};
  const auto bus =
      std::ranges::find(buses_, live.bus, [](const LiveBus& known) { return known.config.name; });
  assert(bus != buses_.end() && "a checked site has the buses it names");
  const std::optional<RegisterState> state =
      states->empty() ? std::nullopt : std::optional{states->front()};
  LiveMeter meter{.stored = {*number, config.meter},
                  .config = live,
                  .track = MeterTrack{std::move(tracked), calendar_, state},
                  .reads = std::move(*reads),
                  .bus = static_cast<std::size_t>(bus - buses_.begin()),
                  .unit = bus->meters.size()};
  if (auto restored = restore(meter); !restored) return restored;
  bus->meters.push_back(meters_.size());
  meters_.push_back(std::move(meter));
  return {};
}

/// What a restart would otherwise forget: the usual day, the last interval, the closed months.
Result<void> Gateway::restore(LiveMeter& meter) {
  const auto extent = ports_.store.interval_extent(meter.stored.number);
  if (!extent) return tl::unexpected(extent.error());
  if (*extent) {
    const metering::TimeSpan recent{(*extent)->end - kUsualDays, Instant::max()};
    const auto read = ports_.store.for_each_interval(meter.stored.number, recent,
                                                     [&](const StoredInterval& stored) {
                                                       meter.track.remember(stored.reading);
                                                       meter.last_interval = stored.reading;
                                                     });
    if (!read) return read;
  }
  const auto months = ports_.store.months(meter.stored.number);
  if (!months) return tl::unexpected(months.error());
  if (!months->empty()) meter.closed_until = calendar_.month_span(months->back().month).end;
  return {};
}

void Gateway::make_runners() {
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    LiveBus& bus = buses_[b];
    if (bus.meters.empty()) continue;
    std::vector<PolledUnit> units;
    for (const std::size_t m : bus.meters) {
      const LiveMeter& meter = meters_[m];
      const LiveMeterConfig& live = meter.config;
      units.push_back(
          {.meter = meter.stored.meter.id,
           .unit = live.unit,
           .reads = meter.reads,
           .period = live.poll,
           .interval = meter.stored.meter.interval,
           .timeout = live.timeout > milliseconds{0} ? live.timeout : bus.config.timeout});
    }
    BusRules rules;
    rules.health.down_after = bus.config.down_after;
    rules.health.probe_max = bus.config.probe_max;
    rules.request_gap = bus.config.request_gap;
    bus.runner =
        std::make_unique<BusRunner>(ports_.loop, ports_.make_bus(bus.config),
                                    BusPoller{std::move(units), rules, Rng{ports_.seed, b}},
                                    [this, b](const PolledRead& read) { take(b, read); });
  }
}

void Gateway::start() {
  watch_clock(ports_.loop.now());
  for (LiveBus& bus : buses_) {
    if (bus.runner) bus.runner->start();
  }
  close_months_every_hour();
}

/// Stamps are good from the first plausible time on, and until the clock is set again.
void Gateway::watch_clock(const Moment& now) {
  const milliseconds offset = now.wall.time_since_epoch() - now.monotonic;
  const milliseconds moved =
      wall_minus_monotonic_ ? offset - *wall_minus_monotonic_ : milliseconds{0};
  wall_minus_monotonic_ = offset;
  const bool was_ok = std::exchange(clock_ok_, now.instant() >= kEarliestTime);
  if (!was_ok) {
    if (clock_ok_) release_held(now);
    return;
  }
  if (moved <= kClockSet && -moved <= kClockSet) return;
  for (LiveMeter& meter : meters_) meter.track.clock_was_set();
  committer_.add(
      {.events = {{now.instant(), Severity::warning, "clock_set", "",
                   fmt::format("the system clock was set {} by {} s; the time between is "
                               "missing from all meters",
                               moved > milliseconds{0} ? "forward" : "back",
                               std::abs(moved.count()) / 1000)}}});
}

/// Reads from before the first right time are stamped by how long ago they were.
void Gateway::release_held(const Moment& now) {
  for (const HeldRead& held : std::exchange(held_, {})) {
    const auto wall = now.wall - (now.monotonic - held.read.at.monotonic);
    take_for_meter(held.meter, held.read, std::chrono::floor<seconds>(wall));
  }
}

void Gateway::take(std::size_t bus, const PolledRead& read) {
  watch_clock(read.at);
  const std::size_t meter = buses_[bus].meters[read.order.unit];
  if (clock_ok_) {
    take_for_meter(meter, read, read.at.instant());
    return;
  }
  if (held_.size() >= kHeldMax) held_.pop_front();
  held_.push_back({meter, read});
}

void Gateway::take_for_meter(std::size_t index, const PolledRead& read, Instant at) {
  LiveMeter& meter = meters_[index];
  StoreBatch batch =
      meter.track.take(meter.reads[read.order.read], read.result, read.order.due, at);
  mark_late(batch, meter);
  committer_.add(std::move(batch));
}

/// An interval of a month that is closed already opens it again.
void Gateway::mark_late(StoreBatch& batch, LiveMeter& meter) {
  for (StoreBatch::Interval& interval : batch.intervals) {
    if (interval.reading.start >= meter.closed_until) break;
    interval.reading.late = true;
    const MeterMonth month{meter.stored.number, calendar_.month_of(interval.reading.start)};
    if (batch.reopened.empty() || batch.reopened.back() != month) batch.reopened.push_back(month);
  }
}

void Gateway::note_committed(const StoreBatch& batch) {
  for (const StoreBatch::Interval& interval : batch.intervals) {
    const auto meter =
        std::ranges::find(meters_, interval.reading.meter,
                          [](const LiveMeter& known) { return known.stored.number; });
    if (meter != meters_.end()) meter->last_interval = interval.reading;
  }
}

void Gateway::close_months() {
  if (!clock_ok_) return;
  std::vector<StoredMeter> stored;
  for (const LiveMeter& meter : meters_) stored.push_back(meter.stored);
  const auto closed = keeper_.close_due(stored, ports_.loop.now().instant());
  if (!closed) {
    committer_.add({.events = {{ports_.loop.now().instant(), Severity::error, "month_not_closed",
                                "", closed.error().message}}});
    return;
  }
  for (const ClosedFigure& one : *closed) {
    const auto meter = std::ranges::find(
        meters_, one.number, [](const LiveMeter& known) { return known.stored.number; });
    meter->closed_until = std::max(meter->closed_until, calendar_.month_span(one.figure.month).end);
    if (on_month_) on_month_(meter->stored.meter, one.figure);
  }
}

void Gateway::close_months_every_hour() {
  close_months();
  ports_.loop.after(kMonthsEvery, [weak = std::weak_ptr{self_}] {
    if (const auto self = weak.lock()) (*self)->close_months_every_hour();
  });
}

GatewayStatus Gateway::status() const {
  GatewayStatus status{.clock_ok = clock_ok_, .store = committer_.health()};
  for (const LiveMeter& meter : meters_) {
    const LiveBus& bus = buses_[meter.bus];
    const BusPoller& poller = bus.runner->poller();
    status.meters.push_back({.id = meter.stored.meter.id,
                             .bus = bus.config.name,
                             .state = poller.state(meter.unit),
                             .live = meter.track.live(),
                             .last_interval = meter.last_interval,
                             .skipped_polls = poller.skipped(meter.unit)});
  }
  return status;
}

}  // namespace recald::daemon
