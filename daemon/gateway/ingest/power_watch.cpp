#include "daemon/gateway/ingest/power_watch.hpp"

#include <fmt/format.h>

namespace recald::daemon {
namespace {

using metering::Reading;

/// Two polls around a boundary need no more; others would wait in vain.
constexpr std::size_t kWaitingMax = 8;

void put(std::deque<Reading>& waiting, const Reading& reading) {
  if (waiting.size() == kWaitingMax) waiting.pop_front();
  waiting.push_back(reading);
}

}  // namespace

void PowerWatch::take_power(const metering::PowerSample& sample) {
  for (const Reading& reading : book_power(book_, meter_, sample, metering::Reason::none, rules_)) {
    put(powered_, reading);
  }
}

void PowerWatch::take_interval(const Reading& counted) { put(counted_, counted); }

void PowerWatch::evaluate(StoreBatch& batch, const metering::CounterSettings& counter,
                          metering::Instant at) {
  const metering::PowerCheckRules rules{
      .rated_kW = counter.rated_kW,
      .resolution_kWh = counter.resolution_kWh,
      .compared_intervals = static_cast<int>(std::chrono::days{1} / rules_.interval)};
  while (!counted_.empty() && !powered_.empty()) {
    const Reading counted = counted_.front();
    const Reading powered = powered_.front();
    if (counted.start <= powered.start) counted_.pop_front();
    if (powered.start <= counted.start) powered_.pop_front();
    if (counted.start != powered.start) continue;
    const auto verdict = check_power(check_, counted, powered, rules_.interval, rules);
    for (const Reading& frozen : verdict.frozen) batch.intervals.push_back({frozen, true});
    if (verdict.has_frozen_now) {
      batch.events.push_back(
          {at, Severity::warning, "counter_stuck", id_,
           fmt::format("meter '{}': its counter does not move while its power is {:.1f} kW; the "
                       "intervals since {} are doubtful until it does",
                       id_, powered.mean_kW, metering::to_string(verdict.frozen.front().start))});
    }
    if (verdict.power_to_counter != 0.0) {
      batch.events.push_back(
          {at, Severity::warning, "power_differs", id_,
           fmt::format("meter '{}': over a day its power adds up to {:.3g} times the energy on its "
                       "counter; check units, scales and the multiplier in its register map",
                       id_, verdict.power_to_counter)});
    }
  }
}

}  // namespace recald::daemon
