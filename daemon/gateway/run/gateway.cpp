#include "daemon/gateway/run/gateway.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/absent.hpp"
#include "daemon/gateway/ingest/plausible_time.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kClockSet{2'000};
constexpr std::size_t kHeldMax = 100'000;  // a day of sixty meters at one poll a minute
constexpr hours kMonthsEvery{1};
constexpr int kEventsTakenOver = 10'000;
constexpr std::size_t kSamplesAtATime = 500;  // taken over between two looks at the store
constexpr std::size_t kMonthsAtATime = 12;    // of one meter, in one step of the loop

/// A day of all meters, and no less than usual, is kept while the store refuses.
CommitRules rules_for(const SiteConfig& site) {
  CommitRules rules;
  std::size_t intervals_a_day = 0;
  for (const MeterConfig& meter : site.meters) {
    if (meter.is_stored()) {
      intervals_a_day += static_cast<std::size_t>(hours{24} / meter.meter.interval);
    }
  }
  rules.intervals_max = std::max(rules.intervals_max, intervals_a_day);
  return rules;
}

}  // namespace

Gateway::Gateway(const metering::LocalCalendar& calendar, const SiteConfig& site,
                 const GatewayPorts& ports, OnMonth on_month)
    : calendar_(calendar),
      ports_(ports),
      on_month_(std::move(on_month)),
      committer_(ports_.loop, ports_.store, rules_for(site),
                 [this](const StoreBatch& batch, const CommitCounts& counts) {
                   note_committed(batch, counts);
                 }),
      keeper_(ports_.store, calendar, site.closing, ports_.time_zone_release),
      self_(std::make_shared<Gateway*>(this)) {}

Gateway::~Gateway() = default;

Result<std::unique_ptr<Gateway>> Gateway::open(const SiteConfig& site,
                                               const metering::LocalCalendar& calendar,
                                               const GatewayPorts& ports, OnMonth on_month) {
  std::unique_ptr<Gateway> gateway{new Gateway{calendar, site, ports, std::move(on_month)}};
  auto buses = gateway->open_buses(site, {});
  if (!buses) return tl::unexpected(buses.error());
  gateway->buses_ = std::move(*buses);
  if (auto opened = gateway->open_pushed(site); !opened) return tl::unexpected(opened.error());
  return gateway;
}

Result<std::vector<std::unique_ptr<LiveBus>>> Gateway::open_buses(
    const SiteConfig& site, std::span<const std::unique_ptr<LiveBus>> kept) {
  std::vector<std::unique_ptr<LiveBus>> opened;
  for (const BusConfig& bus : site.buses) {
    const bool is_kept = std::ranges::any_of(
        kept, [&](const auto& known) { return known && known->config().name == bus.name; });
    if (is_kept) continue;
    auto live = LiveBus::open(site, bus, calendar_, ports_.store);
    if (!live) return tl::unexpected(live.error());
    opened.push_back(std::move(*live));
  }
  return opened;
}

Result<void> Gateway::open_pushed(const SiteConfig& site) {
  std::vector<PushedMeter> opened;
  for (const MeterConfig& config : site.meters) {
    if (config.source != MeterSource::http) continue;
    auto progress = MeterProgress::open(config.meter, calendar_, ports_.store);
    if (!progress) return tl::unexpected(progress.error());
    PushedMeter meter{.progress = std::move(*progress)};
    const auto known =
        std::ranges::find(pushed_, meter.progress.stored.number,
                          [](const auto& one) { return one.progress.stored.number; });
    if (known != pushed_.end()) {
      meter.progress.counters = known->progress.counters;
      meter.heard_at = known->heard_at;
    }
    opened.push_back(std::move(meter));
  }
  pushed_ = std::move(opened);
  return {};
}

Result<void> Gateway::take_over(Store& memory, const std::function<void()>& on_progress) {
  // In part it would not be found again: a counter does not go back to what lies behind it.
  return ports_.store.as_one([&] { return take_over_all(memory, on_progress); });
}

