#include <algorithm>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

double window_m2(const Drawings& drawings) {
  const double facade_m2 = 2.0 * (drawings.length_m + drawings.width_m) * drawings.storey_height_m;
  return static_cast<double>(drawings.storeys) * drawings.window_share * facade_m2;
}

/// People open windows when it is pleasant outside, close them in wind, cold and heat, and forget
/// some when they go home. The weather matters more than the rooms.
/// @see Haldi, Robinson (2009), Building and Environment 44(12), 2378-2395.
class OpenWindows final : public EffectWithSettings {
 public:
  OpenWindows(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        window_m2_(window_m2(drawings)),
        open_share_(kHabit_s) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    mood_ = settings_.rng.uniform(0.6, 1.2);
    forgotten_share_ = settings_.rng.uniform(0.03, 0.12);
  }

  void operate(const Moment& now, Operation& operation) override {
    const double outdoor_C = now.outdoors.air.temperature_C;
    const double pleasant = ramp(outdoor_C, 11.0, 20.0) * ramp(outdoor_C, 30.0, 26.0);
    const double calm = ramp(now.outdoors.wind_speed_m_s, 12.0, 6.0);
    const double dry = now.outdoors.precipitation_mm_h > 0.5 ? 0.4 : 1.0;
    const double wanted_share = mood_ * pleasant * calm * dry;
    const bool someone_in = now.people_share > 0.05;
    // People who go home usually close the window; the caretaker closes those that bang.
    const double target =
        someone_in ? wanted_share : std::min(open_share_.value(), forgotten_share_ * calm);
    const double share = open_share_.follow(target, now.step_s);
    if (!settings_.covers(now.local.date)) return;
    operation.envelope.window_opening_m2 += settings_.strength / 100.0 * window_m2_ * share;
  }

 private:
  static constexpr double kHabit_s = 2400.0;

  double window_m2_;
  SlowValue open_share_;  ///< Relative to a pleasant day, without variation between days.
  double mood_ = 1.0;
  double forgotten_share_ = 0.0;
};

}  // namespace

EffectKind open_windows() {
  return {.id = "open_windows",
          .title = "Windows opened in mild weather",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "People open windows on pleasant days while the plant runs: cooling and heating are "
              "off their usual line in mild weather, in working hours.",
          .strength = {0.0, 8.0, 30.0, "% of the window area that stands open on a pleasant day"},
          .turns = "windows",
          .make = make_effect<OpenWindows>};
}

}  // namespace recald::simulators
