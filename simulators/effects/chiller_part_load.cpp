#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Shares of capacity above which the chiller starts and below which it stops.
constexpr double kStart = 0.04;
constexpr double kStop = 0.015;

/// The compressor hardly unloads: it recirculates hot gas, and the drives use the same power.
class ChillerPartLoad final : public EffectWithSettings {
 public:
  ChillerPartLoad(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        capacity_W_(1000.0 * drawings.chilled_water_design_kW),
        full_power_W_(capacity_W_ / drawings.chiller_cop),
        chiller_(kStop, kStart) {}

  void load(const Moment& now, ServiceLoad& load) override {
    const double part_load = std::clamp(load.cooling_W / capacity_W_, 0.0, 1.0);
    const bool runs = chiller_.update(part_load);
    if (!runs || !settings_.covers(now.local.date)) return;
    load.other_electricity_W += settings_.strength * full_power_W_ * (1.0 - part_load);
  }

 private:
  double capacity_W_;
  double full_power_W_;
  Hysteresis chiller_;
};

}  // namespace

EffectKind chiller_part_load() {
  return {.id = "chiller_part_load",
          .title = "Chiller poor at part load",
          .group = EffectClass::plant,
          .sentence =
              "The chiller takes nearly as much power at low load as at high: electricity stays up "
              "whenever a little cooling is needed, most of all in spring and autumn.",
          .strength = {0.0, 0.2, 0.5, "share of full power taken in vain at the lowest load"},
          .needs = {.own_chiller = true},
          .turns = "chiller efficiency",
          .make = make_effect<ChillerPartLoad>};
}

}  // namespace recald::simulators
