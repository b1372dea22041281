#include <algorithm>
#include <chrono>
#include <vector>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/meter_slots.hpp"

namespace recald::simulators {
namespace {

using std::chrono::January, std::chrono::July, std::chrono::March, std::chrono::November,
    std::chrono::Sunday;

/// Between the second Sunday of March and the first of November, as in the United States.
bool in_american_summer(metering::Day day) {
  const std::chrono::sys_days date{day};
  return date >= std::chrono::sys_days{day.year() / March / Sunday[2]} &&
         date < std::chrono::sys_days{day.year() / November / Sunday[1]};
}

/// How far the logger's clock is ahead of local time at this instant, in hours.
double fast_h(metering::Instant t, const metering::LocalCalendar& calendar) {
  const metering::Day day = calendar.local_time(t).date;
  const auto january = calendar.utc_offset(std::chrono::sys_days{day.year() / January / 1});
  const auto july = calendar.utc_offset(std::chrono::sys_days{day.year() / July / 1});
  if (january == july) return in_american_summer(day) ? 1.0 : 0.0;
  return calendar.utc_offset(t) > std::min(january, july) ? -1.0 : 0.0;
}

/// The logger ignores summer time where it is used, and applies it where it is not.
class DstMisapplied final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void distort(const MeterRecord& record) const override {
    if (settings_.strength == 0.0) return;
    const std::vector<double> right_kW(record.shown_kW.begin(), record.shown_kW.end());
    const double slots_per_h = std::chrono::hours{1} / kInterval;
    const SlotRange covered = covered_slots(record, settings_);
    for (std::size_t slot = covered.first; slot < covered.last; ++slot) {
      const metering::Instant t = record.begin + static_cast<std::int64_t>(slot) * kInterval;
      const double fast_slots = settings_.strength * slots_per_h * fast_h(t, record.calendar);
      record.shown_kW[slot] = shown_between(right_kW, static_cast<double>(slot) - fast_slots);
    }
  }
};

}  // namespace

EffectKind dst_misapplied() {
  return {.id = "dst_misapplied",
          .title = "Summer time misapplied",
          .group = EffectClass::meters,
          .sentence =
              "The logger ignores summer time, or changes its clock where nobody else does: from "
              "spring to autumn all meters are an hour off, in winter they are right.",
          .strength = {0.0, 1.0, 1.0, "hours"},
          .turns = "what the meter shows",
          .all_or_nothing = true,
          .make = make_effect<DstMisapplied>};
}

}  // namespace recald::simulators
