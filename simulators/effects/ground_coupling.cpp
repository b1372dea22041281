#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Two slow layers in series: the ground beside the building lags by a month, the soil beneath it
/// by three more weeks.
constexpr double kSoilLayer_s = 15.0 * 86'400.0;
constexpr double kBareFloor_W_m2K = 0.9;  ///< Slab and soil without any insulation.
constexpr double kCoupledShare = 0.7;     ///< Of the soil's swing, under a bare floor.

/// A slab or basement without insulation. The ground below it follows the outdoors,
/// delayed and damped.
class GroundCoupling final : public EffectWithSettings {
 public:
  GroundCoupling(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        mean_C_(drawings.ground_C),
        upper_(kSoilLayer_s),
        lower_(kSoilLayer_s) {}

  void build(Truth& truth) const override {
    if (settings_.strength == 0.0) return;  // 1 / (1 / u) may round
    const double insulation_m2K_W =
        std::max(0.0, 1.0 / truth.ground_u_W_m2K - 1.0 / kBareFloor_W_m2K);
    truth.ground_u_W_m2K =
        1.0 / (1.0 / truth.ground_u_W_m2K - settings_.strength * insulation_m2K_W);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!begun_) start(now);
    const double soil_C =
        lower_.follow(upper_.follow(now.outdoors.air.temperature_C, now.step_s), now.step_s);
    if (!settings_.covers(now.local.date)) return;
    operation.envelope.ground_shift_K += kCoupledShare * settings_.strength * (soil_C - mean_C_);
  }

 private:
  /// The weather before the record is unknown: the soil starts between the year's mean
  /// and today's value.
  void start(const Moment& now) {
    const double air_C = now.outdoors.air.temperature_C;
    upper_.follow(0.5 * (mean_C_ + air_C), now.step_s);
    lower_.follow(0.75 * mean_C_ + 0.25 * air_C, now.step_s);
    begun_ = true;
  }

  double mean_C_;
  SlowValue upper_;
  SlowValue lower_;
  bool begun_ = false;
};

}  // namespace

EffectKind ground_coupling() {
  return {.id = "ground_coupling",
          .title = "Floor without insulation",
          .group = EffectClass::envelope,
          .sentence =
              "The lowest floor has no insulation against the ground, which is coldest in late "
              "winter: heating stays high into spring although the air is mild again.",
          .strength = {0.0, 1.0, 1.0, "share of the floor's insulation that is missing"},
          .turns = "ground",
          .make = make_effect<GroundCoupling>};
}

}  // namespace recald::simulators
