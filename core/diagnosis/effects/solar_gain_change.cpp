/// More or less sun enters than with the windows, blinds and neighbours of the drawings.
#include <algorithm>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {
namespace {

// Blinds go down room by room: the change sets in over this much sun below the threshold.
constexpr double kComingIn_W_m2 = 100.0;

}  // namespace

Effect solar_gain_change() {
  return {
      .id = "solar_gain_change",
      .title = "Solar gain differs from the drawings",
      .meaning =
          "Blinds, films, trees or new neighbouring buildings let in less sun than the drawings "
          "say, or broken or unused shading lets in more.",
      .physics =
          "solar gain x (1 - a) in hours with more than I0 on the horizontal, coming in "
          "over the 100 W/m2 below; a in -, I0 in W/m2",
      .on_meters =
          "Chilled water differs in sunny hours, and heat in winter the other way; electricity "
          "hardly changes.",
      .check = "Blinds and films, trees and buildings in front of the windows.",
      .effect_class = EffectClass::envelope,
      .dating = Dating::may_begin,
      .needs = {.sun = true},
      .confusable = {{"scale_fault",
                      "Chilled water at night: a wrong scale also shows then, the sun does not."},
                     {"weekend_operation",
                      "Compare sunny with cloudy weekends at the same temperature."},
                     {"economiser_failed",
                      "The mixed-air temperature at 15 °C outdoors on an overcast working day."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "solar_reduction",
                 .unit = "-",
                 .prior = UniformPrior{.min = -0.5, .max = 0.5},
                 .neutral = 0.0},
                {.name = "solar_threshold",
                 .unit = "W/m2",
                 .prior = UniformPrior{.min = 0.0, .max = 600.0},
                 .neutral = kAbsent,
                 .scan = {0.0, 250.0, 500.0}}};
      },
      .bind =
          [](const SiteFacts&, Values values, int) {
            return operating([reduction = values[0], above_W_m2 = values[1]](
                                 const DriverHour& hour, StepOperation& operation) {
              const double excess_W_m2 = hour.global_horizontal_W_m2 - above_W_m2;
              const double share = std::clamp(1.0 + excess_W_m2 / kComingIn_W_m2, 0.0, 1.0);
              operation.solar_share *= 1.0 - reduction * share;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
