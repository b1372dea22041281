#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

constexpr double kFullCutExcess = 0.06;  ///< Excess over the cap at which everything is cut.
constexpr double kCutting_s = 600.0;     ///< From nothing to everything.
constexpr double kRestoring_s = 2400.0;  ///< And back.
// At full cut.
constexpr double kSetpointRise_K = 2.5;
constexpr double kLightsCut = 0.35;
constexpr double kPlugsCut = 0.12;
constexpr double kCatchUp = 0.10;  ///< Of the plugs, after a cut, until they have caught up.

/// Keeps electricity below a cap on hot afternoons: raises set-points, dims lights, delays
/// machines. Afterwards rooms are cooled down again and machines catch up. The cap is below the
/// highest demand that the controller has seen so far.
class DemandLimit final : public EffectWithSettings {
 public:
  DemandLimit(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), demand_kW_(900.0) {}

  void operate(const Moment& now, Operation& operation) override {
    if (settings_.strength <= 0.0 || !settings_.covers(now.local.date)) return;
    move_cut(limits_now(now) ? wanted_cut() : 0.0, now.step_s);
    RoomOperation& rooms = operation.rooms;
    rooms.cooling_C += kSetpointRise_K * cut_;
    rooms.lights_factor *= 1.0 - kLightsCut * cut_;
    rooms.plugs_factor *= 1.0 - kPlugsCut * cut_ + catch_up(now.step_s);
  }

  void supply(const Moment& now, UtilityPower& power) override {
    demand_kW_.follow(power.electricity_kW, now.step_s);
    highest_kW_ = std::max(highest_kW_, demand_kW_.value());
  }

 private:
  [[nodiscard]] static bool limits_now(const Moment& now) {
    return now.day_kind == DayKind::workday && now.hour() >= 11.0 && now.hour() < 18.0 &&
           now.outdoors.air.temperature_C > 22.0;
  }

  [[nodiscard]] double wanted_cut() const {
    if (highest_kW_ <= 0.0) return 0.0;
    const double cap_kW = (1.0 - settings_.strength) * highest_kW_;
    return std::clamp((demand_kW_.value() - cap_kW) / (kFullCutExcess * highest_kW_), 0.0, 1.0);
  }

  void move_cut(double wanted, double step_s) {
    cut_ += std::clamp(wanted - cut_, -step_s / kRestoring_s, step_s / kCutting_s);
    held_back_s_ += kPlugsCut * cut_ * step_s;
  }

  /// Additional use of the machines in this step, as a share of the plugs.
  double catch_up(double step_s) {
    if (cut_ > 0.0) return 0.0;
    const double share = std::min(kCatchUp, held_back_s_ / step_s);
    held_back_s_ -= share * step_s;
    return share;
  }

  SlowValue demand_kW_;  ///< Mean of about a quarter of an hour, as utilities charge it.
  double highest_kW_ = 0.0;
  double cut_ = 0.0;          ///< 1: everything.
  double held_back_s_ = 0.0;  ///< Seconds of all plugs.
};

}  // namespace

EffectKind demand_limit() {
  return {
      .id = "demand_limit",
      .title = "Demand limited on hot afternoons",
      .group = EffectClass::electrical,
      .sentence =
          "On hot afternoons electricity is held below a cap by dimming lights and letting rooms "
          "get warmer; afterwards cooling and machines catch up.",
      .strength = {0.0, 0.2, 0.35, "share by which the cap lies below the highest demand"},
      .turns = "electric demand",
      .make = make_effect<DemandLimit>};
}

}  // namespace recald::simulators