Result<void> Gateway::take_over_all(Store& memory, const std::function<void()>& on_progress) {
  auto events = memory.events(kEventsTakenOver);
  if (!events) return tl::unexpected(events.error());
  std::ranges::reverse(*events);
  committer_.add({.events = std::move(*events)});
  for (MeterProgress* const progress : all_progress()) {
    if (on_progress) on_progress();
    const auto number = memory.find_meter(progress->stored.meter.id);
    if (!number) return tl::unexpected(number.error());
    if (!*number) continue;
    std::vector<metering::RegisterSample> samples;
    const auto read = memory.for_each_sample(
        **number, "energy",
        [&](const metering::RegisterSample& sample) { samples.push_back(sample); });
    if (!read) return read;
    LiveMeter* const meter = find_meter(progress->stored.number);
    const auto taken = meter != nullptr && !samples.empty()
                           ? take_over_samples(*meter, samples)
                           : take_over_intervals(*progress, memory, **number);
    if (!taken) return taken;
  }
  return committer_.flush();
}

Result<void> Gateway::take_over_samples(LiveMeter& meter,
                                        std::span<const metering::RegisterSample> samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    StoreBatch batch = meter.track.take_kept(samples[i]);
    meter.progress.mark_late(batch, calendar_);
    committer_.add(std::move(batch));
    if ((i + 1) % kSamplesAtATime != 0) continue;
    if (auto flushed = committer_.flush(); !flushed) return flushed;
  }
  return committer_.flush();
}

Result<void> Gateway::take_over_intervals(MeterProgress& progress, Store& memory,
                                          std::uint32_t number) {
  StoreBatch batch;
  const auto read = memory.for_each_interval(
      number, {Instant::min(), Instant::max()}, [&](const StoredInterval& interval) {
        batch.intervals.push_back({interval.reading});
        batch.intervals.back().reading.meter = progress.stored.number;
      });
  if (!read) return read;
  progress.mark_late(batch, calendar_);
  committer_.add(std::move(batch));
  return committer_.flush();
}

void Gateway::start() {
  watch_clock(ports_.loop.now());
  for (const auto& bus : buses_) start(*bus);
  close_months_every_hour();
}

void Gateway::start(LiveBus& bus) {
  bus.start(ports_of(bus), [this](LiveMeter& meter, const PolledRead& read) { take(meter, read); });
  for (LiveMeter& meter : bus.meters()) {
    if (meter.doubt.empty()) continue;
    const std::string& id = meter.progress.stored.meter.id;
    note({ports_.loop.now().instant(), Severity::error, "counter_state_lost", id,
          fmt::format("meter '{}': {}; its counter starts anew, and what it counted since the last "
                      "interval is not known",
                      id, std::exchange(meter.doubt, {}))});
  }
}

LiveBus::Ports Gateway::ports_of(const LiveBus& bus) const {
  return {ports_.loop, ports_.make_bus, ports_.seed + std::hash<std::string>{}(bus.config().name)};
}

/// In a step of the loop each: to end a bus waits for the read under way.
void Gateway::begin_buses_anew() {
  for (const auto& bus : buses_) {
    ports_.loop.after(milliseconds{0}, [weak = std::weak_ptr{self_}, name = bus->config().name] {
      const auto self = weak.lock();
      if (!self) return;
      for (const auto& live : (*self)->buses_) {
        if (live->config().name == name) live->begin_anew((*self)->ports_of(*live));
      }
    });
  }
}

Result<void> Gateway::reload(const SiteConfig& site) {
  // A counter goes on from what is stored: all of it has to be.
  if (auto flushed = committer_.flush(); !flushed) return flushed;
  const auto changed = std::stable_partition(
      buses_.begin(), buses_.end(), [&](const auto& bus) { return bus->is_described_by(site); });
  const std::span kept{buses_.begin(), changed};
  auto opened = open_buses(site, kept);
  if (!opened) return tl::unexpected(opened.error());
  if (auto pushed = open_pushed(site); !pushed) return pushed;
  buses_.erase(changed, buses_.end());  // a serial line has one owner: the old one ends first
  begin_buses_anew();                   // those that stay
  // Reads that are held were planned by a description that may be another now.
  std::erase_if(held_, [&](const HeldRead& held) { return find_meter(held.meter) == nullptr; });
  for (auto& bus : *opened) {
    start(*bus);
    buses_.push_back(std::move(bus));
  }
  keeper_.set_options(site.closing);
  // Rules that changed close months anew, but not before the reload has ended.
  ports_.loop.post([weak = std::weak_ptr{self_}] {
    if (const auto self = weak.lock()) (*self)->close_months();
  });
  return {};
}

