#include <vector>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/meter_slots.hpp"

namespace recald::simulators {
namespace {

/// The meter's clock is fast, so that it stamps ten o'clock too early, or slow.
class ClockOffset final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void distort(const MeterRecord& record) const override {
    if (settings_.meter != record.utility || settings_.strength == 0.0) return;
    const std::vector<double> right_kW(record.shown_kW.begin(), record.shown_kW.end());
    const double fast_slots =
        settings_.strength / std::chrono::duration<double, std::ratio<60>>(kInterval).count();
    const SlotRange covered = covered_slots(record, settings_);
    for (std::size_t slot = covered.first; slot < covered.last; ++slot) {
      record.shown_kW[slot] = shown_between(right_kW, static_cast<double>(slot) - fast_slots);
    }
  }
};

}  // namespace

EffectKind clock_offset() {
  return {
      .id = "clock_offset",
      .title = "Meter's clock is wrong",
      .group = EffectClass::meters,
      .sentence =
          "One meter's clock is fast or slow: what it shows comes too late or too early against "
          "the other meters and the weather, while the month's sum is right.",
      .strength = {-360.0, 90.0, 360.0, "minutes fast, negative for slow"},
      .turns = "what the meter shows",
      .of_one_meter = true,
      .make = make_effect<ClockOffset>};
}

}  // namespace recald::simulators
