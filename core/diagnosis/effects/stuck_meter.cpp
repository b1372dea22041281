/// A meter that repeats itself.
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {

Effect stuck_meter() {
  return {
      .id = "stuck_meter",
      .title = "Meter is frozen",
      .meaning =
          "For some time the meter repeats its last value, or zero, although the building "
          "still uses energy. Check its pulse output and its line.",
      .physics =
          "y + s (l y(t1) - y) from t1 to t2; y recorded power in kW, s = 1 a dead "
          "meter, l = 0 zero, l = 1 the last value",
      .on_meters =
          "One meter repeats its last value, or zero, for a while; the other meters go on as "
          "usual.",
      .check = "The meter's pulse output, its line and its logger in that time.",
      .effect_class = EffectClass::meter,
      .dating = Dating::window,
      .of_one_meter = true,
      .confusable = {{"vacancy", "The other meters: in an empty building they also fall."},
                     {"missing_holidays", "The other meters on that date."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {any_share("stuck_share", "-"), either_share("level_share")};
      },
      // Applies within its window. The share between a live and a dead meter only helps the search:
      // real meters are at 1.
      .bind =
          [](const SiteFacts&, Values values, int meter) {
            return recording(meter, [stuck_share = values[0], level_share = values[1]](
                                        std::span<const DriverHour>, std::span<double> power_kW) {
              if (power_kW.empty()) return;
              const double level_kW = level_share * power_kW.front();
              for (double& value_kW : power_kW) value_kW += stuck_share * (level_kW - value_kW);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
