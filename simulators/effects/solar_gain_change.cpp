#include <algorithm>
#include <array>

#include "simulators/chance/chance.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"
#include "simulators/effects/yearly_wave.hpp"

namespace recald::simulators {
namespace {

constexpr double kBareTrees = 0.35;  ///< Relative to the shade of trees in leaf.
constexpr double kLowestSunDay = 20.0;

/// Trees that have grown or were felled, films on panes, blinds that stay up or down. Each facade
/// has its own share, trees follow the season, and blinds the people's habits.
class SolarGainChange final : public EffectWithSettings {
 public:
  SolarGainChange(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        latitude_deg_(drawings.place.latitude_deg),
        mood_(8.0 * kDay_s, kDay_s, settings_.rng) {
    for (double& share : facade_share_) share = settings_.rng.uniform(0.55, 1.0);
    trees_share_ = settings_.rng.uniform(0.3, 0.7);
  }

  void plan(metering::Day day, Timetable& /*timetable*/) override {
    // In leaf from some time after the last frost until late autumn.
    const double leaves = ramp(yearly_wave(day, kLowestSunDay, latitude_deg_), -0.3, 0.3);
    const double trees = kBareTrees + (1.0 - kBareTrees) * leaves;
    const double mood = std::clamp(1.0 + 0.1 * mood_.advance(settings_.rng), 0.75, 1.25);
    today_ = trees_share_ * trees + (1.0 - trees_share_) * mood;
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    for (std::size_t side = 0; side < facade_share_.size(); ++side) {
      const double change = settings_.strength * facade_share_[side] * today_;
      operation.envelope.sun_factor[side] *= std::max(0.0, 1.0 + change);
    }
  }

 private:
  double latitude_deg_;
  Persistence mood_;
  std::array<double, 4> facade_share_{};
  double trees_share_ = 0.0;
  double today_ = 1.0;
};

}  // namespace

EffectKind solar_gain_change() {
  return {
      .id = "solar_gain_change",
      .title = "More or less sun through the windows",
      .group = EffectClass::envelope,
      .sentence =
          "Trees, films or blinds let in less sun than the drawings say, or more: on sunny days "
          "cooling falls and heating rises, or the other way round.",
      .strength = {-0.7, -0.4, 0.7, "share of the windows' sun, negative for less"},
      .turns = "sun",
      .make = make_effect<SolarGainChange>};
}

}  // namespace recald::simulators