LiveMeter* Gateway::find_meter(std::uint32_t number) {
  for (const auto& bus : buses_) {
    for (LiveMeter& meter : bus->meters()) {
      if (meter.progress.stored.number == number) return &meter;
    }
  }
  return nullptr;
}

std::vector<MeterProgress*> Gateway::all_progress() {
  std::vector<MeterProgress*> all;
  for (const auto& bus : buses_) {
    for (LiveMeter& meter : bus->meters()) all.push_back(&meter.progress);
  }
  for (PushedMeter& meter : pushed_) all.push_back(&meter.progress);
  return all;
}

MeterProgress* Gateway::find_progress(std::uint32_t number) {
  if (LiveMeter* const meter = find_meter(number)) return &meter->progress;
  const auto pushed = std::ranges::find(
      pushed_, number, [](const PushedMeter& one) { return one.progress.stored.number; });
  return pushed == pushed_.end() ? nullptr : &pushed->progress;
}

/// Stamps are good from the first plausible time on, and until the clock is set again.
void Gateway::watch_clock(const Moment& now) {
  const milliseconds offset = now.wall.time_since_epoch() - now.monotonic;
  const milliseconds moved =
      wall_minus_monotonic_ ? offset - *wall_minus_monotonic_ : milliseconds{0};
  wall_minus_monotonic_ = offset;
  // Once it has settled it is not asked again: a clock that loses its server still runs.
  const bool is_settled = clock_ok_ || !ports_.is_clock_settling || !ports_.is_clock_settling();
  const bool was_ok = std::exchange(clock_ok_, is_settled && is_plausible_time(now.instant()));
  if (!was_ok) {
    if (clock_ok_) release_held(now);
    return;
  }
  if (moved <= kClockSet && -moved <= kClockSet) return;
  for (const auto& bus : buses_) {
    for (LiveMeter& meter : bus->meters()) meter.track.clock_was_set();
  }
  note({now.instant(), Severity::warning, "clock_set", "",
        fmt::format("the system clock was set {} by {} s; the time between is missing from all "
                    "meters",
                    moved > milliseconds{0} ? "forward" : "back", std::abs(moved.count()) / 1000)});
}

/// Reads from before the first right time are stamped by how long ago they were.
void Gateway::release_held(const Moment& now) {
  for (const HeldRead& held : std::exchange(held_, {})) {
    const auto wall = now.wall - (now.monotonic - held.read.at.monotonic);
    LiveMeter* const meter = find_meter(held.meter);
    if (meter != nullptr) take_at(*meter, held.read, std::chrono::floor<seconds>(wall));
  }
}

void Gateway::hand_in(StoreBatch batch) {
  if (ports_.on_event) std::ranges::for_each(batch.events, ports_.on_event);
  committer_.add(std::move(batch));
}

void Gateway::take(LiveMeter& meter, const PolledRead& read) {
  watch_clock(read.at);
  if (clock_ok_) {
    take_at(meter, read, read.at.instant());
    return;
  }
  if (held_.size() >= kHeldMax) held_.pop_front();
  held_.push_back({meter.progress.stored.number, read});
}

void Gateway::take_at(LiveMeter& meter, const PolledRead& read, Instant at) {
  StoreBatch batch =
      meter.track.take(meter.reads[read.order.read], read.result, read.order.due, at);
  meter.progress.mark_late(batch, calendar_);
  hand_in(std::move(batch));
}

