#include "daemon/gateway/ingest/sensor_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace recald::daemon {

using metering::Instant;

std::string silence_words(std::string_view sensor, std::string_view quantity, Instant since) {
  return fmt::format("weather sensor '{}' has sent no {} since {}", sensor, quantity,
                     metering::to_string(since));
}

std::string frozen_words(std::string_view sensor, std::string_view quantity, Instant since) {
  return fmt::format("weather sensor '{}' has reported the same {} since {}", sensor, quantity,
                     metering::to_string(since));
}

ChannelState SensorWatch::state_of(const MeterProgress& channel, Instant now) const {
  ChannelState state;
  const auto known_until = channel.known_until();
  const bool is_missed = is_polled_ || known_until || is_dry_bulb(*channel.channel->quantity);
  const Instant since = known_until.value_or(begun_.value_or(now));
  if (is_missed && now - since > (is_polled_ ? kPolledSilenceMax : kPushedSilenceMax)) {
    state.silent_since = since;
  } else if (is_dry_bulb(*channel.channel->quantity) && channel.same_value &&
             weather::is_frozen(channel.same_value->length(), channel.stored.meter.interval)) {
    state.frozen_since = channel.same_value->begin;
  }
  return state;
}

StoreEvent SensorWatch::event(Severity severity, std::string_view kind, std::string text,
                              Instant now) const {
  return {.time = now,
          .severity = severity,
          .kind = std::string{kind},
          .subject = sensor_,
          .text = std::move(text),
          .is_counted = is_first_};  // a restart reports it again
}

std::vector<StoreEvent> SensorWatch::evaluate(std::span<const MeterProgress* const> channels,
                                              Instant now) {
  is_first_ = !begun_;
  if (!begun_) begun_ = now;
  std::vector<std::string_view> silent;
  std::vector<std::string_view> back;
  Instant silent_since = now;
  std::vector<StoreEvent> events;
  for (const MeterProgress* const channel : channels) {
    const ChannelState state = state_of(*channel, now);
    const std::string_view name = channel->channel->quantity->name;
    if (state.silent_since && silent_.insert(name).second) {
      silent.push_back(name);
      silent_since = std::min(silent_since, *state.silent_since);
    }
    if (!state.silent_since && silent_.erase(name) > 0) back.push_back(name);
    if (state.frozen_since && frozen_.insert(name).second) {
      events.push_back(event(
          Severity::warning, "weather_frozen",
          frozen_words(sensor_, name, *state.frozen_since) + "; it is not used until it changes",
          now));
    }
    if (!state.frozen_since) frozen_.erase(name);
  }
  if (!silent.empty()) {
    events.push_back(event(
        Severity::warning, "weather_silent",
        silence_words(sensor_, fmt::format("{}", fmt::join(silent, ", ")), silent_since) +
            "; months of meters close regardless, and a calibration says which weather is missing",
        now));
  }
  if (!back.empty()) {
    events.push_back(event(
        Severity::info, "weather_answers",
        fmt::format("weather sensor '{}' sends {} again", sensor_, fmt::join(back, ", ")), now));
  }
  return events;
}

}  // namespace recald::daemon
