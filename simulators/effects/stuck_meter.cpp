#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/meter_slots.hpp"

namespace recald::simulators {
namespace {

constexpr double kShareMax = 0.4;
constexpr double kSpellEvery_slots = 45.0 * 96.0;

/// The meter hangs: it repeats its last value for days or weeks, until someone notices.
class StuckMeter final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void distort(const MeterRecord& record) const override {
    if (settings_.meter != record.utility) return;
    const SlotRange covered = covered_slots(record, settings_);
    Rng rng = settings_.rng;
    // Each spell has its own stretch to grow in, so a stronger effect lengthens spells
    // without moving them.
    double stretch_begin = static_cast<double>(covered.first);
    for (const double stretch : stretches(static_cast<double>(covered.count()), rng)) {
      const double begin = stretch_begin + rng.uniform(0.0, 1.0 - kShareMax) * stretch;
      const double length = settings_.strength * stretch;
      hang(record.shown_kW,
           {static_cast<std::size_t>(begin),
            static_cast<std::size_t>(begin) + static_cast<std::size_t>(std::lround(length))});
      stretch_begin += stretch;
    }
  }

 private:
  /// About a month and a half each, of uneven length.
  [[nodiscard]] static std::vector<double> stretches(double slots, Rng& rng) {
    std::vector<double> lengths(
        static_cast<std::size_t>(std::max(1.0, std::round(slots / kSpellEvery_slots))));
    for (double& length : lengths) length = rng.uniform(0.4, 1.6);
    const double scale = slots / std::accumulate(lengths.begin(), lengths.end(), 0.0);
    for (double& length : lengths) length *= scale;
    return lengths;
  }

  static void hang(std::span<double> shown_kW, SlotRange spell) {
    const std::size_t last = std::min(spell.last, shown_kW.size());
    for (std::size_t slot = std::max<std::size_t>(1, spell.first); slot < last; ++slot) {
      shown_kW[slot] = shown_kW[slot - 1];
    }
  }
};

}  // namespace

EffectKind stuck_meter() {
  return {.id = "stuck_meter",
          .title = "Meter hangs",
          .group = EffectClass::meters,
          .sentence =
              "The meter repeats its last value for days or weeks at a time: a flat line where day "
              "and night should differ.",
          .strength = {0.0, 0.12, kShareMax, "share of the time"},
          .turns = "what the meter shows",
          .of_one_meter = true,
          .make = make_effect<StuckMeter>};
}

}  // namespace recald::simulators
