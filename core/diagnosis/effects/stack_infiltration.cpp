/// Warm air rises through shafts and stairs and draws in cold air below.
#include <algorithm>
#include <cmath>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

// 10 m high and 10 K difference. The factor is given for this reference, because its value per
// square root of a metre and a kelvin would be meaningless to readers.
constexpr double kReference_mK = 100.0;

class StackInfiltration final : public Alteration {
 public:
  StackInfiltration(double factor, double height_m) : factor_(factor), height_m_(height_m) {}

  void operate(const DriverHour&, StepOperation& operation) const override {
    const double draught = std::sqrt(height_m_ * difference_K(operation) / kReference_mK);
    operation.infiltration_factor *= 1.0 + factor_ * draught;
  }

 private:
  /// Between outdoors and the nearer current set-point; zero within the dead band.
  static double difference_K(const StepOperation& op) {
    const double heating_C =
        std::lerp(op.heating_unoccupied_C, op.heating_occupied_C, op.daytime_share);
    const double cooling_C =
        std::lerp(op.cooling_unoccupied_C, op.cooling_occupied_C, op.daytime_share);
    return std::max({heating_C - op.dry_bulb_C, op.dry_bulb_C - cooling_C, 0.0});
  }

  double factor_;
  double height_m_;
};

}  // namespace

Effect stack_infiltration() {
  return {
      .id = "stack_infiltration",
      .title = "Draught through shafts and stairs",
      .meaning =
          "In cold weather the building acts like a chimney: air leaves at the top of shafts and "
          "stairs, and cold air enters at the doors below.",
      .physics =
          "infiltration x (1 + k sqrt(h dT / (10 m x 10 K))); h building height in m, "
          "dT between indoors and outdoors in K, k in -",
      .on_meters = "Heat rises faster and faster as it gets colder, fans on or off, at any wind.",
      .check = "Doors at the bottom and vents at the top of shafts and stairs, on a cold day.",
      .effect_class = EffectClass::envelope,
      .dating = Dating::may_begin,
      .confusable =
          {{"damper_stuck_open",
            "The outdoor damper position, and heating on nights with the fans locked off."},
           {"night_setback_missing",
            "Room temperature at 3 o'clock at night: with a set-back it falls, whatever the "
            "draught."},
           {"wind_infiltration", "Compare heating on calm and on windy nights, both very cold."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "stack_factor", .unit = "-", .prior = half_normal(0.5), .neutral = 0.0}};
      },
      .bind = [](const SiteFacts& facts, Values values, int) -> Altered {
        const double height_m = facts.building.storeys * facts.building.storey_height_m;
        return std::make_unique<StackInfiltration>(values[0], height_m);
      },
  };
}

}  // namespace recald::diagnosis::effects
