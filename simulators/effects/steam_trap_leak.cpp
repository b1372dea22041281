#include <algorithm>

#include "simulators/chance/chance.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Leaking steam traps and uninsulated pipes: heat is lost in any weather, in amounts that vary
/// with the pipe pressure.
class SteamTrapLeak final : public EffectWithSettings {
 public:
  SteamTrapLeak(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        leak_W_(settings.strength * 1000.0 * drawings.heating_design_kW),
        pressure_(20.0 * kDay_s, kDay_s, settings_.rng) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    today_ = std::clamp(1.0 + 0.08 * pressure_.advance(settings_.rng), 0.7, 1.3);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    operation.plant.heating_standing_W += leak_W_ * today_;
  }

 private:
  double leak_W_;
  Persistence pressure_;
  double today_ = 1.0;
};

}  // namespace

EffectKind steam_trap_leak() {
  return {.id = "steam_trap_leak",
          .title = "Leaking traps and bare pipes",
          .group = EffectClass::plant,
          .sentence =
              "Traps blow through and pipes are bare: the heat meter shows the same extra use day "
              "and night, summer and winter.",
          .strength = {0.0, 0.012, 0.12, "share of the heating plant's capacity"},
          .needs = {.heat_meter = true},
          .turns = "pipe losses",
          .make = make_effect<SteamTrapLeak>};
}

}  // namespace recald::simulators
