#include "daemon/gateway/feed/register_feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace recald::daemon {
namespace {

/// Why a meter without a state should have one; empty: it need not. Samples are stored together
/// with the state they led to, so if there are samples, the state was lost.
Result<std::string> lost_state(IntervalStore& store, std::uint32_t meter,
                               const std::string& field) {
  std::string lost;
  TRY(store.for_each_sample(meter, field, [&](const metering::RegisterSample&) {
    lost = "the state of its counter is no longer in the store";
  }));
  return lost;
}

Result<std::vector<modbus::PlannedRead>> planned_reads(const MeterConfig& config,
                                                       const modbus::RegisterMap& map) {
  const std::vector<modbus::RegisterField> fields = metered_fields(map);
  auto reads = plan_reads(fields, map.function, map.limits);
  if (reads) add_single_reads(*reads, fields);
  if (reads) return reads;
  return failure(reads.error().code,
                 fmt::format("meter '{}': {}", config.meter.id, reads.error().message));
}

/// Stored states of a meter's registers. Unreadable ones start anew, and `doubt` says why.
Result<std::vector<RegisterState>> stored_states(IntervalStore& store, std::uint32_t number,
                                                 std::string& doubt) {
  auto states = store.registers(number);
  if (states || states.error().code != ErrorCode::malformed) return states;
  doubt = states.error().message;
  return std::vector<RegisterState>{};
}

}  // namespace

Result<OpenedRegisters> open_meter_registers(const MeterConfig& config, const LiveMeterConfig& live,
                                             const metering::LocalCalendar& calendar,
                                             Store& store) {
  auto reads = TRY(planned_reads(config, live.map));
  std::vector<metering::Reading> recent;
  auto progress = TRY(MeterProgress::open(
      config.meter, calendar, store, [&](const metering::Reading& one) { recent.push_back(one); }));
  const std::uint32_t number = progress.stored.number;
  std::string doubt;
  const auto states = TRY(stored_states(store, number, doubt));

  TrackedMeter tracked{
      .number = number,
      .id = config.meter.id,
      .map = live.map,
      .multiplier = config.multiplier,
      .counter = config.counter.value_or(
          metering::CounterSettings{.rated_kW = config.meter.rated_kW.value_or(0.0),
                                    .runs_back = config.meter.negative_is_valid}),
      .booking = {.interval = config.meter.interval, .sample_gap_max = 2 * live.poll}};
  // A map that lost its counter leaves the counter's state behind in the store.
  const std::string field = live.map.energy.empty() ? "power" : "energy";
  const auto found = std::ranges::find(states, field, &RegisterState::field);
  const std::optional<RegisterState> state =
      found == states.end() ? std::nullopt : std::optional{*found};
  if (!state && doubt.empty() && progress.last_interval) {
    doubt = TRY(lost_state(store, number, field));
  }
  MeterTrack track{std::move(tracked), calendar, state};
  for (const metering::Reading& one : recent) track.remember(one);
  std::vector<MeterProgress> own;
  own.push_back(std::move(progress));
  return OpenedRegisters{.id = config.meter.id,
                         .progress = std::move(own),
                         .config = live,
                         .text = config.text,
                         .track = std::move(track),
                         .reads = std::move(reads),
                         .doubt = std::move(doubt)};
}

Result<OpenedRegisters> open_sensor_registers(const MeterConfig& config,
                                              const metering::LocalCalendar& calendar,
                                              Store& store) {
  const LiveMeterConfig& live = *config.live;
  auto reads = TRY(planned_reads(config, live.map));
  TrackedSensor tracked{
      .id = config.meter.id,
      .map = live.map,
      .averaging = {.interval = config.meter.interval, .sample_gap_max = 2 * live.poll},
      .quantities = {}};
  std::vector<MeterProgress> all;
  std::string doubt;
  for (WeatherChannel& channel : channels_of(config)) {
    auto progress = TRY(MeterProgress::open(stored_meter(config, channel), calendar, store));
    const std::uint32_t number = progress.stored.number;
    auto states = TRY(stored_states(store, number, doubt));
    tracked.quantities.push_back({number, channel.quantity, std::move(states)});
    progress.channel = std::move(channel);
    all.push_back(std::move(progress));
  }
  return OpenedRegisters{.id = config.meter.id,
                         .progress = std::move(all),
                         .config = live,
                         .text = config.text,
                         .track = WeatherTrack{std::move(tracked)},
                         .reads = std::move(reads),
                         .doubt = std::move(doubt)};
}

RegisterFeed::RegisterFeed(OpenedRegisters opened)
    : MeterFeed(std::move(opened.id), std::move(opened.progress)),
      config_(std::move(opened.config)),
      text_(std::move(opened.text)),
      track_(std::move(opened.track)),
      reads_(std::move(opened.reads)),
      doubt_(std::move(opened.doubt)) {}

MeterStatus RegisterFeed::status(metering::Instant /*now*/) const {
  MeterStatus status{.id = id(), .poll = {}, .live = {}, .last_interval = {}, .counters = {}};
  if (const auto* const sensor = std::get_if<WeatherTrack>(&track_)) {
    status.live.read_at = sensor->read_at();
  } else {
    status.live = meter().live();
  }
  return status;
}

bool RegisterFeed::makes(std::size_t read, const modbus::ReadRequest& request) const {
  if (read >= reads_.size()) return false;
  const modbus::PlannedRead& planned = reads_[read];
  return request ==
         modbus::ReadRequest{config_.unit, planned.function, planned.address, planned.count};
}

std::optional<metering::Instant> RegisterFeed::measured_at() const {
  if (is_sensor()) return std::nullopt;
  return meter().live().measured_at;
}

std::optional<double> RegisterFeed::now(std::uint32_t number) const {
  const auto* const sensor = std::get_if<WeatherTrack>(&track_);
  return sensor != nullptr ? sensor->now(number) : std::nullopt;
}

StoreBatch RegisterFeed::take(const PolledRead& read, metering::Instant at) {
  const modbus::PlannedRead& planned = reads_[read.order.read];
  if (auto* const sensor = std::get_if<WeatherTrack>(&track_)) {
    return sensor->take(planned, read.result, at);
  }
  return std::get<MeterTrack>(track_).take(planned, read.result, read.order.due, at);
}

StoreBatch RegisterFeed::take_kept(const metering::RegisterSample& sample) {
  return std::get<MeterTrack>(track_).take_kept(sample);
}

void RegisterFeed::clock_was_set() {
  std::visit([](auto& one) { one.clock_was_set(); }, track_);
}

std::vector<RefusedRegisters> RegisterFeed::refused() const {
  return std::visit([](const auto& one) { return one.refused(); }, track_);
}

}  // namespace recald::daemon