Result<CommitCounts> Gateway::take_pushed(const std::string& meter,
                                          std::vector<metering::Reading> readings,
                                          const std::optional<Correction>& correction) {
  const auto pushed = std::ranges::find(
      pushed_, meter, [](const PushedMeter& one) { return one.progress.stored.meter.id; });
  if (pushed == pushed_.end()) {
    return failure(ErrorCode::not_found, "no readings are taken of a meter '" + meter + "'");
  }
  StoreBatch batch;
  for (metering::Reading& reading : readings) {
    reading.meter = pushed->progress.stored.number;
    batch.intervals.push_back({.reading = reading, .supersedes = correction.has_value()});
  }
  pushed->progress.mark_late(batch, calendar_);
  watch_clock(ports_.loop.now());
  const Instant now = ports_.loop.now().instant();
  auto counts = commit_pushed(batch, correction, now);
  if (!counts) return counts;
  pushed->heard_at = now;
  note_committed(batch, *counts);
  tell_of_pushed(meter, *counts, correction, now);
  return counts;
}

Result<CommitCounts> Gateway::commit_pushed(StoreBatch& batch,
                                            const std::optional<Correction>& correction,
                                            Instant now) {
  if (!correction) return ports_.store.commit(batch);
  CommitCounts counts;
  const auto kept = ports_.store.as_one([&]() -> Result<void> {
    const auto edit = ports_.store.add_edit({.time = now,
                                             .author = correction->author,
                                             .reason = correction->reason,
                                             .file = "POST /api/v1/readings",
                                             .sha256 = correction->sha256});
    if (!edit) return tl::unexpected(edit.error());
    batch.edit = *edit;
    auto committed = ports_.store.commit(batch);
    if (!committed) return tl::unexpected(committed.error());
    counts = std::move(*committed);
    return counts.taken > 0 ? Result<void>{} : ports_.store.remove_edit(*edit);
  });
  if (!kept) return tl::unexpected(kept.error());
  return counts;
}

void Gateway::tell_of_pushed(const std::string& meter, const CommitCounts& counts,
                             const std::optional<Correction>& correction, Instant now) {
  if (!counts.conflicts.empty()) {
    note({.time = now,
          .severity = Severity::warning,
          .kind = "reading_conflict",
          .subject = meter,
          .text = fmt::format("{} readings were sent again with another value, the first of {}; "
                              "what was there stays",
                              counts.conflicts.size(),
                              metering::to_string(counts.conflicts.front().start)),
          .is_counted = true});
  }
  if (correction && counts.taken > 0) {
    note({now, Severity::info, "readings_corrected", meter,
          fmt::format("{} readings were put right by {}: {}", counts.taken, correction->author,
                      correction->reason)});
  }
}

void Gateway::note_committed(const StoreBatch& batch, const CommitCounts& counts) {
  for (std::size_t i = 0; i < batch.intervals.size(); ++i) {
    if (!counts.was_taken[i]) continue;
    const metering::Reading& reading = batch.intervals[i].reading;
    MeterProgress* const progress = find_progress(reading.meter);
    if (progress != nullptr) progress->note(reading);
  }
  for (const StoreEvent& event : batch.events) {
    ++events_[static_cast<std::size_t>(event.severity)];
    for (MeterProgress* const progress : all_progress()) {
      if (progress->stored.meter.id == event.subject) ++progress->counters.events[event.kind];
    }
  }
}

void Gateway::close_months() {
  watch_clock(ports_.loop.now());
  if (!clock_ok_) return;
  // A month is closed out of the store: what still waits for it would be missing.
  if (!committer_.flush()) return;
  std::vector<std::uint32_t> meters;
  for (const MeterProgress* const progress : all_progress()) {
    meters.push_back(progress->stored.number);
  }
  std::ranges::reverse(meters);
  close_months_of(std::move(meters));
}

/// The last one of them first, some of its months at a time, and the others after what else waits
/// for the loop: a thousand months take seconds.
void Gateway::close_months_of(std::vector<std::uint32_t> meters) {
  if (meters.empty()) return;
  // A reload may have taken it away meanwhile.
  const MeterProgress* const meter = find_progress(meters.back());
  const bool has_more = meter != nullptr && close_months_of(*meter);
  if (!has_more) meters.pop_back();
  if (meters.empty()) return;
  ports_.loop.post([weak = std::weak_ptr{self_}, meters = std::move(meters)]() mutable {
    if (const auto self = weak.lock()) (*self)->close_months_of(std::move(meters));
  });
}

