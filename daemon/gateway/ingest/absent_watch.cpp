#include "daemon/gateway/ingest/absent_watch.hpp"

#include <fmt/format.h>

#include <utility>

namespace recald::daemon {
namespace {

using metering::RegisterSample;

/// As long as a counter's reset takes to be believed.
constexpr int kDoubtedMin = 3;
constexpr std::chrono::seconds kDoubtedTimeMin{120};

}  // namespace

bool AbsentWatch::believes(const modbus::RegisterField& field, const modbus::DecodedValue& value,
                           const RegisterSample& sample,
                           const metering::CounterSettings& settings) {
  Field& known = fields_[field.name];
  const auto has_counted_up = [&] {
    if (!known.believed) return false;
    const double rise_kWh = sample.value_kWh - known.believed->value_kWh;
    const auto span = sample.time - known.believed->time;
    // Over a hole a load explains so much that a jump would pass for a count.
    return rise_kWh == 0.0 || (span <= sample_gap_max_ && rise_kWh > 0.0 &&
                               rise_kWh <= metering::rise_max_kWh(span, settings));
  };
  if (!modbus::is_usual_absent(value.bits, field.format.type) || has_counted_up()) {
    known.believed = sample;
    known.doubted = 0;
    known.is_told = false;
    return true;
  }
  if (known.doubted++ == 0) known.since = sample.time;
  if (known.doubted < kDoubtedMin || sample.time - known.since < kDoubtedTimeMin) return false;
  if (std::exchange(known.is_told, true)) return false;
  const int digits = 4 * field.words();
  event_ = {.time = sample.time,
            .severity = Severity::warning,
            .kind = "counter_absent",
            .subject = meter_,
            .text = fmt::format(
                "meter '{0}': register '{1}' has read 0x{2:0{3}X} since {4}, by which devices "
                "usually say that they have no value, so its readings are missing; write absent = "
                "\"0x{2:0{3}X}\" to [register.{1}] of its map, or correct its address. If it has "
                "really counted so far, its energy is counted as soon as it moves on",
                meter_, field.name, value.bits, digits, metering::to_string(known.since)),
            .is_counted = true};
  return false;
}

std::optional<StoreEvent> AbsentWatch::take_event() { return std::exchange(event_, std::nullopt); }

}  // namespace recald::daemon
