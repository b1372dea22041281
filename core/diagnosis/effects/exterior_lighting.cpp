/// Outdoor lamps that are not in the drawings.
#include <algorithm>
#include <array>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"
#include "core/model/dark_hours.hpp"

namespace recald::diagnosis::effects {
namespace {

using SharesByHour = std::array<double, 24>;

SharesByHour mean_dark_shares(const model::Drivers& drivers) {
  SharesByHour sums{};
  SharesByHour counts{};
  for (const DriverHour& hour : drivers.hours) {
    const auto i = static_cast<std::size_t>(hour.local_hour);
    sums[i] += model::dark_share(hour);
    counts[i] += 1.0;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

}  // namespace

Effect exterior_lighting() {
  return {
      .id = "exterior_lighting",
      .title = "Exterior lighting follows the sun",
      .meaning =
          "This meter includes street, facade or car-park lights that are on from dusk to dawn. "
          "They heat no room, and their hours change with the seasons.",
      .physics =
          "exterior + P while the sun is below -2 degrees, plug profile - m P x mean "
          "dark share of the hour; P in kW, m in -",
      .on_meters =
          "Electricity is higher from dusk to dawn, longer in winter; no other meter changes.",
      .check =
          "Which street, facade or car-park lights hang on this meter, and what switches them.",
      .effect_class = EffectClass::electrical,
      .dating = Dating::may_begin,
      .confusable =
          {{"after_hours",
            "The evening switch-on in 15-minute values: does it move with sunset over the weeks?"},
           {"weekend_operation", "Chilled water at the same hours: exterior lights need none."},
           {"dst_misapplied", "The other meters: exterior lights only change electricity."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        const double sd_kW = share_of_mean_kW(facts, metering::Utility::electricity, 0.05);
        return {{.name = "power", .unit = "kW", .prior = half_normal(sd_kW), .neutral = 0.0},
                either_share("share_in_plugs")};
      },
      // A plug profile derived from the electricity meter may already contain the lamps' mean of
      // each hour, as heat in the rooms; that share is subtracted.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return operating([power_W = 1e3 * values[0], share_in_plugs = values[1],
                              mean_dark_shares = mean_dark_shares(facts.drivers)](
                                 const DriverHour& hour, StepOperation& operation) {
              const double usual_share =
                  mean_dark_shares[static_cast<std::size_t>(hour.local_hour)];
              operation.exterior_W += power_W * model::dark_share(hour);
              operation.plugs_W =
                  std::max(operation.plugs_W - share_in_plugs * power_W * usual_share, 0.0);
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
