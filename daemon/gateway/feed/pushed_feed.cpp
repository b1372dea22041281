#include "daemon/gateway/feed/pushed_feed.hpp"

#include <algorithm>
#include <utility>

namespace recald::daemon {

Result<std::unique_ptr<PushedFeed>> PushedFeed::open(const MeterConfig& config,
                                                     const metering::LocalCalendar& calendar,
                                                     Store& store) {
  std::vector<MeterProgress> all;
  if (config.role != MeterRole::weather) {
    all.push_back(TRY(MeterProgress::open(config.meter, calendar, store)));
  } else {
    for (WeatherChannel& channel : channels_of(config)) {
      all.push_back(TRY(MeterProgress::open(stored_meter(config, channel), calendar, store)));
      all.back().channel = std::move(channel);
    }
  }
  return std::unique_ptr<PushedFeed>{new PushedFeed{config.meter.id, std::move(all)}};
}

void PushedFeed::go_on_from(std::span<const std::unique_ptr<PushedFeed>> before) {
  for (std::size_t i = 0; i < heard_.size(); ++i) {
    MeterProgress& own = progress()[i];
    for (const auto& one : before) {
      const MeterProgress* const known = one->find(own.stored.meter.id);
      if (known == nullptr) continue;
      own.counters = known->counters;
      rising_ = one->rising_;
      heard_[i] = one->heard_[static_cast<std::size_t>(known - one->progress().data())];
    }
  }
}

MeterProgress* PushedFeed::find(std::string_view stored_id) {
  const auto found = std::ranges::find_if(
      progress(), [&](const MeterProgress& one) { return one.stored.meter.id == stored_id; });
  return found == progress().end() ? nullptr : &*found;
}

RisingWatch::Doubt PushedFeed::doubt_rising(const MeterProgress& of,
                                            std::vector<metering::Reading>& readings) {
  const metering::Meter& meter = of.stored.meter;
  if (is_sensor() || meter.rated_kW) return {};
  return rising_.look(readings, meter.interval);
}

void PushedFeed::note_heard(const MeterProgress& of, metering::Instant at, bool has_new) {
  Heard& heard = heard_[static_cast<std::size_t>(&of - progress().data())];
  heard.at = at;
  if (has_new) heard.new_at = at;
}

MeterStatus PushedFeed::status(metering::Instant /*now*/) const {
  MeterStatus status{.id = id(), .poll = {}, .live = {}, .last_interval = {}, .counters = {}};
  for (const Heard& heard : heard_) {
    status.live.read_at = std::max(status.live.read_at, heard.at);
  }
  return status;
}

}  // namespace recald::daemon
