/// Equipment is added or removed on one day.
#include <algorithm>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/presence.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

/// A part runs all the time, the rest as lights and plugs do above their least of the month. What
/// is added is plugs; what goes, goes from lights and plugs alike.
class EquipmentStep final : public Alteration {
 public:
  EquipmentStep(double power_kW, double following, const model::Drivers& drivers)
      : power_W_(1e3 * power_kW), following_(following), standby_(drivers) {
    for (const DriverHour& hour : drivers.hours) mean_above_W_ += above_W(hour);
    mean_above_W_ /= static_cast<double>(std::max(drivers.hours.size(), std::size_t{1}));
  }

  void operate(const DriverHour& hour, StepOperation& operation) const override {
    const double use = mean_above_W_ > 0.0 ? above_W(hour) / mean_above_W_ : 1.0;
    const double change_W = power_W_ * (1.0 - following_ + following_ * use);
    if (change_W >= 0.0) {
      operation.plugs_W += change_W;
      return;
    }
    const double there_W = std::max(operation.lights_W + operation.plugs_W, 1e-3);
    const double left = std::max(1.0 + change_W / there_W, 0.0);
    operation.lights_W *= left;
    operation.plugs_W *= left;
  }

 private:
  [[nodiscard]] double above_W(const DriverHour& hour) const {
    return standby_.lights_above_W(hour, hour.lights_W) +
           standby_.plugs_above_W(hour, hour.plugs_W);
  }

  double power_W_;
  double following_;
  StandbyLoads standby_;
  double mean_above_W_ = 0.0;
};

}  // namespace

Effect equipment_step() {
  return {
      .id = "equipment_step",
      .title = "Equipment added or removed",
      .meaning =
          "From some day on the building uses more electricity (or less), which also warms the "
          "rooms more (or less): a new machine, or a retrofit.",
      .physics =
          "lights and plugs + dP s(t) from the date; s = 1 - b + b u/mean u, u what they are above "
          "their least of the month; dP mean power in kW, b in -",
      .on_meters =
          "Electricity is higher or lower from one day on; chilled water and heat follow a little.",
      .check = "What was installed, removed or retrofitted around that date.",
      .effect_class = EffectClass::electrical,
      .dating = Dating::must_begin,
      .confusable =
          {{"plug_growth", "Night electricity week by week around the date: step or slope."},
           {"phase_lost",
            "Chilled water after the date: equipment moves it, a lost phase does not."},
           {"vacancy",
            "The number of people in the building: badge or lift counts after the date."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        const double sd_kW = share_of_mean_kW(facts, metering::Utility::electricity, 0.10);
        return {{.name = "power",
                 .unit = "kW",
                 .prior = TruncatedNormalPrior{.location = 0.0, .sd = sd_kW},
                 .neutral = 0.0},
                {.name = "following_use",
                 .unit = "-",
                 .prior = UniformPrior{.min = 0.0, .max = 1.0},
                 .neutral = kAbsent,
                 .scan = {0.5, 1.0}}};  // 0 is a server room.
      },
      .bind = [](const SiteFacts& facts, Values values, int) -> Altered {
        return std::make_unique<EquipmentStep>(values[0], values[1], facts.drivers);
      },
  };
}

}  // namespace recald::diagnosis::effects
