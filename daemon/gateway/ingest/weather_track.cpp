#include "daemon/gateway/ingest/weather_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/absent.hpp"
#include "daemon/gateway/ingest/read_reasons.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::PowerBook;
using metering::Reading;
using metering::Reason;

/// The open intervals are stored this often, so a restart loses no more of them.
constexpr std::chrono::seconds kKeepWeatherEvery{60};
/// A synchronised clock never steps back further.
constexpr std::chrono::seconds kSensorClockSlew{2};
/// A longer hole leaves no intervals: an event reports it, and a month of silence must not become
/// thousands of rows in one commit.
constexpr std::chrono::hours kWeatherHoleMax{24};
constexpr std::chrono::hours kImplausibleReportEvery{1};
constexpr double kRadianPerDegree = std::numbers::pi / 180.0;
constexpr double kNoDirection = 1e-9;  // winds that cancel

/// Names of a quantity's books in the store: one for a mean, two for the components of a direction.
using BookFields = std::array<std::string_view, 2>;
constexpr BookFields kMeanFields{"mean", ""};
constexpr BookFields kDirectionFields{"east", "north"};

const BookFields& book_fields(const weather::SensorQuantity& quantity) {
  return weather::is_wind_direction(quantity) ? kDirectionFields : kMeanFields;
}

/// Combines the readings of both components of a direction in one interval into degrees.
Reading direction_of(const Reading& east, const Reading& north) {
  Reading reading = east;
  if (reading.validity != metering::Validity::ok) return reading;
  const double deg = std::atan2(east.mean_kW, north.mean_kW) / kRadianPerDegree;
  if (std::hypot(east.mean_kW, north.mean_kW) < kNoDirection) {
    reading.mean_kW = kAbsent;
    reading.validity = metering::Validity::missing;
  } else {
    reading.mean_kW = deg < 0.0 ? deg + 360.0 : deg;
  }
  return reading;
}

}  // namespace

WeatherTrack::WeatherTrack(TrackedSensor sensor)
    : id_(std::move(sensor.id)),
      fields_(metered_fields(sensor.map)),
      averaging_(sensor.averaging),
      refusals_(id_) {
  for (const TrackedQuantity& tracked : sensor.quantities) {
    Channel channel{.number = tracked.number, .quantity = tracked.quantity};
    const BookFields& names = book_fields(*tracked.quantity);
    for (const RegisterState& state : tracked.restored) {
      const auto name = std::ranges::find(names, std::string_view{state.field});
      if (name == names.end()) continue;
      channel.books.at(static_cast<std::size_t>(name - names.begin())) = state.power;
    }
    // Both components of a direction must match; a damaged store may return them out of step.
    const auto& [east, north] = channel.books;
    if (weather::is_wind_direction(*tracked.quantity) &&
        (east.next != north.next || east.until != north.until)) {
      channel.books = {};
    }
    channels_.push_back(std::move(channel));
  }
}

void WeatherTrack::clock_was_set() {
  for (Channel& channel : channels_) {
    for (PowerBook& book : channel.books) metering::forget_power(book);
    channel.since |= Reason::clock;
  }
}

std::optional<double> WeatherTrack::now(std::uint32_t number) const {
  const auto channel = std::ranges::find(channels_, number, &Channel::number);
  return channel == channels_.end() ? std::nullopt : channel->now;
}

WeatherTrack::Channel* WeatherTrack::channel_of(const std::string& field) {
  const auto channel = std::ranges::find_if(
      channels_, [&](const Channel& one) { return one.quantity->name == field; });
  return channel == channels_.end() ? nullptr : &*channel;
}

StoreBatch WeatherTrack::take(const modbus::PlannedRead& read, const modbus::ReadResult& result,
                              Instant at) {
  StoreBatch batch;
  if (auto event = refusals_.take(read, result, at)) batch.events.push_back(std::move(*event));
  if (!result) {
    for (const std::size_t i : read.fields) {
      Channel* const channel = channel_of(fields_[i].name);
      if (channel == nullptr) continue;
      channel->now.reset();
      channel->since |= reason_of(result.error());
    }
    return batch;
  }
  read_at_ = at;
  for (const modbus::FieldValue& found : decode_read(fields_, read, *result)) {
    Channel* const channel = channel_of(fields_[found.field].name);
    if (channel == nullptr) continue;  // an identity, or a power of ten
    channel->now.reset();
    if (found.value) {
      take_value(batch, *channel, found.value->value, at);
    } else {
      channel->since |= reason_of(found.value.error());
    }
  }
  // Commit intervals together with the state that they were computed from.
  if (!batch.intervals.empty() || at - kept_ >= kKeepWeatherEvery) {
    put_states(batch);
    kept_ = at;
  }
  return batch;
}

void WeatherTrack::take_value(StoreBatch& batch, Channel& channel, double value, Instant at) {
  if (!weather::is_plausible(*channel.quantity, value)) {
    channel.since |= Reason::range;
    return notify(batch, channel, value, at);
  }
  channel.now = value;
  book(batch, channel, value, at);
}

/// Per sensor, this is at most one event a day, counted at most once an hour.
void WeatherTrack::notify(StoreBatch& batch, Channel& channel, double value, Instant at) const {
  if (channel.reported != Instant::min() && at - channel.reported < kImplausibleReportEvery) return;
  channel.reported = at;
  batch.events.push_back(
      {.time = at,
       .severity = Severity::warning,
       .kind = "weather_not_plausible",
       .subject = id_,
       .text = fmt::format("weather sensor '{}': {}; it counts as no value. Check the sensor, and "
                           "scale and address in its register map",
                           id_, weather::why_not_plausible(*channel.quantity, value)),
       .is_counted = true});
}

void WeatherTrack::book(StoreBatch& batch, Channel& channel, double value, Instant at) const {
  PowerBook& first = channel.books.front();
  const bool went_back = first.next && at < first.until - kSensorClockSlew;
  if (went_back && at < *first.next) {
    // Readings stamped later than now have wrong stamps and will be replaced.
    channel.since |= Reason::clock;
    channel.relived_until = std::max(channel.relived_until, *first.next);
    channel.books = {};
  }
  if (first.next && at - first.until > kWeatherHoleMax) channel.books = {};
  const auto booked = [&](PowerBook& book, double component) {
    return book_power(book, channel.number, {at, component}, channel.since, averaging_);
  };
  std::vector<Reading> readings;
  if (weather::is_wind_direction(*channel.quantity)) {
    const double angle = value * kRadianPerDegree;
    readings = booked(channel.books[0], std::sin(angle));
    const std::vector<Reading> north = booked(channel.books[1], std::cos(angle));
    std::ranges::transform(readings, north, readings.begin(), direction_of);
  } else {
    readings = booked(first, value);
  }
  channel.since = Reason::none;
  for (const Reading& reading : readings) {
    const bool is_relived = reading.start < channel.relived_until && std::isfinite(reading.mean_kW);
    batch.intervals.push_back({reading, is_relived});
  }
}

void WeatherTrack::put_states(StoreBatch& batch) const {
  for (const Channel& channel : channels_) {
    const BookFields& names = book_fields(*channel.quantity);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!channel.books.at(i).next) continue;
      RegisterState state;
      state.field = names.at(i);
      state.power = channel.books.at(i);
      batch.registers.push_back({channel.number, std::move(state)});
    }
  }
}

}  // namespace recald::daemon
