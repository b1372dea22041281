/// The intervals of a meter's record, for effects on what a meter shows.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

/// Half open: [first, last).
struct SlotRange {
  std::size_t first;
  std::size_t last;

  [[nodiscard]] std::size_t count() const { return last > first ? last - first : 0; }
};

/// The intervals that begin on the days covered by the settings.
[[nodiscard]] inline SlotRange covered_slots(const MeterRecord& record,
                                             const EffectSettings& settings) {
  const auto slot_at = [&record](metering::Instant t) {
    const auto slots = (t - record.begin + kInterval - std::chrono::seconds{1}) / kInterval;
    return std::min(record.shown_kW.size(),
                    static_cast<std::size_t>(std::max<std::int64_t>(0, slots)));
  };
  return {
      settings.from ? slot_at(record.calendar.day_span(*settings.from).begin) : 0,
      settings.to ? slot_at(record.calendar.day_span(*settings.to).end) : record.shown_kW.size()};
}

/// The value of an interval that lies between two others: `position` 2.25 takes three quarters of
/// interval 2 and one quarter of interval 3. Beyond the ends of the record its end values continue.
/// @pre the record is not empty
[[nodiscard]] inline double shown_between(std::span<const double> shown_kW, double position) {
  const auto at = [shown_kW](double slot) {
    const double last = static_cast<double>(shown_kW.size() - 1);
    return shown_kW[static_cast<std::size_t>(std::clamp(slot, 0.0, last))];
  };
  const double whole = std::floor(position);
  const double share = position - whole;
  return share == 0.0 ? at(whole) : (1.0 - share) * at(whole) + share * at(whole + 1.0);
}

}  // namespace recald::simulators