bool Gateway::close_months_of(const MeterProgress& meter) {
  const Instant now = ports_.loop.now().instant();
  const StoredMeter stored = meter.stored;
  const auto closed = keeper_.close_due(
      {&stored, 1}, now,
      [&](const ClosedFigure& one) {
        MeterProgress& progress = *find_progress(stored.number);
        progress.closed_until =
            std::max(progress.closed_until, calendar_.month_span(one.figure.month).end);
        if (on_month_) on_month_(stored.meter, one.figure);
      },
      kMonthsAtATime);
  if (!closed) {
    note({now, Severity::error, "month_not_closed", stored.meter.id, closed.error().message});
  }
  return closed && closed->size() == kMonthsAtATime;
}

void Gateway::close_months_every_hour() {
  close_months();
  ports_.loop.after(kMonthsEvery, [weak = std::weak_ptr{self_}] {
    if (const auto self = weak.lock()) (*self)->close_months_every_hour();
  });
}

GatewayStatus Gateway::status() const {
  GatewayStatus status{.clock_ok = clock_ok_,
                       .store = committer_.health(),
                       .waiting_intervals = committer_.waiting_intervals(),
                       .events = events_};
  for (const auto& bus : buses_) {
    const BusRunner* const runner = bus->runner();
    if (runner == nullptr) continue;
    const BusCounters& counters = runner->counters();
    status.buses.push_back({bus->config().name, counters.duration, counters.lateness});
    for (std::size_t unit = 0; unit < bus->meters().size(); ++unit) {
      status.meters.push_back(status_of(*bus, unit, *runner));
    }
  }
  for (const PushedMeter& meter : pushed_) status.meters.push_back(status_of(meter));
  return status;
}

std::optional<MeterStatus> Gateway::meter_status(std::string_view id) const {
  for (const auto& bus : buses_) {
    const BusRunner* const runner = bus->runner();
    if (runner == nullptr) continue;
    const auto meters = std::span{bus->meters()};
    const auto found = std::ranges::find(meters, id, [](const LiveMeter& one) {
      return std::string_view{one.progress.stored.meter.id};
    });
    if (found != meters.end()) {
      return status_of(*bus, static_cast<std::size_t>(found - meters.begin()), *runner);
    }
  }
  const auto pushed = std::ranges::find(pushed_, id, [](const PushedMeter& one) {
    return std::string_view{one.progress.stored.meter.id};
  });
  if (pushed == pushed_.end()) return std::nullopt;
  return status_of(*pushed);
}

MeterStatus Gateway::status_of(const LiveBus& bus, std::size_t unit,
                               const BusRunner& runner) const {
  const LiveMeter& meter = bus.meters()[unit];
  return {.id = meter.progress.stored.meter.id,
          .poll = PollStatus{.bus = bus.config().name,
                             .state = runner.poller().state(unit),
                             .skipped = runner.poller().skipped(unit),
                             .requests = runner.counters().requests[unit],
                             .refused = meter.track.refused()},
          .live = meter.track.live(),
          .last_interval = meter.progress.last_interval,
          .counters = meter.progress.counters,
          .open_month_coverage = coverage_of(meter.progress)};
}

MeterStatus Gateway::status_of(const PushedMeter& meter) const {
  return {.id = meter.progress.stored.meter.id,
          .poll = std::nullopt,
          .live = {.power_kW = {}, .register_kWh = {}, .read_at = meter.heard_at},
          .last_interval = meter.progress.last_interval,
          .counters = meter.progress.counters,
          .open_month_coverage = coverage_of(meter.progress)};
}

double Gateway::coverage_of(const MeterProgress& progress) const {
  if (!clock_ok_) return kAbsent;
  return progress.open_month.coverage(ports_.loop.now().instant());
}

}  // namespace recald::daemon
