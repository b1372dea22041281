#include "daemon/gateway/run/gateway.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/absent.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kHeldMax = 100'000;  // a day of sixty meters at one poll a minute
constexpr hours kMonthsEvery{1};
constexpr hours kRefusedReadingsEvery{1};
constexpr std::chrono::minutes kMetersEvery{1};
constexpr std::size_t kEventsTakenOver = 10'000;
constexpr std::size_t kSamplesAtATime = 500;  // taken over between two checks of the store
constexpr std::size_t kMonthsAtATime = 12;    // of one meter, in one step of the loop

/// While the store refuses, a day of all meters is kept, and no less than usual.
CommitRules rules_for(const SiteConfig& site) {
  CommitRules rules;
  std::size_t intervals_a_day = 0;
  const auto of_a_day = [](const MeterConfig& meter) {
    return static_cast<std::size_t>(hours{24} / meter.meter.interval);
  };
  for (const MeterConfig& meter : site.meters) {
    if (meter.is_stored()) intervals_a_day += of_a_day(meter);
  }
  for (const MeterConfig& sensor : site.sensors) {
    intervals_a_day += quantities_of(sensor).size() * of_a_day(sensor);
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
      committer_(
          ports_.loop, ports_.store, rules_for(site),
          [this](const StoreBatch& batch, const CommitCounts& counts) {
            note_committed(batch, counts);
          },
          [this](const std::string& why) { report_refusal(why); }),
      keeper_(ports_.store, calendar, site.closing, ports_.time_zone_release),
      clock_(ports.clock) {}

Gateway::~Gateway() = default;

Result<std::unique_ptr<Gateway>> Gateway::open(const SiteConfig& site,
                                               const metering::LocalCalendar& calendar,
                                               const GatewayPorts& ports, OnMonth on_month) {
  std::unique_ptr<Gateway> gateway{new Gateway{calendar, site, ports, std::move(on_month)}};
  gateway->buses_ = TRY(gateway->open_buses(site, {}));
  gateway->mqtt_ = TRY(gateway->open_mqtt(site));
  gateway->pushed_ = TRY(gateway->open_pushed(site));
  gateway->gather_feeds();
  gateway->watch_meters_of(site);
  gateway->watch_sensors_of(site);
  std::optional<Instant> newest;
  for (const MeterProgress* const progress : gateway->all_progress()) {
    if (progress->last_interval)
      newest = std::max(newest, std::optional{progress->last_interval->start});
  }
  gateway->clock_ = ClockWatch{ports.clock, newest};
  return gateway;
}

Result<std::vector<std::unique_ptr<LiveBus>>> Gateway::open_buses(
    const SiteConfig& site, std::span<const std::unique_ptr<LiveBus>> kept) {
  std::vector<std::unique_ptr<LiveBus>> opened;
  for (const BusConfig& bus : site.buses) {
    const bool is_kept = std::ranges::any_of(
        kept, [&](const auto& known) { return known && known->config().name == bus.name; });
    if (is_kept) continue;
    auto live = TRY(LiveBus::open(site, bus, calendar_, ports_.store));
    opened.push_back(std::move(live));
  }
  return opened;
}

Result<std::vector<std::unique_ptr<MqttFeed>>> Gateway::open_mqtt(const SiteConfig& site) {
  std::vector<std::unique_ptr<MqttFeed>> opened;
  for (const MeterConfig& config : site.meters) {
    if (!config.mqtt) continue;
    opened.push_back(TRY(MqttFeed::open(config, calendar_, ports_.store)));
  }
  return opened;
}

Result<std::vector<std::unique_ptr<PushedFeed>>> Gateway::open_pushed(const SiteConfig& site) {
  std::vector<std::unique_ptr<PushedFeed>> opened;
  for (const auto* const list : {&site.meters, &site.sensors}) {
    for (const MeterConfig& config : *list) {
      if (config.source != MeterSource::http || config.mqtt) continue;
      opened.push_back(TRY(PushedFeed::open(config, calendar_, ports_.store)));
      opened.back()->go_on_from(pushed_);
    }
  }
  return opened;
}

void Gateway::gather_feeds() {
  feeds_.clear();
  for (const auto& bus : buses_) {
    for (const auto& feed : bus->feeds()) feeds_.push_back(feed.get());
  }
  for (const auto& feed : mqtt_) feeds_.push_back(feed.get());
  for (const auto& feed : pushed_) feeds_.push_back(feed.get());
}

void Gateway::watch_meters_of(const SiteConfig& site) {
  // What an earlier process reported; a store that cannot be read says so itself.
  const auto silent = ports_.store.silent_meters();
  std::map<std::string, MeterWatch> watches;
  for (const MeterConfig& config : site.meters) {
    if (!config.is_stored()) continue;
    const std::string& id = config.meter.id;
    const auto silence_max =
        meter_silence_max(config.meter.interval, config.source != MeterSource::http);
    const auto known = meter_watches_.find(id);
    if (known != meter_watches_.end() && known->second.silence_max() == silence_max) {
      watches.emplace(id, known->second);
      continue;
    }
    const auto pushed = std::ranges::find(pushed_, id, [](const auto& one) { return one->id(); });
    const auto known_until =
        pushed == pushed_.end() ? std::nullopt : (*pushed)->progress().front().known_until();
    watches.emplace(id, MeterWatch{id, silence_max, known_until, silent && silent->contains(id)});
  }
  meter_watches_ = std::move(watches);
}

void Gateway::watch_sensors_of(const SiteConfig& site) {
  std::map<std::string, SensorWatch> watches;
  for (const MeterConfig& sensor : site.sensors) {
    const std::string& id = sensor.meter.id;
    const auto known = watches_.find(id);
    const bool is_polled = sensor.live.has_value();
    const bool goes_on = known != watches_.end() && known->second.is_polled() == is_polled;
    watches.emplace(id, goes_on ? known->second : SensorWatch{id, is_polled});
  }
  watches_ = std::move(watches);
}

Result<void> Gateway::take_over(Store& memory, const std::function<void()>& on_progress) {
  // Half a takeover could not be completed later: a counter does not accept older samples.
  return ports_.store.as_one([&] { return take_over_all(memory, on_progress); });
}

Result<void> Gateway::take_over_all(Store& memory, const std::function<void()>& on_progress) {
  std::vector<StoreEvent> events;
  TRY(memory.for_each_event(Instant::max(), [&](const StoreEvent& event) {
    events.push_back(event);
    return events.size() < kEventsTakenOver;
  }));
  std::ranges::reverse(events);
  committer_.add({.events = std::move(events)});
  for (MeterProgress* const progress : all_progress()) {
    if (on_progress) on_progress();
    const auto number = TRY(memory.find_meter(progress->stored.meter.id));
    if (!number) continue;
    std::vector<metering::RegisterSample> samples;
    const auto read = memory.for_each_sample(
        *number, "energy",
        [&](const metering::RegisterSample& sample) { samples.push_back(sample); });
    if (!read) return read;
    MeterFeed& feed = *find_feed(progress->stored.number);
    // One that a reload has made a pushed meter meanwhile has its intervals.
    const auto taken = feed.has_counter() && !samples.empty()
                           ? take_over_samples(feed, samples)
                           : take_over_intervals(*progress, memory, *number);
    if (!taken) return taken;
  }
  return committer_.flush();
}

Result<void> Gateway::take_over_samples(MeterFeed& feed,
                                        std::span<const metering::RegisterSample> samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    StoreBatch batch = feed.take_kept(samples[i]);
    feed.progress().front().mark_late(batch, calendar_);
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
  const Moment now = ports_.loop.now();
  watch_clock(now);
  tell(now, recording::Start{});
  for (const auto& bus : buses_) start(*bus, now.instant());
  for (const auto& feed : mqtt_) note_doubt(*feed, now.instant());
  close_months(now);
  evaluate_meters(now);
  if (!ports_.make_bus) return;
  tick_again(recording::Tick::hour, kMonthsEvery);
  tick_again(recording::Tick::minute, kMetersEvery);
}

void Gateway::tick_again(recording::Tick which, milliseconds every) {
  ports_.loop.after(every, alive_.guard([this, which, every] {
    tick(which);
    tick_again(which, every);
  }));
}

void Gateway::tick(recording::Tick which) {
  const Moment now = ports_.loop.now();
  watch_clock(now);
  tell(now, which);
  if (which == recording::Tick::minute) return evaluate_meters(now);
  // Not at the start: sensors that seem silent have not been asked yet.
  evaluate_sensors(now.instant());
  close_months(now);
}

void Gateway::tell(const Moment& at, recording::What what) {
  if (ports_.recorder != nullptr) ports_.recorder->entered({at, clock_.doubt(), std::move(what)});
}

void Gateway::tell_read(const MeterFeed& feed, const PolledRead& read) {
  tell(read.at, recording::Read{.meter = feed.id(),
                                .read = read.order.read,
                                .request = read.order.request,
                                .due = read.order.due,
                                .is_probe = read.order.is_probe,
                                .result = read.result,
                                .duration = read.duration});
}

void Gateway::post_step(std::function<void(const Moment&)> step) {
  ports_.loop.post(alive_.guard([this, step = std::move(step)] {
    const Moment now = ports_.loop.now();
    watch_clock(now);
    tell(now, recording::Tick::step);
    step(now);
  }));
}

std::vector<StoredMeter> Gateway::meters() const {
  std::vector<StoredMeter> all;
  for (const MeterFeed* const feed : feeds_) {
    for (const MeterProgress& progress : feed->progress()) all.push_back(progress.stored);
  }
  return all;
}

void Gateway::start(LiveBus& bus, Instant now) {
  if (ports_.make_bus) {
    bus.start(ports_of(bus), [this](MeterFeed& feed, const PolledRead& read) { take(feed, read); });
  }
  for (const auto& feed : bus.feeds()) note_doubt(*feed, now);
}

void Gateway::note_doubt(MeterFeed& feed, Instant now) {
  const std::string doubt = feed.take_doubt();
  if (doubt.empty()) return;
  note({now, Severity::error, "counter_state_lost", feed.id(),
        fmt::format("meter '{}': {}; its counter starts again from here, and the energy since "
                    "the last interval is unknown",
                    feed.id(), doubt)});
}

LiveBus::Ports Gateway::ports_of(const LiveBus& bus) const {
  return {ports_.loop, ports_.make_bus, ports_.seed + std::hash<std::string>{}(bus.config().name)};
}

/// Each in its own step of the loop, because ending a bus waits for the read in progress.
void Gateway::begin_buses_anew() {
  for (const auto& bus : buses_) {
    ports_.loop.after(milliseconds{0}, alive_.guard([this, name = bus->config().name] {
      for (const auto& live : buses_) {
        if (live->config().name == name) live->begin_anew(ports_of(*live));
      }
    }));
  }
}

Result<void> Gateway::reload(const SiteConfig& site) {
  // Counters continue from the stored state, so everything must be stored.
  if (auto flushed = committer_.flush(); !flushed) return flushed;
  const Moment now = ports_.loop.now();
  const auto changed = std::stable_partition(
      buses_.begin(), buses_.end(), [&](const auto& bus) { return bus->is_described_by(site); });
  const std::span kept{buses_.begin(), changed};
  auto opened = TRY(open_buses(site, kept));
  auto mqtt = TRY(open_mqtt(site));
  auto pushed = TRY(open_pushed(site));
  if (ports_.recorder != nullptr) ports_.recorder->reloaded({now, clock_.doubt(), {}}, site);
  feeds_.clear();
  mqtt_ = std::move(mqtt);
  pushed_ = std::move(pushed);
  buses_.erase(changed, buses_.end());  // a serial line has one owner: the old one ends first
  gather_feeds();
  for (const auto& feed : mqtt_) note_doubt(*feed, now.instant());
  begin_buses_anew();  // those that are kept
  // Held reads were planned with the old descriptions, which may have changed.
  std::erase_if(held_, [&](const HeldRead& held) { return find_feed(held.meter) == nullptr; });
  for (auto& bus : opened) {
    buses_.push_back(std::move(bus));
    gather_feeds();
    start(*buses_.back(), now.instant());
  }
  watch_meters_of(site);
  watch_sensors_of(site);
  keeper_.set_options(site.closing);
  // Changed rules close months again, but only after the reload has ended.
  post_step([this](const Moment& at) { close_months(at); });
  return {};
}

MeterFeed* Gateway::find_feed(std::uint32_t number) {
  const auto is_it = [&](const MeterProgress& one) { return one.stored.number == number; };
  const auto feed = std::ranges::find_if(
      feeds_, [&](MeterFeed* one) { return std::ranges::any_of(one->progress(), is_it); });
  return feed == feeds_.end() ? nullptr : *feed;
}

std::vector<MeterProgress*> Gateway::all_progress() {
  std::vector<MeterProgress*> all;
  for (MeterFeed* const feed : feeds_) {
    for (MeterProgress& progress : feed->progress()) all.push_back(&progress);
  }
  return all;
}

MeterProgress* Gateway::find_progress(std::uint32_t number) {
  for (MeterFeed* const feed : feeds_) {
    for (MeterProgress& progress : feed->progress()) {
      if (progress.stored.number == number) return &progress;
    }
  }
  return nullptr;
}

/// Stamps are good from the first believed time on, until the clock is set again.
void Gateway::watch_clock(const Moment& now) {
  const bool was_believed = clock_.is_believed();
  const milliseconds moved = clock_.look(now);
  if (!was_believed) {
    if (clock_.is_believed()) release_held(now);
    return;
  }
  if (moved == milliseconds{0}) return;
  for (MeterFeed* const feed : feeds_) feed->clock_was_set();
  for (auto& [meter, watch] : meter_watches_) watch.clock_was_set();
  const std::string how =
      fmt::format("the system clock was set {} by {} s",
                  moved > milliseconds{0} ? "forward" : "back", std::abs(moved.count()) / 1000);
  if (clock_.is_believed()) {
    note({now.instant(), Severity::warning, "clock_set", "",
          how + "; the skipped time is missing from all meters"});
  } else {
    note({std::chrono::floor<seconds>(now.wall - moved), Severity::error, "clock_set", "",
          fmt::format("{}: {}; readings are held until it is set", how, clock_.doubt())});
  }
}

/// Stamps the reads from before the clock was right by their age.
void Gateway::release_held(const Moment& now) {
  for (const HeldRead& held : std::exchange(held_, {})) {
    const auto wall = now.wall - (now.monotonic - held.read.at.monotonic);
    MeterFeed* const feed = find_feed(held.meter);
    if (feed != nullptr) take_at(*feed, held.read, std::chrono::floor<seconds>(wall));
  }
}

void Gateway::submit(StoreBatch batch) {
  if (ports_.on_event) std::ranges::for_each(batch.events, ports_.on_event);
  committer_.add(std::move(batch));
}

void Gateway::take(MeterFeed& feed, const PolledRead& read) {
  watch_clock(read.at);
  if (ports_.recorder != nullptr) tell_read(feed, read);
  take_or_hold(feed, read);
}

void Gateway::take_or_hold(MeterFeed& feed, const PolledRead& read) {
  if (clock_.is_believed()) {
    take_at(feed, read, read.at.instant());
    return;
  }
  if (held_.size() >= kHeldMax) held_.pop_front();
  held_.push_back({feed.progress().front().stored.number, read});
}

void Gateway::take_at(MeterFeed& feed, const PolledRead& read, Instant at) {
  StoreBatch batch = feed.take(read, at);
  feed.progress().front().mark_late(batch, calendar_);
  submit(std::move(batch));
}

Result<bool> Gateway::accept_mqtt(const MeterValue& value) {
  const auto feed =
      std::ranges::find(mqtt_, value.meter, [](const auto& one) { return one->id(); });
  const Moment now = ports_.loop.now();
  const auto read = feed == mqtt_.end() ? std::nullopt : (*feed)->read_of(value, now);
  if (!read) {
    return failure(ErrorCode::not_found, fmt::format("meter '{}' has no such value", value.meter));
  }
  watch_clock(now);
  tell(now, recording::Value{value});
  if (!value.measured) {
    take_or_hold(**feed, *read);
    return true;
  }
  if ((*feed)->is_late(value, *value.measured)) return false;
  take_at(**feed, *read, *value.measured);
  return true;
}

Result<void> Gateway::take_read(const recording::Read& read) {
  for (const auto& bus : buses_) {
    for (const auto& feed : bus->feeds()) {
      if (feed->id() != read.meter) continue;
      if (!feed->makes(read.read, read.request)) break;
      take(*feed, {.order = {.unit = 0,
                             .read = read.read,
                             .request = read.request,
                             .timeout = {},
                             .due = read.due,
                             .is_probe = read.is_probe},
                   .result = read.result,
                   .lateness = {},
                   .duration = read.duration,
                   .at = ports_.loop.now()});
      return {};
    }
  }
  return failure(ErrorCode::unsupported,
                 fmt::format("meter '{}': the recording has {} registers from {} on (function {}) "
                             "of unit {}, which this recald does not read",
                             read.meter, read.request.count, read.request.address,
                             static_cast<int>(read.request.function), read.request.unit));
}

Result<CommitCounts> Gateway::take_pushed(const std::string& meter,
                                          std::vector<metering::Reading> readings,
                                          const std::optional<Correction>& correction) {
  const auto feed =
      std::ranges::find_if(pushed_, [&](const auto& one) { return one->find(meter) != nullptr; });
  if (feed == pushed_.end()) {
    return failure(ErrorCode::not_found,
                   "this daemon does not accept readings of a meter '" + meter + "'");
  }
  const Moment at = ports_.loop.now();
  watch_clock(at);
  if (ports_.recorder != nullptr) tell(at, recording::Push{meter, readings, correction});
  const MeterProgress& progress = *(*feed)->find(meter);
  RisingWatch::Doubt doubt;
  if (!correction) doubt = (*feed)->doubt_rising(progress, readings);
  StoreBatch batch;
  for (metering::Reading& reading : readings) {
    reading.meter = progress.stored.number;
    batch.intervals.push_back({.reading = reading, .supersedes = correction.has_value()});
  }
  for (metering::Reading& before : doubt.before) {
    before.meter = progress.stored.number;
    batch.intervals.push_back({.reading = before, .supersedes = true});
  }
  progress.mark_late(batch, calendar_);
  const Instant now = at.instant();
  auto counts = commit_pushed(batch, correction, now);
  if (!counts) {
    if (counts.error().code == ErrorCode::io_failed) report_refusal(counts.error().message);
    return counts;
  }
  if (!committer_.health().is_degraded) report_refusal("");
  (*feed)->note_heard(progress, now, counts->taken > 0);
  note_committed(batch, *counts);
  report_pushed(meter, *counts, correction, now);
  counts->doubt = std::move(doubt.words);
  if (!counts->doubt.empty() && !doubt.is_weak) {
    note({.time = now,
          .severity = Severity::warning,
          .kind = "readings_rise",
          .subject = meter,
          .text = fmt::format("meter '{}': {}", meter, counts->doubt),
          .is_counted = true});
  }
  return counts;
}

Result<CommitCounts> Gateway::take_samples(const std::string& meter,
                                           std::vector<metering::RegisterSample> samples) {
  std::ranges::stable_sort(samples, {}, &metering::RegisterSample::time);
  CommitCounts counts;
  for (const metering::RegisterSample& sample : samples) {
    const bool is_new = TRY(accept_mqtt(
        {.meter = meter, .is_counter = true, .value = sample.value_kWh, .measured = sample.time}));
    ++(is_new ? counts.taken : counts.duplicates);
  }
  TRY(committer_.flush());
  return counts;
}

Result<CommitCounts> Gateway::commit_pushed(StoreBatch& batch,
                                            const std::optional<Correction>& correction,
                                            Instant now) {
  if (!correction) return ports_.store.commit(batch);
  CommitCounts counts;
  TRY(ports_.store.as_one([&]() -> Result<void> {
    const auto edit = TRY(ports_.store.add_edit({.time = now,
                                                 .author = correction->author,
                                                 .reason = correction->reason,
                                                 .file = "POST /api/v1/readings",
                                                 .sha256 = correction->sha256}));
    batch.edit = edit;
    counts = TRY(ports_.store.commit(batch));
    return counts.taken > 0 ? Result<void>{} : ports_.store.remove_edit(edit);
  }));
  return counts;
}

void Gateway::report_pushed(const std::string& meter, const CommitCounts& counts,
                            const std::optional<Correction>& correction, Instant now) {
  if (!counts.conflicts.empty()) {
    note({.time = now,
          .severity = Severity::warning,
          .kind = "reading_conflict",
          .subject = meter,
          .text = fmt::format("{} readings were sent again with a different value, the first of "
                              "{}; the stored values stay",
                              counts.conflicts.size(),
                              metering::to_string(counts.conflicts.front().start)),
          .is_counted = true});
  }
  if (correction && counts.taken > 0) {
    note({now, Severity::info, "readings_corrected", meter,
          fmt::format("{} readings were corrected by {}: {}", counts.taken, correction->author,
                      correction->reason)});
  }
}

/// A disk that refuses every other commit is reported once an hour.
void Gateway::report_refusal(const std::string& why) {
  const Moment now = ports_.loop.now();
  if (!why.empty()) {
    const auto known = refusal_reported_at_;
    if (known && now.monotonic - *known < kRefusedReadingsEvery) return;
    refusal_reported_at_ = now.monotonic;
    is_refusal_reported_ = true;
    note({now.instant(), Severity::error, "store_refuses", "",
          fmt::format("the store accepts no data ({}); recald keeps a day of readings in memory "
                      "and tries again",
                      why)});
  } else if (std::exchange(is_refusal_reported_, false)) {
    note({now.instant(), Severity::info, "store_accepts", "",
          "the store accepts data again; the readings kept in memory are stored"});
  }
}

void Gateway::note_committed(const StoreBatch& batch, const CommitCounts& counts) {
  for (std::size_t i = 0; i < batch.intervals.size(); ++i) {
    if (!counts.was_taken[i]) continue;
    const metering::Reading& reading = batch.intervals[i].reading;
    MeterProgress* const progress = find_progress(reading.meter);
    if (progress == nullptr) continue;
    progress->note(reading);
    if (ports_.recorder != nullptr) ports_.recorder->stored(progress->stored.meter.id, reading);
  }
  for (const StoreEvent& event : batch.events) count_stored(event);
}

void Gateway::count_stored(const StoreEvent& event) {
  ++events_[static_cast<std::size_t>(event.severity)];
  for (MeterProgress* const progress : all_progress()) {
    const bool is_of_it = progress->channel ? progress->channel->sensor == event.subject
                                            : progress->stored.meter.id == event.subject;
    if (!is_of_it) continue;
    ++progress->counters.events[event.kind];
    break;  // one quantity stands for its sensor
  }
}

void Gateway::close_months(const Moment& at) {
  if (!clock_.is_believed()) return;
  // Months are closed from the store, so waiting readings must be committed first.
  if (!committer_.flush()) return;
  std::vector<std::uint32_t> meters;
  for (const MeterProgress* const progress : all_progress()) {
    if (!progress->channel) meters.push_back(progress->stored.number);
  }
  std::ranges::reverse(meters);
  close_months_of(std::move(meters), at.instant());
}

/// Closes some months of the last meter in the list; the others follow after whatever else waits
/// for the loop, because a thousand months take seconds.
void Gateway::close_months_of(std::vector<std::uint32_t> meters, Instant now) {
  if (meters.empty() || !clock_.is_believed()) return;
  // A reload may have removed it meanwhile.
  const MeterProgress* const meter = find_progress(meters.back());
  const bool has_more = meter != nullptr && close_months_of(*meter, now);
  if (!has_more) meters.pop_back();
  if (meters.empty()) return;
  post_step([this, meters = std::move(meters)](const Moment& at) {
    close_months_of(meters, at.instant());
  });
}

bool Gateway::close_months_of(const MeterProgress& meter, Instant now) {
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

void Gateway::evaluate_meters(const Moment& at) {
  const CommitHealth& store = committer_.health();
  if (store.is_degraded && !is_refusal_reported_) report_refusal(store.why);
  if (!clock_.is_believed()) return;
  const Instant now = at.instant();
  for (const MeterFeed* const feed : feeds_) {
    const auto watch = meter_watches_.find(feed->id());
    if (feed->is_sensor() || watch == meter_watches_.end()) continue;
    if (auto event = watch->second.evaluate(feed->measured_at(), now)) note(std::move(*event));
  }
}

void Gateway::evaluate_sensors(Instant now) {
  if (!clock_.is_believed()) return;
  for (auto& [sensor, watch] : watches_) {
    std::vector<const MeterProgress*> channels;
    for (const MeterProgress* const progress : all_progress()) {
      if (progress->channel && progress->channel->sensor == sensor) channels.push_back(progress);
    }
    submit({.events = watch.evaluate(channels, now)});
  }
}

GatewayStatus Gateway::status() const {
  GatewayStatus status{.clock_ok = clock_.is_believed(),
                       .clock_doubt = clock_.doubt(),
                       .store = committer_.health(),
                       .waiting_intervals = committer_.waiting_intervals(),
                       .events = events_};
  for (const auto& bus : buses_) {
    const BusRunner* const runner = bus->runner();
    if (runner == nullptr) continue;
    const BusCounters& counters = runner->counters();
    status.buses.push_back({bus->config().name, counters.duration, counters.lateness});
  }
  for (const MeterFeed* const feed : feeds_) status.meters.push_back(status_of(*feed));
  return status;
}

std::optional<MeterStatus> Gateway::meter_status(std::string_view id) const {
  const auto feed = std::ranges::find(
      feeds_, id, [](const MeterFeed* one) { return std::string_view{one->id()}; });
  return feed == feeds_.end() ? std::nullopt : std::optional{status_of(**feed)};
}

MeterStatus Gateway::status_of(const MeterFeed& feed) const {
  MeterStatus status = feed.status(ports_.loop.now().instant());
  if (feed.is_sensor()) {
    status.open_month_coverage = kAbsent;
    for (const MeterProgress& progress : feed.progress()) {
      add_quantity(status, progress, feed.now(progress.stored.number));
    }
    return status;
  }
  const MeterProgress& progress = feed.progress().front();
  status.last_interval = progress.last_interval;
  status.counters = progress.counters;
  status.open_month_coverage = coverage_of(progress);
  return status;
}

void Gateway::add_quantity(MeterStatus& status, const MeterProgress& progress,
                           std::optional<double> now) const {
  ChannelState state;
  if (const auto watch = watches_.find(progress.channel->sensor);
      clock_.is_believed() && watch != watches_.end()) {
    state = watch->second.state_of(progress, ports_.loop.now().instant());
  }
  // Leaves out quantities that a sensor never sent, unless they are missed.
  if (!status.poll && !progress.known_until() && !state.silent_since) return;
  const double coverage = coverage_of(progress);
  status.open_month_coverage = std::fmin(status.open_month_coverage, coverage);
  for (std::size_t i = 0; i < status.counters.intervals.size(); ++i) {
    status.counters.intervals[i] += progress.counters.intervals[i];
  }
  for (const auto& [kind, count] : progress.counters.events) status.counters.events[kind] += count;
  status.weather.push_back({.quantity = progress.channel->quantity,
                            .now = now,
                            .last_interval = progress.last_interval,
                            .known_until = progress.known_until(),
                            .open_month_coverage = coverage,
                            .state = state});
}

double Gateway::coverage_of(const MeterProgress& progress) const {
  if (!clock_.is_believed()) return kAbsent;
  return progress.open_month.coverage(ports_.loop.now().instant());
}

}  // namespace recald::daemon
